#include "counterflex/report/run_tally.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"
#include "support/windows.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Whole thousandths from 0 to 1, the same with every standard library.
class Thousandths {
 public:
  explicit Thousandths(std::uint64_t seed) : bits_(seed) {}
  double next() { return static_cast<double>(bits_() % 1001) / 1000; }
  int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(n)); }

 private:
  std::mt19937_64 bits_;
};

Vector6 random_deviation(Thousandths& random) {
  Vector6 d;
  for (int i = 0; i < 6; ++i) d[i] = random.next() * 1e-4;
  return d;
}

Waypoint random_waypoint(Thousandths& random, std::size_t segment, int line) {
  Waypoint w = cut(segment, line, random.next(), Vector3::Zero());
  w.before = random_deviation(random);
  w.after = random_deviation(random) / 10;
  w.causes->geometry = random_deviation(random);
  w.causes->load = random_deviation(random);
  w.causes->gravity = random_deviation(random);
  w.causes->air = random_deviation(random);
  w.correction = random.below(3) == 0 ? Vector6(Vector6::Zero()) : random_deviation(random);
  w.wrench = 1e5 * random_deviation(random);
  return w;
}

/// A feed run that starts where `w` is.
Waypoint start_of(Waypoint w) {
  w.between = w.place = true;
  w.fraction = w.weight = 0;
  return w;
}

/// A path of rapids, and feed moves of up to four pieces with samples inside: some not solved, some after the
/// start of a feed run.
std::vector<Waypoint> random_path(std::uint64_t seed, int moves) {
  Thousandths random(seed);
  std::vector<Waypoint> path;
  int line = 1;
  for (int move = 0; move < moves; ++move) {
    line = random.below(8) == 0 ? 1 + random.below(line) : line + random.below(3);
    const std::size_t segment = random.below(10) == 0 ? no_segment : static_cast<std::size_t>(move);
    const bool rapid = random.below(4) == 0;
    for (int samples = rapid ? 1 : 1 + random.below(4); samples > 0; --samples) {
      Waypoint w = random_waypoint(random, segment, line);
      w.cutting = !rapid;
      w.between = samples > 1 && random.below(2) == 0;
      w.place = !w.between;
      if (random.below(20) == 0) w.status = Status::singular;
      if (!path.empty() && !path.back().cutting && w.cutting) path.push_back(start_of(w));
      path.push_back(w);
    }
  }
  return path;
}

std::vector<Waypoint> part(const std::vector<Waypoint>& all, std::size_t first, std::size_t last) {
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last)};
}

/// All outputs of the three commands for one tally.
std::string reports_of(const MadeUpRun& run, const RunTally& tally) {
  const Overview overview = overview_of(run.program);
  const RunContext context = run.context(overview);
  return to_json(report_prediction(context, tally, {})) + to_json(report_compensation(context, tally, {})) +
         to_json(report_verification(context, tally, overview, {}));
}

std::string reports_of_parts(const MadeUpRun& run, const std::vector<Waypoint>& path, std::size_t a,
                             std::size_t b) {
  RunTally tally(2);
  for (const auto& [first, last] : {std::pair{std::size_t{0}, a}, {a, b}, {b, path.size()}})
    tally.add_waypoints(part(path, first, last));
  return reports_of(run, tally);
}

}  // namespace

TEST_CASE("waypoints added in any parts give the same report as added at once") {
  const MadeUpRun run;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<Waypoint> path = random_path(seed, 30);
    const std::string expected = reports_of_parts(run, path, 0, 0);
    for (std::size_t k = 0; k <= path.size(); ++k) {
      CAPTURE(seed);
      CAPTURE(k);
      CHECK(reports_of_parts(run, path, k, std::min(k + 1, path.size())) == expected);
    }
  }
}

