#include <doctest/doctest.h>

#include <limits>

#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("the summary has at most twelve lines: verdict, deviation, force, program, files") {
  MadeUpRun run;
  run.facts.warnings = {{0, "a general warning"}};
  run.facts.attribution = true;
  RunReport report = compensated(run, small_compensation());
  report.sanity = {{"travel", SanityState::ok, "in range"},
                   {"feed force", SanityState::doubtful, "backwards"}};
  const std::string text = summary_text(report, {"r.html"}, false);
  CAPTURE(text);
  CHECK(lines_of(text).size() <= 12);
  CHECK(contains(text, "\ncompensate made_up.ngc on Mill\n"));
  CHECK(contains(text, "  before      0.5000 mm, line 4: assembly "));
  CHECK(contains(text,
                 "  after       0.0050 mm, line 4 (100 times smaller); by the model, tolerance 0.0050 mm\n"));
  CHECK(contains(text, "; 30 % more: 0.0800 mm, 30 % less: 0.0700 mm, none: 0.2500 mm\n"));
  CHECK(contains(text, "3 of 5 moves corrected individually, 1 with one shift for their contour, 1 held, 2"));
  CHECK(contains(text, "  checks 1/2  feed force: backwards\n"));
  CHECK(contains(text, "  written     no corrected program, r.html\n"));
  CHECK(contains(text, "1 warning; -v shows all numbers\n"));
  const std::vector<std::string> parts{"a", "b", "c", "d", "e", "f", "g"};
  CHECK(contains(summary_text(report, parts, false),
                 "  written     no corrected program, a, b, c, d, e and 2 more\n"));
}

TEST_CASE("the details show before and after, and call the remainder a model residual") {
  MadeUpRun run;
  run.facts.warnings = {{0, "a general warning"}, {6, "a warning"}};
  const std::string text = details_text(compensated(run, small_compensation()), false);
  CAPTURE(text);
  CHECK(contains(text, "compensate made_up.ngc\n  on Mill\n  method direct, tolerance 0.0050 mm\n"));
  CHECK(contains(text, "  largest                                 0.5000        0.0050\n"));
  CHECK(contains(text, "model residual: what the model leaves, not the accuracy of the part"));
  CHECK(contains(text, "100 times smaller"));
  RunReport exact = compensated(run, small_compensation());
  exact.after->max_mm = 1e-15;
  CHECK_FALSE(contains(details_text(exact, false), "times smaller"));
  CHECK(contains(text,
                 "  load: cutting forces alone              0.0000      0.1500      0.2000      0.2500\n"));
  CHECK(contains(
      text,
      "  3 of 5 moves corrected individually, 2 points added\n  1 with one shift for their contour, 1 "
      "held\n"));
  CHECK(contains(
      text,
      "  With the force 30 % higher (wear, override) the corrected program is off by up to 0.0800 "
      "mm, line\n  4; with it 30 % lower the corrected program is off by up to 0.0700 mm, line 4.\n"));
  CHECK(contains(text, "corrected program is off by up to\n  0.2500 mm, line 4.\n"));
  CHECK(contains(
      text,
      "Not corrected individually: 2 moves, first lines and reasons\n  line 5: exact stop: not split\n"));
  CHECK(contains(text, "2 warnings\n  a general warning\n  line 6: a warning\n"));
  CHECK(contains(text, "Assumptions\n  Program coordinates were taken as machine coordinates"));
}

TEST_CASE("the details of a prediction show no residual") {
  const MadeUpRun run;
  const std::string text = details_text(predicted(run, made_up_waypoints()), false);
  CHECK(contains(text, "  largest                                 0.5000\n"));
  CHECK_FALSE(contains(text, "after"));
  CHECK_FALSE(contains(text, "residual"));
}

