#include <doctest/doctest.h>

#include <cmath>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

struct Listed {
  int line;
  std::string why;
};

void check_unforced(const PathForces& forces, const std::vector<Listed>& expected) {
  REQUIRE(forces.unforced().size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(forces.unforced()[i].line == expected[i].line);
    CHECK(forces.unforced()[i].why == expected[i].why);
    CHECK(forces.unforced()[i].length == doctest::Approx(10 * mm));
  }
}

const std::string not_given = "no force is given for it", in_air = "it is wholly above --air-above",
                  is_zero_force = "the force given for it is zero";

ForceSource model() {
  ForceSource source;
  source.blend = 0;
  source.rules = {{"section 1", {"cut.toml", 1, 1}, {}, respond(sample_cut())}};
  return source;
}

std::string why_not(double feed_m_s, double rpm, double slope) {
  return cutting_force(sample_cut(), feed_m_s, rpm, slope).why;
}

}  // namespace

TEST_CASE("rapids carry no force, and are not listed among the cuts without one") {
  const auto forces = forces_on(sample_program(), constant(wrench(1, 0, 0), 0));
  for (const std::size_t i : {0, 3}) CHECK(forces.at(i, 0.5) == Vector6::Zero());
  check_unforced(forces, {});
}

TEST_CASE("cuts with an unknown position are listed, with an unknown length") {
  Program program = sample_program();
  program.moves[4].known_end = program.moves[5].known_start = {false, true, true};
  program.moves[5].known_end = {false, false, true};
  const auto forces = forces_on(program, constant(wrench(1, 0, 0), 0));
  REQUIRE(forces.unforced().size() == 2);
  CHECK(forces.unforced()[0].line == 5);
  CHECK(forces.unforced()[0].why == "the position in X is unknown");
  CHECK(forces.unforced()[1].why == "the position in XY is unknown");
  for (const Unforced& move : forces.unforced()) CHECK(std::isnan(move.length));
}

TEST_CASE("cuts outside all FORCE comments are listed, and those under a zero with another reason") {
  Program program = sample_program();
  program.moves[2].force = wrench(1, 0, 0);
  program.moves[4].force = wrench(0, 0, 0);
  check_unforced(forces_on(program, {}), {{2, not_given}, {5, is_zero_force}, {6, not_given}});
}

TEST_CASE("zeros count as a given force, and cuts with only zeros are listed") {
  const std::vector<Listed> all{
      {2, is_zero_force}, {3, is_zero_force}, {5, is_zero_force}, {6, is_zero_force}};
  const std::string columns = "line,fx_N,fy_N,fz_N\n";
  check_unforced(forces_on(sample_program(), from_csv(on_tool + columns + "1,0,0,0\n")), all);
  check_unforced(forces_on(sample_program(), from_csv(linear + columns + "1,0,0,0\n6,0,0,0\n")), all);
  check_unforced(forces_on(sample_program(), constant(Vector6::Zero(), 0)), all);
  check_unforced(forces_on(sample_program(), from_csv(on_tool + columns + "1,1,0,0\n3,0,0,0\n5,0,0,2\n")),
                 {{3, is_zero_force}});
}

TEST_CASE("a cut that has a force on a part of its length is a cut with a force") {
  const auto source = from_csv(on_tool + "s_mm,fx_N,fy_N,fz_N\n0,0,0,0\n15,1,0,0\n16,0,0,0\n");
  check_unforced(forces_on(sample_program(), source),
                 {{2, is_zero_force}, {5, is_zero_force}, {6, is_zero_force}});
}

TEST_CASE("a scale of zero removes all forces, but keeps a model's own reasons") {
  ForceSource scaled = constant(wrench(1, 2, 3), 0);
  scaled.scale = 0;
  check_unforced(forces_on(sample_program(), scaled),
                 {{2, is_zero_force}, {3, is_zero_force}, {5, is_zero_force}, {6, is_zero_force}});
  Program program = ProgramBuilder({0, 0, 0}).feed({10, 0, 0}, 600).feed({10, 0, -10}, 600).program;
  for (Move& move : program.moves) move.spindle_rpm = 3000;
  ForceSource source = model();
  source.scale = 0;
  check_unforced(forces_on(program, source), {{1, is_zero_force}, {2, why_not(0.01, 3000, -1)}});
}

TEST_CASE("cuts in the air are listed, and need no rule") {
  ForceSource source = from_csv(on_tool + "tool,fx_N,fy_N,fz_N\nT1,100,0,0\n");
  source.air_above_mm = 4.9;
  check_unforced(forces_on(sample_program(), source), {{5, in_air}, {6, in_air}});
}

TEST_CASE(
    "moves without a force from a cutting model are listed with the reason: plunges, retracts, no feed, no "
    "speed") {
  Program program = ProgramBuilder({0, 0, 0})
                        .feed({10, 0, 0}, 600)
                        .feed({10, 0, -10}, 600)
                        .feed({20, 0, -10}, 600)
                        .feed({20, 0, 0}, 600)
                        .feed({30, 0, 0}, 0)
                        .feed({40, 0, 0}, 600)
                        .program;
  for (Move& move : program.moves) move.spindle_rpm = 3000;
  program.moves[5].spindle_rpm = 0;
  const auto forces = forces_on(program, model());
  for (const std::size_t i : {1, 3, 4, 5}) CHECK(forces.at(i, 0.5) == Vector6::Zero());
  CHECK(near(forces.at(0, 0.5), cutting_force(sample_cut(), 0.01, 3000, 0).F));
  check_unforced(forces, {{2, why_not(0.01, 3000, -1)},
                          {4, why_not(0.01, 3000, 1)},
                          {5, why_not(0, 3000, 0)},
                          {6, why_not(0.01, 0, 0)}});
  for (const Unforced& move : forces.unforced()) CHECK(!move.why.empty());
}

TEST_CASE("a ramp is cut with the lateral part of the feed") {
  Program program = ProgramBuilder({0, 0, 0}).feed({8, 0, -6}, 600).program;
  program.moves[0].spindle_rpm = 3000;
  const auto forces = forces_on(program, model());
  CHECK(near(forces.at(0, 0.5), cutting_force(sample_cut(), 0.01, 3000, -0.6).F));
  check_unforced(forces, {});
}

TEST_CASE("on an upright arc the model follows the slope of the feed") {
  Program program = ProgramBuilder({-10, 0, 0}).feed({0, 0, 10}, 600).about({0, 0, 0}, 1).program;
  program.moves[0].spindle_rpm = 3000;
  const auto forces = forces_on(program, model());
  for (const double u : {0.21, 0.5, 0.83}) {
    CAPTURE(u);
    const Vector6 F = cutting_force(sample_cut(), 0.01, 3000, std::cos(u * pi / 2)).F;
    CHECK((forces.at(0, u) - F).norm() < 2e-3 * F.norm());
  }
  CHECK(forces.at(0, 0.05) == Vector6::Zero());  // steeper than 80 degrees
  check_unforced(forces, {});
}

TEST_CASE("a plunge whose force in the feed frame is all lateral is a cut without a force") {
  const auto source = from_csv("# frame = feed\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,1,2,0\n");
  check_unforced(forces_on(sample_program(), source), {{2, "the feed is parallel to the tool axis"}});
}
