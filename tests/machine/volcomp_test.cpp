#include "counterflex/machine/volcomp.hpp"

#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"

using namespace counterflex;

namespace {

const std::string isg_text =
    "// position errors\nC0Y B0Z\n0.00002 -0.00001\n#\nX EXX EYX EZX EAX EBX ECX\n"
    "0.0 0.02 0.01 0.07 0.00 0.0042 0.003\n10.0 0.00 -0.1 0.01 0.00 0.0011 0.002 // end\n"
    "#\nC EXC\n0 0.001\n180 -0.001\n";
const std::string etalon_text =
    "[C0Y]\nVALUE = 0.00002\n[EXX]\nGridpoints = {\n -10.0 0.001\n 0.0 0.002\n 10.0 0.004\n} // end of EXX\n"
    "[EAX]\nGridpoints = {\n -10.0 0.00001\n 10.0 0.00003\n}\n";

std::string volcomp_error(const std::string& text, VolcompFormat format) {
  try {
    read_volcomp(text, "v.txt", format, false);
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a table of ISG's format has lengths in mm and angles in rad") {
  const Volcomp volcomp = read_volcomp(isg_text, "v.csv", VolcompFormat::isg, false);
  REQUIRE(volcomp.tables.size() == 2);
  const ErrorTable& x = volcomp.tables.at('X');
  CHECK(x.positions == std::vector<double>{0, 0.01});
  Vector6 expected;
  expected << 2e-5, 1e-5, 7e-5, 0, 0.0042, 0.003;
  CHECK((x.errors[0] - expected).norm() < 1e-15);
  CHECK(volcomp.tables.at('C').positions[1] == doctest::Approx(pi));
  CHECK(volcomp.position_errors.at("C0Y") == 2e-5);
  const Volcomp negated = read_volcomp(isg_text, "v.csv", VolcompFormat::isg, true);
  CHECK((negated.tables.at('X').errors[0] + expected).norm() < 1e-15);
  CHECK(negated.position_errors.at("B0Z") == 1e-5);
}

TEST_CASE("components of Etalon's format that have other positions are interpolated") {
  const Volcomp volcomp = read_volcomp(etalon_text, "v.txt", VolcompFormat::etalon, false);
  const ErrorTable& x = volcomp.tables.at('X');
  REQUIRE(x.positions.size() == 3);
  CHECK(x.errors[1][0] == doctest::Approx(2e-6));
  CHECK(x.errors[1][3] == doctest::Approx(2e-5));
  CHECK(x.errors[2][3] == doctest::Approx(3e-5));
  CHECK(volcomp.position_errors.at("C0Y") == 2e-5);
}

TEST_CASE("a byte order mark before a file of volumetric compensation does not matter") {
  const Volcomp volcomp = read_volcomp("\xEF\xBB\xBF" + etalon_text, "v.txt", VolcompFormat::etalon, false);
  CHECK(volcomp.position_errors.at("C0Y") == 2e-5);
  CHECK(volcomp_error("\xEF\xBB\xBF"
                      "X EXX\n0 nan\n1 0\n",
                      VolcompFormat::isg)
            .starts_with("v.txt:2:3: "));
}

TEST_CASE("a constant that is stated twice has one value") {
  using enum VolcompFormat;
  CHECK(read_volcomp("C0Y\n0.00002\n0.00002\n", "v.txt", isg, false).position_errors.at("C0Y") == 2e-5);
  CHECK(volcomp_error("X EXX C0Y\n0 0 0.00001\n10 0 0.00002\n", isg) ==
        "v.txt:3:6: error: C0Y is 0.00002, but 0.00001 in line 2; a constant has one value: remove the wrong "
        "one");
  CHECK(volcomp_error("[C0Y]\nVALUE = 0.00002\n[C0Y]\nVALUE = 0.00005\n", etalon).starts_with("v.txt:4:9: "));
}

TEST_CASE("the text of a table is read as the same table") {
  const ErrorTable x = read_volcomp(isg_text, "v.csv", VolcompFormat::isg, false).tables.at('X');
  const Machine machine = read_machine("format = \"counterflex-machine 1\"\n" + table_text('X', x) +
                                           "[[chain]]\nname = \"a\"\nelements = [{ actuator = \"prismatic\", "
                                           "axis = \"x\", error_table = \"x\" }]\n",
                                       "m.toml");
  const ErrorTable& again = *std::get<Actuator>(machine.chains[0].elements[0]).errors;
  REQUIRE(again.positions == x.positions);
  for (std::size_t k = 0; k < x.errors.size(); ++k) CHECK((again.errors[k] - x.errors[k]).norm() < 1e-12);
}

TEST_CASE("a bad file of volumetric compensation is refused at line and column") {
  using enum VolcompFormat;
  CHECK(volcomp_error("X EXX\n0 0.1\n0 0.2\n", isg) ==
        "v.txt:3:1: error: position 0 of EXX is not above the one before it; positions must increase");
  CHECK(volcomp_error("X EXX\n0 0.1 0.2\n", isg) ==
        "v.txt:2:1: error: the line has 3 numbers, but the header names 2");
  CHECK(volcomp_error("X EXX\n0 nan\n1 0\n", isg) ==
        "v.txt:2:3: error: \"nan\" is not a number; decimals have a point");
  CHECK(volcomp_error("Z X EXX\n0 0 1\n", isg) ==
        "v.txt:1:3: error: the errors depend on Z and X; tables of one position are read");
  CHECK(volcomp_error("Y EXX\n0 1\n", isg) ==
        "v.txt:1:3: error: EXX needs positions of X in the first column");
  CHECK(volcomp_error("X PITCH\n0 1\n", isg) ==
        "v.txt:1:3: error: \"PITCH\" is not the name of an error: EXX to ECC, or A0Y and others");
  CHECK(volcomp_error("", isg) == "v.txt: error: the file has no errors; is it of this format?");
  CHECK(volcomp_error("[EXX]\nGridpoints = {\n0 1\n", etalon) ==
        "v.txt:1:2: error: EXX has no } behind its table");
  CHECK(volcomp_error("[EXX]\nPoints\n", etalon) ==
        "v.txt:2:1: error: \"Points\" is not expected here; a block is [EXX] with Gridpoints = { or VALUE =");
}