TEST_CASE("a division after the start of a feed run loses neither the start nor its weight") {
  Waypoint start = start_of(cut(1, 4, 10, Vector3(0, 0.8, 0))), between = cut(1, 4, 50, Vector3::Zero()),
           feed = cut(1, 4, 40, Vector3(0, 0.4, 0));
  between.between = true;
  between.place = false;
  RunTally tally(2);
  for (const Waypoint& w : {start, between, feed}) tally.add_waypoints({w});
  const DeviationStatistics before = tally.path().measures().before.statistics();
  CHECK(before.max_mm == doctest::Approx(0.8));
  CHECK(before.max_line == 4);
  CHECK(before.mean_mm == doctest::Approx(0.6));
}

TEST_CASE("a feed run does not weigh on the end of the one before it") {
  RunTally tally(2);
  for (const Waypoint& w : {start_of(cut(0, 3, 5, Vector3(0.2, 0, 0))), cut(0, 3, 5, Vector3(0.2, 0, 0)),
                            start_of(cut(1, 4, 15, Vector3(0.6, 0, 0))), cut(1, 4, 15, Vector3(0.6, 0, 0))})
    tally.add_waypoints({w});
  CHECK(tally.path().measures().before.statistics().mean_mm == doctest::Approx((0.2 * 10 + 0.6 * 30) / 40));
}

TEST_CASE("reading a tally in the middle of a path does not affect later results") {
  const MadeUpRun run;
  const std::vector<Waypoint> path = random_path(7, 40);
  RunTally asked(2), silent(2);
  for (const Waypoint& w : path) {
    asked.add_waypoints({w});
    silent.add_waypoints({w});
    (void)reports_of(run, asked);
  }
  CHECK(reports_of(run, asked) == reports_of(run, silent));
}

TEST_CASE("a corrected program read in windows gives the same report as read at once") {
  MadeUpRun run;
  // 600 mm/min are 10 mm/s: short blocks of 0.1 to 1.9 ms among others, and lines near the limit
  std::string text = "G21 G90 G94\nG0 X0 Y0 Z0\nG1 F600\n";
  for (int i = 1; i <= 20; ++i)
    text += "X" + std::to_string(i) + "\nX" + std::to_string(i) + ".00" + std::to_string(i % 10) + " (" +
            std::string(200 + i * 2, 'c') + ")\n";
  const Program corrected = read_program(text, "made_up.comp.ngc", {});
  RunTally whole(2);
  whole.add_corrected(corrected);
  REQUIRE(whole.short_blocks()->count == 18);
  REQUIRE(whole.lines()->near > 0);
  for (const int lines_each : {1, 2, 3, 10}) {
    CAPTURE(lines_each);
    RunTally tally(2);
    for (const Program& window : windows_of(corrected, lines_each)) tally.add_corrected(window);
    CHECK(reports_of(run, tally) == reports_of(run, whole));
    CHECK(tally.short_blocks()->shortest_ms == whole.short_blocks()->shortest_ms);
    CHECK(tally.lines()->lines == whole.lines()->lines);
  }
}

TEST_CASE("lines and short blocks are reported only if a program was written") {
  const MadeUpRun run;
  CHECK(contains(reports_of(run, RunTally(2)), "\"short_blocks\": null,\n    \"lines\": null"));
}

TEST_CASE("forces of windows add up: ramps, jumps and notes, the largest step of all") {
  const MadeUpRun run;
  REQUIRE(run.forces.ramps() + run.forces.jumps() > 0);
  RunTally tally(2);
  tally.add_forces(run.forces);
  tally.add_forces(run.forces);
  CHECK(tally.forces().ramps == 2 * run.forces.ramps());
  CHECK(tally.forces().jumps == 2 * run.forces.jumps());
  CHECK(tally.forces().largest_step_N == run.forces.largest_step_N());
}

