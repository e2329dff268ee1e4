#include <doctest/doctest.h>

#include "counterflex/forces/forces.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using test::wrench;

TEST_CASE("a force on the command line is three or six numbers") {
  CHECK(parse_force("215,-10,-25") == wrench(215, -10, -25));
  CHECK(parse_force(" 215, -10 ,+2.5e1,1,21.5,0") == wrench(215, -10, 25, 1, 21.5, 0));
}

TEST_CASE("any other force on the command line is a usage error that shows it") {
  const auto diagnostic = [](const char* text) {
    try {
      parse_force(text);
    } catch (const InputError& error) {
      CHECK(error.kind() == ErrorKind::usage);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK(diagnostic("1,2") ==
        "error: force '1,2' has 2 numbers, must be FX,FY,FZ or FX,FY,FZ,MX,MY,MZ in N and N m");
  CHECK(diagnostic("") ==
        "error: force '' has 1 numbers, must be FX,FY,FZ or FX,FY,FZ,MX,MY,MZ in N and N m");
  CHECK(diagnostic("1,2,3,4") ==
        "error: force '1,2,3,4' has 4 numbers, must be FX,FY,FZ or FX,FY,FZ,MX,MY,MZ in N and N m");
  CHECK(diagnostic("1,,3") == "error: force '1,,3': '' must be a finite number in N");
  CHECK(diagnostic("1,2,nan") == "error: force '1,2,nan': 'nan' must be a finite number in N");
  CHECK(diagnostic("1,2,3,4,5,6Nm") == "error: force '1,2,3,4,5,6Nm': '6Nm' must be a finite number in N m");
}
