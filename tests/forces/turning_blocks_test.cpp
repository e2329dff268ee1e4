// Blocks that turn the tool and do not move its tip.
#include <doctest/doctest.h>

#include <cmath>

#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// 10 mm along x, a turn by 90 degrees about X in place, 10 mm along y.
Program turning_in_place() {
  Program program =
      ProgramBuilder({0, 0, 0}).feed({10, 0, 0}, 600).feed({10, 0, 0}, 600).feed({10, 10, 0}, 600).program;
  MoveOrientation turn;
  turn.end = {90, 0, 0};
  program.moves[1].orientation = turn;
  return program;
}

PathForces forces_on_turn(const ForceSource& source) {
  const Program program = turning_in_place();
  const Matrix3 R0 = Matrix3::Identity(), R1 = exp_so3({90 * deg, 0, 0});
  return PathForces(source, program, build_toolpath(program, one_frame(program, {})),
                    {R0, R0, R0, R1, R1, R1});
}

const std::string rows = "# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,10,0,0\n2,0,0,20\n3,30,0,0\n";

}  // namespace

TEST_CASE("a block that only turns the tool has the force of its own row") {
  const PathForces forces = forces_on_turn(from_csv("# frame = machine\n" + rows));
  CHECK(near(forces.at(0, 1), wrench(10, 0, 0)));
  for (const double u : {0.0, 0.3, 1.0}) CHECK(near(forces.at(1, u), wrench(0, 0, 20)));
  CHECK(near(forces.at(2, 0), wrench(30, 0, 0)));
  CHECK(forces.begins_with_step(1));
  CHECK(forces.begins_with_step(2));
}

TEST_CASE("a force in axes of the tool turns with a block that only turns the tool") {
  const PathForces forces = forces_on_turn(from_csv("# frame = tool\n" + rows));
  CHECK(near(forces.at(1, 0), wrench(0, 0, 20)));
  CHECK(near(forces.at(1, 0.5), 20 * wrench(0, -std::sqrt(0.5), std::sqrt(0.5)), 3e-3));
  CHECK(near(forces.at(1, 1), wrench(0, -20, 0), 1e-9));
  CHECK(near(forces.at(2, 1), wrench(30, 0, 0)));
  CHECK(forces.at(2, 0.5, Side::before).allFinite());
}

TEST_CASE("the mean over the path counts a degree of a turn in place as a millimetre") {
  const PathForces forces = forces_on_turn(from_csv("# frame = machine\n" + rows, 3e-3));
  CHECK(near(forces.at(0, 1), wrench(10, 0, 0)));
  CHECK(near(forces.at(1, 0), wrench(10, 0, 0)));
  CHECK(near(forces.at(1, 1 / 90.0), wrench(20 / 3.0, 0, 20 / 3.0)));
  CHECK(near(forces.at(1, 1), wrench(0, 0, 20)));
  CHECK(near(forces.at(2, 0.1), wrench(10, 0, 40 / 3.0)));
  CHECK(near(forces.at(2, 1), wrench(30, 0, 0)));
  REQUIRE(forces.breaks(1).size() == 1);
  CHECK(forces.breaks(1)[0] == doctest::Approx(3 / 90.0));
}

TEST_CASE("of a force in the feed frame a block that only turns the tool has the z component") {
  ForceSource source;
  source.rules = {{"--force", {}, {}, ConstantForce{wrench(0, 5, 7), ForceFrame::feed}}};
  source.blend = 0;
  const PathForces forces = forces_on_turn(source);
  CHECK(near(forces.at(1, 0), wrench(0, 0, 7)));
  REQUIRE(!forces.notes().empty());
  CHECK(forces.notes().front().line == 2);
}