TEST_CASE("moves without a force are counted, with their length, by reason, and the first ones are listed") {
  WithoutForce without;
  for (int i = 0; i < 150; ++i)
    add_unforced(without, {1000 - i, 2 * mm, i % 3 == 0 ? "a plunge" : "no spindle speed"});
  CHECK(without.moves == 150);
  CHECK(without.length_mm == doctest::Approx(300));
  REQUIRE(without.reasons.size() == 2);
  CHECK(without.reasons[0].why == "a plunge");
  CHECK(without.reasons[0].moves == 50);
  CHECK(without.reasons[0].length_mm == doctest::Approx(100));
  CHECK(without.reasons[0].first_line == 853);
  CHECK(without.reasons[1].moves == 100);
  CHECK(without.rows.count == 150);
  REQUIRE(without.rows.rows.size() == listed_at_most);
  CHECK(without.rows.rows[0].line == 851);
  CHECK(without.rows.rows[0].length_mm == doctest::Approx(2));
}

TEST_CASE("with many different reasons the last row collects the rest") {
  WithoutForce without;
  for (int i = 0; i < 300; ++i) add_unforced(without, {i + 1, mm, "reason " + std::to_string(i)});
  add_unforced(without, {400, std::numeric_limits<double>::quiet_NaN(), "reason 400"});
  REQUIRE(without.reasons.size() == listed_at_most);
  CHECK(without.reasons[98].why == "reason 98");
  CHECK(without.reasons[99].why == "other reasons");
  CHECK(without.reasons[99].moves == 202);
  CHECK(without.reasons[99].unknown_length == 1);
  CHECK(without.unknown_length == 1);
  CHECK(without.reasons[99].length_mm == doctest::Approx(201));
  CHECK(without.reasons[99].first_line == 100);
}

TEST_CASE("compensations of windows add up") {
  const MadeUpRun run;
  RunTally tally(2);
  for (int window = 0; window < 3; ++window) {
    Compensation c;
    c.text = "G21\n";
    c.corrected_moves = 2;
    c.other_moves = {.grouped = 1, .held = 2, .in_part = 3, .left = 4};
    c.counts.inserted_blocks = 5;
    for (int i = 0; i < 60; ++i) c.left_alone.push_back({100 * window + i, "why"});
    tally.add_compensation(c);
  }
  const Overview overview = overview_of(run.program);
  const RunReport report = report_compensation(run.context(overview), tally, {});
  CHECK(report.blocks.corrected == 6);
  CHECK(report.blocks.others->grouped == 3);
  CHECK(report.blocks.others->held == 6);
  CHECK(report.blocks.others->in_part == 9);
  CHECK(report.blocks.others->left == 12);
  CHECK(report.blocks.inserted == 15);
  CHECK(report.text_after->bytes == 12);
  CHECK(report.text_after->blocks == overview.blocks + 15);
  CHECK(report.blocks.left_alone.count == 180);
  CHECK(report.blocks.left_alone.rows.size() == listed_at_most);
  CHECK(report.blocks.left_alone.rows.back().line == 139);
}

TEST_CASE("a narrowed contour is a warning, except for a tool that is known to fit with room to spare") {
  const MadeUpRun run;
  Compensation c;
  c.narrowed = {{.line = 5, .tool = 3, .programmed_mm = 25, .written_mm = 13.838}};
  const auto warnings_with = [&](std::optional<double> diameter) {
    RunTally tally(2, {}, {{3, diameter, {}}});
    tally.add_compensation(c);
    const Overview overview = overview_of(run.program);
    return report_compensation(run.context(overview), tally, {}).warnings;
  };
  CHECK(warnings_with(0.022).count == 0);
  CHECK(contains(warnings_with(0.023).rows.at(0).what, "T3 (23 mm) leaves less"));
  CHECK(contains(warnings_with(0.051).rows.at(0).what, "T3 (51 mm) is too large"));
  const Capped<Remark> unknown = warnings_with({});
  REQUIRE(unknown.count == 1);
  CHECK(unknown.rows[0].line == 5);
  CHECK(contains(unknown.rows[0].what, "13.83 mm"));
  CHECK(contains(unknown.rows[0].what, "25.00 mm"));
}