TEST_CASE("a machine that is unstable under more force is reported in summary, warning and JSON") {
  const MadeUpRun run;
  const Compensation c = small_compensation();
  RunReport report = compensated(run, c);
  add_made_up_sensitivity(report, c.waypoints, Status::unstable);
  const std::string text = details_text(report, false);
  CAPTURE(text);
  CHECK(
      contains(text, "With the force 30 % higher (wear, override) the machine has no stable equilibrium in"));
  REQUIRE(report.warnings.count == 1);
  CHECK(report.warnings.rows[0].line == 4);
  CHECK(contains(report.warnings.rows[0].what, "unstable; 1 place in all"));
  CHECK(contains(to_json(report), "\"force_plus_30\": null"));
  CHECK_FALSE(contains(to_json(report), "\"force_minus_30\": null"));
  CHECK_FALSE(report.failure);
}

TEST_CASE("a machine with masses has a fifth row of sources") {
  MadeUpRun run;
  run.machine.chains.push_back({"arm", {PointMass{40, Vector3::Zero()}}});
  run.machine.gravity.g = {0, 0, -9.81};
  Compensation c = small_compensation();
  c.waypoints[0].causes->gravity.head<3>() = Vector3(0, 0, -0.02) * mm;
  c.waypoints[0].causes->superposition.head<3>() += Vector3(0, 0, -0.02) * mm;
  const RunReport report = compensated(run, c);
  const std::string text = details_text(report, false);
  CAPTURE(text);
  CHECK(contains(text,
                 "  gravity: weights alone                  0.0000      0.0000      0.0200      0.0200\n"
                 "  superposition: sums at each place "));
  CHECK(contains(text, "  all acting together "));
  CHECK(contains(text, "  where the deviation is largest, line 4:\n"));
  CHECK(contains(to_json(report), "\"gravity\": {\n        \"max_mm\": 0.02,"));
}

TEST_CASE("moves without a force are listed by reason, in the summary and the JSON") {
  const MadeUpRun run;
  RunReport report = compensated(run, small_compensation());
  for (int line = 14; line < 24; ++line) add_unforced(report.forces.without, {line, 7.5 * mm, "a plunge"});
  add_unforced(report.forces.without, {12, 4.2 * mm, "no speed"});
  for (const int line : {30, 31})
    add_unforced(report.forces.without,
                 {line, std::numeric_limits<double>::quiet_NaN(), "the position in XY is unknown"});
  const std::string text = details_text(report, false), json = to_json(report);
  CHECK(contains(text,
                 "  13 feed moves, 79.200 mm, 2 of unknown length, cut without a force\n"
                 "    10 moves, 75.000 mm, from line 14 on: a plunge\n"
                 "    1 move, 4.200 mm, from line 12 on: no speed\n"
                 "    2 moves, length unknown, from line 30 on: the position in XY is unknown\n"));
  CHECK(contains(json, "\"moves\": 13,\n      \"unknown_length\": 2,\n      \"length_mm\": 79.2,"));
  CHECK(
      contains(json,
               "\"why\": \"no speed\",\n          \"moves\": 1,\n          \"unknown_length\": 0,\n          "
               "\"length_mm\": 4.2,\n          \"first_line\": 12\n"));
  CHECK(contains(json, "\"moves\": 2,\n          \"unknown_length\": 2,\n          \"length_mm\": null,"));
  CHECK(contains(json, "\"rows\": [\n        {\n          \"line\": 12,\n          \"length_mm\": 4.2,"));
}

TEST_CASE("the summary of a prediction shows the effect of more and less force on the program") {
  const MadeUpRun run;
  const std::string text = details_text(predicted(run, made_up_waypoints()), false);
  CAPTURE(text);
  CHECK(contains(text, "With the force 30 % higher (wear, override) the program is off by up to"));
  CHECK(
      contains(text, "Without the force (dry run, spring pass, broken insert) the program is off by up to"));
}

