#include "counterflex/report/report.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Compensation made_up_compensation() {
  Compensation c;
  c.text = made_up_program + std::string("G1 X1\n");
  c.waypoints = made_up_waypoints();
  c.left_alone = {{5, "exact stop: not split"}};
  c.counts.inserted_blocks = 2;
  c.corrected_moves = 3;
  return c;
}

}  // namespace

TEST_CASE("the deviation before is that of feed moves at the ends of pieces, weighted by trapezoids") {
  const MadeUpRun run;
  const RunReport report = compensated(run, made_up_compensation());
  REQUIRE(report.before);
  CHECK(report.before->max_mm == doctest::Approx(0.5));
  CHECK(report.before->max_line == 5);
  CHECK(report.before->mean_mm == doctest::Approx((125 * 0.3 + 30 * 0.5) / 160));
  CHECK(report.before->rms_mm == doctest::Approx(std::sqrt((125 * 0.09 + 30 * 0.25) / 160)));
  CHECK(report.before->max_axis_mm.isApprox(Vector3(0.3, 0.3, 0.4)));
  CHECK(report.before->max_across_mm == doctest::Approx(0.3));
  CHECK(report.before->max_along_mm == doctest::Approx(0.3));
  CHECK(report.before->max_tool_axis_mm == doctest::Approx(0.4));
  CHECK(report.path_mm == doctest::Approx(160));
}

TEST_CASE("the model residual counts the samples between the ends") {
  const MadeUpRun run;
  const RunReport report = compensated(run, made_up_compensation());
  REQUIRE(report.after);
  CHECK(report.after->max_mm == doctest::Approx(0.006));
  CHECK(report.after->max_line == 4);
  CHECK(report.after->mean_mm == doctest::Approx((75 * 0.006 + 25 * 0.003 + 50 * 0.005) / 160));
}

TEST_CASE("a compensation reports its counts, sizes, causes and the deviation without the force") {
  const MadeUpRun run;
  const RunReport report = compensated(run, made_up_compensation());
  CHECK(report.blocks.total == 6);
  CHECK(report.blocks.moves == 5);
  CHECK(report.blocks.corrected == 3);
  CHECK(report.blocks.inserted == 2);
  CHECK(report.text_before.bytes == run.program.text.size());
  REQUIRE(report.text_after);
  CHECK(report.text_after->blocks == 8);
  CHECK(report.text_after->bytes == run.program.text.size() + 6);
  REQUIRE(report.sources);
  CHECK(report.sources->geometry->max_mm == doctest::Approx(0.125));
  CHECK(report.sources->load->max_mm == doctest::Approx(0.25));
  CHECK(report.sources->superposition.max_mm == doctest::Approx(0.375));
  REQUIRE(report.air);
  CHECK(report.air->mm == doctest::Approx(0.25));
  CHECK(report.air->line == 5);
  REQUIRE(report.correction);
  CHECK(report.correction->mm == doctest::Approx(std::sqrt(3 * 81.0)));  // of the written rapid
  CHECK(report.correction->line == 3);
  CHECK(report.forces.largest_N == doctest::Approx(50));
  CHECK(report.forces.largest_Nm == doctest::Approx(2));
  CHECK(report.forces.ramps == run.forces.ramps());
}

TEST_CASE("the worst lines are ordered by the residual, or else by the deviation before") {
  const MadeUpRun run;
  const RunReport corrected = compensated(run, made_up_compensation());
  REQUIRE(corrected.worst.size() == 3);
  CHECK(corrected.worst[0].line == 4);
  CHECK(corrected.worst[0].before_mm == doctest::Approx(0.3));
  CHECK(corrected.worst[0].after_mm == doctest::Approx(0.006));
  CHECK(corrected.worst[1].line == 5);
  const RunReport prediction = predicted(run, made_up_waypoints());
  CHECK(prediction.worst[0].line == 5);
  CHECK(prediction.worst[2].line == 6);
}

TEST_CASE("at most ten worst lines are listed") {
  const MadeUpRun run;
  std::vector<Waypoint> waypoints;
  for (int line = 1; line <= 25; ++line) waypoints.push_back(cut(1, line, 1, Vector3(0.001 * line, 0, 0)));
  const RunReport report = predicted(run, waypoints);
  REQUIRE(report.worst.size() == 10);
  CHECK(report.worst.front().line == 25);
  CHECK(report.worst.back().line == 16);
}