TEST_CASE(
    "a contour that the tool passes as programmed only is a failure, whose radius D of its block gives") {
  const auto failure_with = [&](std::optional<double> diameter, std::optional<double> stated_mm) {
    Compensation c;
    c.narrowed = {
        {.line = 5, .tool = 3, .programmed_mm = 25, .written_mm = 13.838, .diameter_mm = stated_mm}};
    RunTally tally(2, {}, {{3, diameter, {}}});
    tally.add_compensation(c);
    const std::optional<Failure> failure = tally.contour_failure(c);
    if (failure) CHECK(tally.contour_notes().count == 0);
    return failure;
  };
  CHECK_FALSE(failure_with({}, {}));
  CHECK_FALSE(failure_with(0.027, {}));
  const std::optional<Failure> failure = failure_with(0.028, {});
  REQUIRE(failure);
  CHECK(failure->kind == ErrorKind::not_compensated);
  CHECK(failure->line == 5);
  CHECK(contains(failure->what, "verification failed: "));
  CHECK(contains(failure->what, "T3 (28 mm) is too large"));
  CHECK_FALSE(failure_with(0.051, {}));  // it does not pass the programmed contour, either
  CHECK(failure_with({}, 28));
  CHECK(failure_with(0.01, 28));
  CHECK_FALSE(failure_with(0.028, 10));
}

TEST_CASE("of written targets with the largest correction the first is named, whatever window it is in") {
  const MadeUpRun run;
  RunTally tally(2);
  for (const int line : {4, 5, 6})
    tally.add_waypoints({cut(1, line, 1, Vector3(0, 0, line == 4 ? 0.1 : 0.3))});
  const Overview overview = overview_of(run.program);
  const RunReport report = report_compensation(run.context(overview), tally, {});
  REQUIRE(report.correction);
  CHECK(report.correction->mm == doctest::Approx(0.3));
  CHECK(report.correction->line == 5);
}

TEST_CASE("blocks listed by the program come before the compensation's of the same line") {
  MadeUpRun run;
  run.program.left_alone = {{7, "first"}, {9, "later"}};
  Compensation c;
  c.left_alone = {{5, "earlier"}, {7, "second"}};
  const RunReport report = compensated(run, c);
  REQUIRE(report.blocks.left_alone.rows.size() == 4);
  CHECK(report.blocks.left_alone.rows[0].why == "earlier");
  CHECK(report.blocks.left_alone.rows[1].why == "first");
  CHECK(report.blocks.left_alone.rows[2].why == "second");
  CHECK(report.blocks.left_alone.rows[3].why == "later");
}

TEST_CASE("operations are distinguished by tool and comment, and their sum is the whole") {
  const std::string text =
      "G21 G90 G0 X0 Y0 Z0\n"
      "(ROUGH)\n"
      "T1 M6\n"
      "G1 X100 F600\n"
      "(REMARK)\n"
      "T2 M6\n"
      "Y50\n"
      "\n"
      "(FINISH)\n"
      "X90\n"
      "M30\n";
  MadeUpRun run;
  run.read(text, "made_up.ngc");
  std::vector<Waypoint> path;
  for (std::size_t i = 0; i < run.path.segments.size(); ++i) {
    const Segment& segment = run.path.segments[i];
    if (!segment.cutting) continue;
    path.push_back(cut(i, segment.line, length(segment.wanted) / mm, Vector3(0.1 * segment.line, 0, 0)));
    path.back().move = static_cast<std::uint32_t>(segment.move);
  }
  run.model.mechanism.controlled = {Component::x};
  run.job.options.tolerance = 0.1 * mm;
  path.back().after.x() = 0.2 * mm;
  const Overview overview = overview_of(run.program);
  RunTally tally(2);
  tally.add_window(run.job);
  tally.add_waypoints(path, run.job);
  const RunReport report = report_verification(run.context(overview), tally, overview, {});
  REQUIRE(report.operations.size() == 3);
  CHECK(report.operations[0].tool == 1);
  CHECK(report.operations[0].name == "ROUGH");
  CHECK(report.operations[1].tool == 2);
  CHECK(report.operations[1].name == "ROUGH");
  CHECK(report.operations[2].name == "FINISH");
  CHECK(report.operations[2].first_line == 10);
  double sum_mm = 0;
  for (const OperationReport& operation : report.operations) {
    CHECK(operation.moves == 1);
    CHECK(operation.before->max_mm == doctest::Approx(0.1 * operation.first_line));
    sum_mm += operation.length_mm;
  }
  CHECK(sum_mm == doctest::Approx(report.path_mm));
  CHECK(*report.operations[0].corrected_percent == doctest::Approx(100));
  CHECK(*report.operations[2].corrected_percent == 0);
  CHECK(*report.corrected_percent == doctest::Approx(100 * 150 / 160.0));
}

