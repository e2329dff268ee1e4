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

TEST_CASE("a robot program is refused with the name of its language, in any dialect option") {
  const std::pair<const char*, const char*> programs[] = {
      {"&ACCESS RVO1\r\nDEF Test1 ( )\r\n", "KUKA KRL"},
      {"\n;FOLD\nDEF Test1()\nPTP HOME\n", "KUKA KRL"},
      {"MODULE MainModule\n  PROC main()\n", "ABB RAPID"},
      {"%%%\n  VERSION:1\n%%%\nMODULE a\n", "ABB RAPID"},
      {"/PROG cub\n/ATTR\n", "FANUC TP (LS)"},
      {"# pick\ndef Program():\n  movej([0,0,0,0,0,0])\n", "URScript"},
      {"/JOB\n//NAME A\n", "Yaskawa INFORM (JBI)"},
  };
  for (const auto& [text, language] : programs)
    for (const char* dialect : {"auto", "heidenhain"}) {
      const auto& shown = text;
      CAPTURE(shown);
      CHECK(refusal_of_robot(text, dialect)
                .starts_with("job:1:1: error: this is a program in " + std::string(language)));
    }
}

TEST_CASE("programs that begin like a robot's are read as G-code") {
  CHECK(refusal_of_robot("G21\nDEF REAL A1\nG1 X1 F100\n").starts_with("job:2:1: error: D has no number"));
  CHECK(refusal_of_robot("%\nO1001\nG21\nG0 X1\n%\n") == "");
  CHECK(refusal_of_robot("/G21 G0 X1\n") == "");
  CHECK(refusal_of_robot("(MODULE A)\nG21 G0 X1\n") == "");
}