TEST_CASE("lists are ordered by line and capped, counts are kept") {
  MadeUpRun run;
  for (int i = 0; i < 250; ++i) {
    run.program.left_alone.push_back({1000 - i, "why"});
    run.facts.warnings.push_back({500 - i, "what"});
  }
  const RunReport report = predicted(run, made_up_waypoints());
  CHECK(report.blocks.left_alone.count == 250);
  CHECK(report.blocks.left_alone.rows.size() == listed_at_most);
  CHECK(report.blocks.left_alone.rows.front().line == 751);
  CHECK(report.warnings.count == 250 + run.program.remarks.size() + run.forces.notes().size());
  CHECK(report.warnings.rows.size() == listed_at_most);
}

TEST_CASE("a plunge without lateral force is among the warnings") {
  MadeUpRun run;
  run.read("G21 G90 G0 X0 Y0 Z5\nG1 Z0 F100\nX10\n", "p.ngc");
  ForceSource source;
  source.rules =
      read_force_csv("# frame = feed\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,10,20,30\n", "f.csv");
  run.forces = PathForces(source, run.program, run.path, {Matrix3::Identity()});
  const RunReport report = predicted(run, {});
  REQUIRE(run.forces.notes().size() == 1);
  REQUIRE(report.warnings.count == 1);
  CHECK(report.warnings.rows[0].line == 2);
  CHECK(report.warnings.rows[0].what == run.forces.notes()[0].what);
}

TEST_CASE("unsolved waypoints have no deviation: a failed run is not a perfect one") {
  const MadeUpRun run;
  const Failure failure{ErrorKind::not_compensated, 4, "singular"};
  Compensation none;
  none.failure = failure;
  none.text = "G21\n";  // up to the failure
  const RunReport nothing = compensated(run, none);
  CHECK_FALSE(nothing.before);
  CHECK_FALSE(nothing.after);
  CHECK_FALSE(nothing.sources);
  CHECK_FALSE(nothing.air);
  CHECK_FALSE(nothing.text_after);
  CHECK(details_text(nothing, false).find("Program\n") == std::string::npos);
  CHECK(summary_text(nothing, {}, false).find("\n  program ") == std::string::npos);
  REQUIRE(nothing.failure);
  CHECK(nothing.failure->line == 4);
  std::vector<Waypoint> waypoints = made_up_waypoints();
  waypoints.push_back(cut(3, 6, 10, Vector3(7, 7, 7)));
  waypoints.back().status = Status::singular;
  const RunReport partly = predicted(run, waypoints, failure);
  CHECK(partly.before->max_mm == doctest::Approx(0.5));
}

TEST_CASE("a verification counts the moves and blocks of the second program") {
  const MadeUpRun run;
  Program corrected = run.program;
  corrected.block_count += 4;
  const RunReport report = verified(run, corrected, made_up_waypoints());
  CHECK(report.command == Command::verify);
  CHECK(report.blocks.inserted == 4);
  CHECK(report.blocks.corrected == 3);  // the rapid and two feed moves; the last has no correction
  CHECK(report.text_after->blocks == 10);
  CHECK(report.correction->mm == doctest::Approx(std::sqrt(3 * 81.0)));
}

TEST_CASE("a prediction whose deviation is above the tolerance is PREDICTED, not OK") {
  const MadeUpRun run;
  std::vector<Waypoint> waypoints = made_up_waypoints();
  waypoints.push_back(cut(3, 6, 50, Vector3(3.7, 0, 0)));
  const RunReport report = predicted(run, waypoints);
  CHECK(report.verdict == Verdict::predicted);
  CHECK(report.verdict_reason.empty());
  CHECK_FALSE(report.error_kind);
  CHECK(summary_text(report, {}, false).starts_with("PREDICTED\n"));
}

TEST_CASE("a prediction has no residual") {
  const MadeUpRun run;
  const RunReport report = predicted(run, made_up_waypoints());
  CHECK(report.before->max_mm == doctest::Approx(0.5));
  CHECK_FALSE(report.after);
  CHECK_FALSE(report.air);
  CHECK_FALSE(report.correction);
  CHECK_FALSE(report.text_after);
}