TEST_CASE("two operations without a rapid between them both include the place between them") {
  MadeUpRun run;
  run.read("G21 G90 G0 X0 Y0 Z0\n(A)\nG1 X10 F600\n\n(B)\nY30\nM30\n", "two.ngc");
  RunTally tally(2);
  std::vector<Waypoint> path{cut(0, 3, 10, Vector3(0.1, 0, 0)), cut(1, 6, 30, Vector3(0.05, 0, 0))};
  for (Waypoint& w : path) w.move = static_cast<std::uint32_t>(run.path.segments[w.segment].move);
  tally.add_window(run.job);
  tally.add_waypoints(path, run.job);
  const std::vector<OperationTally> operations = tally.path().operations();
  REQUIRE(operations.size() == 2);
  CHECK(operations[0].before.statistics().max_mm == doctest::Approx(0.1));
  CHECK(operations[0].before.statistics().mean_mm == doctest::Approx(0.1));
  CHECK(operations[1].before.statistics().max_mm == doctest::Approx(0.1));
  CHECK(operations[1].before.statistics().max_line == 6);
  CHECK(operations[1].before.statistics().mean_mm == doctest::Approx(0.075));
  CHECK(tally.path().measures().before.statistics().mean_mm == doctest::Approx((0.1 * 25 + 0.05 * 15) / 40));
}

TEST_CASE("a piece that misses the tolerance somewhere does not count as corrected") {
  PathTally tally;
  Waypoint inside = cut(0, 3, 5, Vector3(0.1, 0, 0)), end = cut(0, 3, 5, Vector3(0.1, 0, 0)),
           good = cut(1, 4, 30, Vector3(0.1, 0, 0));
  inside.between = true;
  inside.place = false;
  for (const Waypoint& w : {inside, end, good}) tally.add(w, 0, {}, !w.between);
  CHECK(tally.measures().path_mm == doctest::Approx(40));
  CHECK(tally.measures().corrected_mm == doctest::Approx(30));
  CHECK(tally.operations().at(0).corrected_mm == doctest::Approx(30));
}

TEST_CASE("a failed run has no corrected share, and operations without solved waypoints have no deviation") {
  const MadeUpRun run;
  const Overview overview = overview_of(run.program);
  const RunTally tally = run.tally(made_up_waypoints());
  CHECK(report_compensation(run.context(overview), tally, {}).corrected_percent);
  const RunReport failed =
      report_compensation(run.context(overview), tally, Failure{ErrorKind::limit, 4, "too far"});
  CHECK_FALSE(failed.corrected_percent);
  CHECK_FALSE(failed.operations.at(0).corrected_percent);
  const RunReport none = report_prediction(run.context(overview), RunTally(2), {});
  CHECK_FALSE(none.before);
}

TEST_CASE("with too many operations the last row collects all others") {
  std::string text = "G21 G90 G0 X0 Y0 Z0\n";
  for (int i = 1; i <= 150; ++i)
    text += "\n(PART " + std::to_string(i) + ")\nG1 X" + std::to_string(i) + " F600\n";
  const Program program = read_program(text, "made_up.ngc", {});
  OperationNames names;
  for (int twice = 0; twice < 2; ++twice)
    for (std::size_t m = 1; m < program.moves.size(); ++m)
      CHECK(names.number_of(program, program.moves[m]) ==
            static_cast<std::int32_t>(std::min(m, listed_at_most) - 1));
  CHECK(names.names().size() == listed_at_most);
  CHECK(names.names().back().operation == "other operations");
}
