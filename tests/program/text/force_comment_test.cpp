#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a FORCE comment acts from its own block until the next one") {
  const Program program = read(
      "G21 G0 X1\n(FORCE FX=215 FY=-10 FZ=-25.5 MX=1 MY=21.5)\nG1 X2 F100\nX3 (force fz=+3)\nX4\n(FORCE "
      "OFF)\nX5\n");
  Vector6 first;
  first << 215, -10, -25.5, 1, 21.5, 0;
  Vector6 second;
  second << 0, 0, 3, 0, 0, 0;
  CHECK_FALSE(program.moves[0].force.has_value());
  CHECK(program.moves[1].force == first);
  CHECK(program.moves[2].force == second);
  CHECK(program.moves[3].force == second);
  CHECK_FALSE(program.moves[4].force.has_value());
}

TEST_CASE("a FORCE comment of zeros is a force, OFF is not") {
  const Program program = read("G21 G0 X1 (FORCE FX=0)\nX2 (FORCE OFF)\n");
  CHECK(program.moves[0].force == Vector6(Vector6::Zero()));
  CHECK_FALSE(program.moves[1].force.has_value());
}

TEST_CASE("comments that only begin like FORCE are ordinary comments") {
  CHECK_FALSE(read("(FORCES FX=1)\n(NO FORCE)\nG21 G0 X1\n").moves[0].force.has_value());
}

TEST_CASE("a malformed FORCE comment has the exit status of forces") {
  try {
    read("G21\nG0 X1 (FORCE FX=215N)\n");
    FAIL("was read");
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    CHECK(std::string(error.what()) == "p.ngc:2:17: error: '215N' is not a number for FX");
  }
}