TEST_CASE("a summary without causes names the option for them") {
  MadeUpRun run;
  const char* const how = "\nFor causes along the path add --report NAME or --json.\n";
  CHECK_FALSE(contains(details_text(compensated(run, small_compensation()), false), how));
  run.facts.attribution = false;
  const std::string text = details_text(compensated(run, small_compensation()), false);
  CAPTURE(text);
  CHECK(contains(text, how));
  CHECK_FALSE(contains(text, "Causes of the deviation"));
  CHECK(contains(text, "30 % higher"));
}

TEST_CASE("the summary of a failure shows the failure and only known numbers") {
  const MadeUpRun run;
  Compensation none;
  none.failure = Failure{ErrorKind::limit, 4, "the correction is too large"};
  RunReport report = compensated(run, none);
  report.exit_status = 6;
  const std::string text = details_text(report, false);
  CHECK(text.starts_with("FAILED\n"));
  CHECK(contains(text,
                 "Failed (exit status 6)\n  line 4: the correction is too large\n  No corrected program was "
                 "written.\n"));
  CHECK_FALSE(contains(text, "Deviation of the tool tip"));
  CHECK_FALSE(contains(text, "Cutting force"));
}

TEST_CASE("long lists are cut short in the summary, with their number") {
  MadeUpRun run;
  for (int line = 1; line <= 30; ++line) run.program.left_alone.push_back({line, "why"});
  const std::string text = details_text(predicted(run, {}), false);
  CHECK(contains(text, "Not or partly corrected: first lines and reasons\n  line 1: why\n"));
  CHECK(contains(text, "  line 5: why\n  and 25 more\n"));
}

TEST_CASE("blocks in machine coordinates are not among the moves that are not corrected") {
  MadeUpRun run;
  run.program.left_alone = {{2, "G28 moves to a position of the machine", true}, {5, "a variable"}};
  const RunReport report = compensated(run, small_compensation());
  const std::string text = details_text(report, false);
  CAPTURE(text);
  CHECK(contains(text, "first lines and reasons\n  line 5: a variable\n  line 5: exact stop: not split\n\n"));
  CHECK(contains(text,
                 "In machine coordinates, not changed: 1 block\n  line 2: G28 moves to a position of the "
                 "machine\n"));
  CHECK(contains(to_json(report), "\"left_alone_count\": 2,"));
  CHECK(contains(to_json(report), "\"machine_positions_count\": 1,"));
}

TEST_CASE("the summary is at most 100 characters wide and has no trailing blanks") {
  MadeUpRun run;
  std::string sentence;
  for (int i = 0; i < 60; ++i) sentence += "word" + std::to_string(i) + " ";
  run.facts.warnings = {{123456, sentence}};
  run.machine.work["G54"].datum.touched_at = Vector3(1, 2, 3);
  run.path.frames[0].name = "G54";
  const std::string text = details_text(compensated(run, small_compensation()), false);
  for (const std::string& line : lines_of(text)) {
    CAPTURE(line);
    CHECK(line.size() <= 100);
    CHECK((line.empty() || line.back() != ' '));
  }
}

TEST_CASE("colour adds only escape sequences") {
  const MadeUpRun run;
  const RunReport report = compensated(run, small_compensation());
  const std::string plain = details_text(report, false), coloured = details_text(report, true);
  CHECK_FALSE(contains(plain, "\033"));
  std::string stripped;
  for (std::size_t i = 0; i < coloured.size(); ++i) {
    if (coloured[i] == '\033')
      i = coloured.find('m', i);
    else
      stripped += coloured[i];
  }
  CHECK(stripped == plain);
  CHECK(coloured != plain);
}

TEST_CASE("a run in one line names the program, before and after") {
  const MadeUpRun run;
  CHECK(one_line(compensated(run, small_compensation())) ==
        "made_up.ngc: PARTLY (62 % of the cutting length, 2 feed moves of unknown deviation), 0.5000 mm "
        "before, "
        "0.0050 mm after (model residual)");
  CHECK(one_line(predicted(run, made_up_waypoints())) == "made_up.ngc: PREDICTED, 0.5000 mm before");
}
