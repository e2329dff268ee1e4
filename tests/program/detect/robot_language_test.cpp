#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The diagnostic of reading `text`; empty where it is read.
std::string refusal_of_robot(const std::string& text, const std::string& dialect = "auto") {
  ReadOptions options;
  options.dialect = dialect;
  try {
    read_program(text, "job", options);
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::program_text);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("programs that begin like a robot's are read as G-code") {
  CHECK(refusal_of_robot("G21\nDEF REAL A1\nG1 X1 F100\n").starts_with("job:2:1: error: D has no number"));
  CHECK(refusal_of_robot("%\nO1001\nG21\nG0 X1\n%\n") == "");
  CHECK(refusal_of_robot("/G21 G0 X1\n") == "");
  CHECK(refusal_of_robot("(MODULE A)\nG21 G0 X1\n") == "");
}

TEST_CASE("ABB RAPID is read, and refused in another dialect option") {
  for (const char* text : {"MODULE MainModule\n  PROC main()\n  ENDPROC\nENDMODULE\n",
                           "! by hand\r\n%%%\r\n  VERSION:1\r\n%%%\r\nmodule a\r\nENDMODULE\r\n"}) {
    CHECK(refusal_of_robot(text) == "");
    CHECK(refusal_of_robot(text, "abb") == "");
    CHECK(refusal_of_robot(text, "kuka") ==
          "job:1:1: error: this is a program in ABB RAPID, not in dialect 'kuka'; use auto or abb");
  }
}

TEST_CASE("KUKA KRL is read, and refused in another dialect option") {
  for (const char* text : {"&ACCESS RVO1\r\nDEF Test1 ( )\r\nEND\r\n", "\n;FOLD\nDEF Test1()\nEND\n"}) {
    CHECK(refusal_of_robot(text) == "");
    CHECK(refusal_of_robot(text, "kuka") == "");
    CHECK(refusal_of_robot(text, "heidenhain") ==
          "job:1:1: error: this is a program in KUKA KRL, not in dialect 'heidenhain'; use auto or kuka");
  }
}

TEST_CASE("URScript is read, and refused in another dialect option") {
  for (const char* text :
       {"# pick\ndef Program():\n  movej([0,0,0,0,0,0])\nend\n", "set_tcp(p[0,0,0,0,0,0])\r\n"}) {
    CHECK(refusal_of_robot(text) == "");
    CHECK(refusal_of_robot(text, "ur") == "");
    CHECK(refusal_of_robot(text, "kuka") ==
          "job:1:1: error: this is a program in URScript, not in dialect 'kuka'; use auto or ur");
  }
}

TEST_CASE("FANUC TP is read, and refused in another dialect option") {
  for (const char* text : {"/PROG cub\n/ATTR\n/MN\n/POS\n/END\n", "/PROG  A\r\n/MN\r\n/POS\r\n/END"}) {
    CHECK(refusal_of_robot(text) == "");
    CHECK(refusal_of_robot(text, "fanuc_tp") == "");
    CHECK(refusal_of_robot(text, "fanuc") ==
          "job:1:1: error: this is a program in FANUC TP (LS), not in dialect 'fanuc'; use auto or fanuc_tp");
  }
}

TEST_CASE("APT is read, and refused in another dialect option") {
  for (const char* text :
       {"PARTNO A\nFINI\n", "\xEF\xBB\xBFGOTO / 1,2,3\r\n", "$$ made by hand\nTOOL PATH/A\nGOTO/1,2,3\n"}) {
    ReadOptions options{.unit = LengthUnit::millimetres};
    CHECK(read_program(text, "job", options).dialect == "apt");
    CHECK(refusal_of_robot(text, "ur") ==
          "job:1:1: error: this is a program in APT, not in dialect 'ur'; use auto or apt");
  }
}

TEST_CASE("a Yaskawa job is read, and refused in another dialect option") {
  for (const char* text : {"/JOB\n//NAME A\n//POS\n//INST\nNOP\nEND\n", "/JOB\r\n//INST\r\nEND\r\n"}) {
    CHECK(refusal_of_robot(text) == "");
    CHECK(refusal_of_robot(text, "yaskawa") == "");
    CHECK(refusal_of_robot(text, "kuka") ==
          "job:1:1: error: this is a program in Yaskawa INFORM, not in dialect 'kuka'; use auto or yaskawa");
  }
}