TEST_CASE("the report describes the work frame and the meaning of the offset in words") {
  MadeUpRun run;
  const auto report = [&] { return predicted(run, {}); };
  CHECK(report().work ==
        "Program coordinates were taken as machine coordinates: the machine file has no work offsets.");
  CHECK(
      report().datum ==
      "The machine frame was assumed to be set independently of this machine's errors: no datum is stated.");
  run.machine.work_is_machine_frame = true;
  CHECK(report().work == "Program coordinates are machine coordinates, as stated.");
  CHECK(report().datum.empty());
  run.machine.work_is_machine_frame = false;
  run.machine.work["G54"] = {};
  run.path.frames[0].name = "G54";
  run.path.frames[0].X_MW = {from_rpy(Vector3(0, 0, 90) * deg), Vector3(10, -20, 0.5) * mm};
  CHECK(report().work ==
        "G54 puts the program's origin at (10.0000, -20.0000, 0.5000) mm in the machine frame, turned by "
        "roll, pitch, "
        "yaw (0.0000, 0.0000, 90.0000) deg.");
  CHECK(report().datum ==
        "G54 was assumed to be set independently of this machine's errors: no datum is stated.");
  run.machine.work["G54"].datum.is_machine = true;
  CHECK(report().datum == "G54 was set independently of this machine's errors.");
  run.machine.work["G54"].datum.touched_at = Vector3(1, 2, 3) * mm;
  run.path.frames[0].datum_shift = Vector3(0.1, 0, -0.2) * mm;
  CHECK(report().datum.find(
            "touched off with this machine at (1.0000, 2.0000, 3.0000) mm in coordinates of G54") !=
        std::string::npos);
  CHECK(report().datum.find("(0.1000, 0.0000, -0.2000) mm in the machine frame") != std::string::npos);
}

TEST_CASE("an offset that the program changes has its first place, with a note") {
  MadeUpRun run;
  run.machine.work["G54"] = {};
  run.path.frames = {{"G54", Pose{}}, {"G54", translation({0.1, 0, 0})}};
  CHECK(predicted(run, {}).work ==
        "G54 puts the program's origin at (0.0000, 0.0000, 0.0000) mm in the machine frame, and the program "
        "changes it.");
}

TEST_CASE("the assumption is stated for every offset that the program uses") {
  MadeUpRun run;
  const auto report = [&] { return predicted(run, {}); };
  run.path.frames = {{"G54", Pose{}}, {"G55", translation({0.1, 0, 0})}, {"G56", translation({0.2, 0, 0})}};
  for (const char* name : {"G54", "G55", "G56", "G59"}) run.machine.work[name] = {};
  CHECK(report().work ==
        "G54 puts the program's origin at (0.0000, 0.0000, 0.0000) mm in the machine frame. G55 puts the "
        "program's "
        "origin at (100.0000, 0.0000, 0.0000) mm in the machine frame. G56 puts the program's origin at "
        "(200.0000, "
        "0.0000, 0.0000) mm in the machine frame.");
  CHECK(
      report().datum ==
      "G54, G55 and G56 were assumed to be set independently of this machine's errors: no datum is stated.");
  run.machine.work["G55"].datum.touched_at = Vector3(1, 2, 3) * mm;
  const std::string mixed = report().datum;
  CHECK(mixed.find("in coordinates of G55") != std::string::npos);
  CHECK(mixed.ends_with(
      "G54 and G56 were assumed to be set independently of this machine's errors: no datum is "
      "stated."));
  run.machine.work["G56"].datum.touched_at = Vector3(1, 2, 3) * mm;
  run.machine.work["G54"].datum.is_machine = true;
  CHECK(report().datum.ends_with(" G54 was set independently of this machine's errors."));
}

TEST_CASE("worst lines get the text of the program without line ends") {
  RunReport report;
  report.worst = {{.line = 2}, {.line = 1}, {.line = 4}, {.line = 9}};
  FileReader program = FileReader::of_bytes("G21\r\nG1 X1\n\n" + std::string(300, 'X'));
  add_texts(report, program);
  CHECK(report.worst[0].text == "G1 X1");
  CHECK(report.worst[1].text == "G21");
  CHECK(report.worst[2].text == std::string(200, 'X'));
  CHECK(report.worst[3].text == "");
}
