#include <doctest/doctest.h>

#include "counterflex/forces/forces.hpp"
#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double speed_rpm = 3000;  // of the sample program's 10 mm/s and four flutes: 0.05 mm

/// The sample program with a spindle speed: plunge, 10 mm along x, 10 mm along y, 10 mm along -x.
Program turning_program() {
  Program program = sample_program();
  for (Move& move : program.moves) move.spindle_rpm = speed_rpm;
  return program;
}

std::vector<MoveForce> moves_of(const Program& program, const ForceSource& source) {
  std::optional<long> n;
  const Toolpath path = build_toolpath(program, one_frame(program, {}));
  return move_forces(source, program, path, {Matrix3::Identity()}, n);
}

ForceSource constant(const Vector6& F, ForceFrame frame = ForceFrame::machine) {
  ForceSource source;
  source.rules.push_back({.name = "a force", .content = ConstantForce{F, frame}});
  return source;
}

ForceSource model(const CuttingModel& cut) {
  ForceSource source;
  source.rules.push_back({.name = "a cut", .content = respond(cut)});
  return source;
}

}  // namespace

TEST_CASE("a wrench in machine axes is listed in the feed frame of every move") {
  const auto moves = moves_of(turning_program(), constant(wrench(10, 2, -5, 1, 2, 3)));
  REQUIRE(moves.size() == 4);
  CHECK(agree(moves[1].F, wrench(10, 2, -5, 1, 2, 3), 1e-12));    // along x
  CHECK(agree(moves[2].F, wrench(2, -10, -5, 2, -1, 3), 1e-12));  // along y
  CHECK(agree(moves[3].F, wrench(-10, -2, -5, -1, -2, 3), 1e-12));
  for (const MoveForce& move : moves) CHECK(move.feed_per_tooth == 0);
}

TEST_CASE("for a plunge only the component along the tool is listed in the feed frame, with a mark") {
  const MoveForce lost = moves_of(turning_program(), constant(wrench(10, 2, -5, 1, 2, 3)))[0];
  CHECK(lost.why.empty());
  CHECK(lost.only_z);
  CHECK(lost.F == wrench(0, 0, -5, 0, 0, 3));
  CHECK(!moves_of(turning_program(), constant(wrench(0, 0, -5)))[0].only_z);
}

TEST_CASE("a force that steps within a move is listed step by step, with its largest value") {
  const auto moves =
      moves_of(turning_program(), from_csv(on_tool + "s_mm,fx_N,fy_N,fz_N\n0,0,0,-1\n10,1,0,0\n13,0,7,0\n"
                                                     "14,2,0,0\n20,0,0,0\n"));
  REQUIRE(moves[1].steps.size() == 3);
  CHECK(moves[1].changes);
  CHECK(moves[1].largest_N == 7);
  CHECK(moves[1].F == wrench(2, 0, 0));
  CHECK(moves[1].steps[1].s == doctest::Approx(13 * mm));
  CHECK(moves[1].steps[1].F == wrench(0, 7, 0));
  CHECK(!moves[2].changes);
  CHECK(moves[2].steps.size() == 1);
}

TEST_CASE("a force that changes gradually along a move has no steps") {
  const auto moves = moves_of(
      turning_program(), from_csv(linear + "s_mm,fx_N,fy_N,fz_N\n0,0,0,-1\n10,0,0,0\n15,9,0,0\n20,0,0,0\n"
                                           "40,0,0,0\n"));
  CHECK(moves[1].steps.empty());
  CHECK(moves[1].changes);
  CHECK(moves[1].largest_N == 9);
  CHECK(!moves[2].changes);
}

TEST_CASE("round an arc a force in the feed frame is one step, and one in machine axes changes") {
  Program arc = ProgramBuilder({0, 0, 0}).arc({0, 20, 0}, {0, 10, 0}, 600).program;
  arc.operations = {""};
  const Vector6 F = wrench(5, 6, 7, 1, 2, 3);
  const auto turning = moves_of(arc, constant(F, ForceFrame::feed));
  REQUIRE(turning[0].steps.size() == 1);
  CHECK(agree(turning[0].steps[0].F, F, 1e-9));
  CHECK(moves_of(arc, constant(F))[0].steps.empty());
  CHECK(moves_of(arc, constant(wrench(0, 0, 7, 0, 0, 1)))[0].steps.size() == 1);
}

TEST_CASE("a model's moves have its feed per tooth, its wrench and its reasons") {
  const auto moves = moves_of(turning_program(), model(sample_cut()));
  CHECK(moves[0].why == "the feed is along the tool axis (plunge)");
  CHECK(moves[0].feed_per_tooth == 0);
  for (const std::size_t i : {1U, 2U, 3U}) {
    CHECK(moves[i].feed_per_tooth == doctest::Approx(0.05 * mm).epsilon(1e-12));
    CHECK(moves[i].spindle_rpm == speed_rpm);
    CHECK(agree(moves[i].F, at_feed_per_tooth(sample_cut(), 0.05 * mm), 1e-9));
  }
  CHECK(moves[2].line == 5);
  CHECK(moves[2].s_start == doctest::Approx(20 * mm));
  CHECK(moves[2].length == doctest::Approx(10 * mm));
  CHECK(moves_of(sample_program(), model(sample_cut()))[1].why ==
        "the program does not give its spindle speed");
}

TEST_CASE("the force on an upright circle follows its slope, wherever the circle begins") {
  for (const int quarter : {0, 1, 2, 3}) {  // from the bottom, a side, the top, the other side
    CAPTURE(quarter);
    const double angle = quarter * 90 * deg;
    const Vector3 start(10 * std::sin(angle), 0, -10 * std::cos(angle));
    Program circle = ProgramBuilder(start).feed(start, 600).about({0, 0, 0}, 1).program;
    circle.moves[0].spindle_rpm = speed_rpm;
    circle.operations = {""};
    const MoveForce move = moves_of(circle, model(sample_cut()))[0];
    CHECK(move.changes);
    CHECK(move.steps.empty());
    const Vector6 level = at_feed_per_tooth(sample_cut(), 0.05 * mm);
    CHECK(move.largest_N == doctest::Approx(level.head<3>().norm()).epsilon(1e-3));
  }
}

TEST_CASE(
    "the torque along a move is in one part if it is even, else in parts, those without a force empty") {
  const MoveForce level = moves_of(turning_program(), model(sample_cut()))[1];
  REQUIRE(level.torques.size() == 1);
  const CutResponse response = respond(sample_cut());
  CHECK(level.torques[0]->chip == doctest::Approx(response.F_c[5] * 0.05 * mm));
  CHECK(level.torques[0]->edge == doctest::Approx(response.F_e[5]));
  // Upright, from the bottom to 60 degrees, and to a quarter: the last 10 degrees are along the tool.
  for (const double end : {60 * deg, 90 * deg}) {
    CAPTURE(end);
    Program arc = ProgramBuilder({0, 0, -10})
                      .feed({10 * std::sin(end), 0, -10 * std::cos(end)}, 600)
                      .about({0, 0, 0}, 1, true)
                      .program;
    arc.moves[0].spindle_rpm = speed_rpm;
    arc.operations = {""};
    const MoveForce move = moves_of(arc, model(sample_cut()))[0];
    double sum = 0;
    std::size_t empty = 0;
    for (const auto& torque : move.torques) sum += torque ? torque->chip : 0, empty += !torque;
    const auto parts = static_cast<double>(move.torques.size());
    CHECK(empty == (end > 80 * deg ? 2 : 0));
    const double cut = std::min(end, 80 * deg);
    CHECK(sum / parts == doctest::Approx(level.torques[0]->chip * std::sin(cut) / end).epsilon(0.02));
  }
}

TEST_CASE("a model's own spindle speed is listed") {
  CuttingModel cut = sample_cut();
  cut.spindle_rpm = 6000;
  const MoveForce move = moves_of(sample_program(), model(cut))[1];
  CHECK(move.spindle_rpm == 6000);
  CHECK(move.feed_per_tooth == doctest::Approx(0.025 * mm));
}

TEST_CASE("listed forces include the load scale, and moves in the air have no force") {
  ForceSource source = constant(wrench(10, 0, 0));
  source.scale = 2;
  source.air_above_mm = 4;
  const auto moves = moves_of(turning_program(), source);
  CHECK(moves[1].F == wrench(20, 0, 0));
  CHECK(moves[2].why == "it is wholly above --air-above");
}

TEST_CASE("moves without a rule and programs without moves are accepted") {
  CHECK(moves_of(turning_program(), {})[1].why == "no force is given for it");
  CHECK(moves_of({}, model(sample_cut())).empty());
}

TEST_CASE("a profile in the feed frame with one row per move restores the original forces") {
  const auto moves = moves_of(turning_program(), model(sample_cut()));
  ForceProfile profile;
  profile.key = ForceKey::path_length;
  profile.frame = ForceFrame::feed;
  for (const MoveForce& move : moves)
    profile.rows.push_back({.key = move.s_start, .F = move.F, .ends = !move.why.empty()});
  ForceSource source;
  source.rules.push_back({.name = "the profile", .content = profile});
  const auto again = moves_of(turning_program(), source);
  REQUIRE(again.size() == moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    CHECK(again[i].why.empty() == moves[i].why.empty());
    CHECK(agree(again[i].F, moves[i].F, 1e-12));
  }
}

TEST_CASE("a scale and an air height change the force of a FORCE comment, unless it is zero") {
  Program program = sample_program();
  program.moves[2].force = wrench(1, 0, 0);
  program.moves[4].force = wrench(0, 0, 0);
  const auto altered = [&](const ForceSource& source) {
    std::vector<bool> moves;
    for (const MoveForce& move : moves_of(program, source)) moves.push_back(move.comment_altered);
    return moves;
  };
  const std::vector<bool> none(4, false), the_force{false, true, false, false};
  ForceSource source;
  CHECK(altered(source) == none);
  source.scale = 2;
  CHECK(altered(source) == the_force);
  source.scale = 1;
  source.air_above_mm = -1;
  CHECK(altered(source) == the_force);
}
