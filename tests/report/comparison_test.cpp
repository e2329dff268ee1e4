#include "counterflex/report/comparison.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/files/input_error.hpp"
#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

ReportFile report_named(const std::string& name, const std::string& json) {
  return {.name = name, .path = name + ".json", .sha256 = std::string(64, 'c'), .report = json};
}

/// A compensation whose deviations are `factor` times those of the made-up waypoints.
std::string made_up_report(double factor, const MadeUpRun& run) {
  Compensation c;
  c.text = "G21 G0 X1\n";
  c.waypoints = made_up_waypoints();
  for (Waypoint& w : c.waypoints) {
    w.before *= factor;
    w.after *= factor;
  }
  return to_json(compensated(run, c));
}

const ComparedNumber& number_at(const Comparison& comparison, const std::string& key) {
  for (const ComparedNumber& number : comparison.numbers)
    if (number.key == key) return number;
  FAIL(key);
  return comparison.numbers.front();
}

std::vector<std::string> what_differs(const Comparison& comparison) {
  std::vector<std::string> list;
  for (const RunDifference& difference : comparison.differences) list.push_back(difference.what);
  return list;
}

}  // namespace

TEST_CASE("a run compared with itself has no differences") {
  const MadeUpRun run;
  const ReportFile file = report_named("a", made_up_report(1, run));
  const Comparison comparison = compare(file, file, "0.1.0");
  CHECK(comparison.differences.empty());
  CHECK(comparison.same == std::vector<std::string>{"program", "machine"});
  CHECK(comparison.numbers.size() > 20);
  for (const ComparedNumber& number : comparison.numbers)
    if (number.difference()) CHECK(*number.difference() == 0);
  CHECK(contains(comparison.conclusion, "a and a have the same largest model residual: 6.0 µm."));
}

TEST_CASE("differences are the second run's value minus the first one's, percents are of the first") {
  const MadeUpRun run;
  const Comparison comparison = compare(report_named("a", made_up_report(1, run)),
                                        report_named("b", made_up_report(0.5, run)), "0.1.0");
  const ComparedNumber& before = number_at(comparison, "/summary/before/max_mm");
  CHECK(before.values[0] == 0.5);
  CHECK(before.values[1] == 0.25);
  CHECK(before.difference() == -0.25);
  CHECK(before.percent() == -50);
  CHECK(number_at(comparison, "/summary/after/max_mm").difference() == -0.003);
  CHECK(number_at(comparison, "/summary/before/max_axis_mm/1").values[0] == 0.3);
  CHECK_FALSE(number_at(comparison, "/summary/before/max_rotation_deg").percent());
  CHECK(contains(comparison.conclusion,
                 "b leaves 3.0 µm less than a: a largest model residual of 3.0 µm instead of 6.0 µm."));
  CHECK(contains(comparison.conclusion, "Uncorrected, b is off by up to 250.0 µm, 250.0 µm less than a."));
}

TEST_CASE("every number of a comparison is the one in the report") {
  const MadeUpRun run;
  const std::string json = made_up_report(1, run);
  const Comparison comparison =
      compare(report_named("a", json), report_named("b", made_up_report(2, run)), "0.1.0");
  for (const char* key : {"/blocks/moves", "/blocks/not_corrected", "/summary/path_mm", "/forces/largest_N"})
    CHECK(number_at(comparison, key).values[0].has_value());
  CHECK(number_at(comparison, "/forces/largest_N").values[0] == 50);
}

TEST_CASE("inputs differ by their bytes, not by their names; options differ by name") {
  MadeUpRun run;
  const std::string a = made_up_report(1, run);
  run.facts.inputs[0].path = "elsewhere/made_up.ngc";
  run.facts.inputs[1].sha256 = std::string(64, 'd');
  run.facts.options = {{"tolerance-mm", 0.01}, {"json", false}, {"air-above", 2.0}};
  run.machine.name = "Other mill";
  const Comparison comparison =
      compare(report_named("a", a), report_named("b", made_up_report(1, run)), "0.1.0");
  CHECK(what_differs(comparison) == std::vector<std::string>{"machine", "file: machine",
                                                             "option: tolerance-mm", "option: method",
                                                             "option: air-above"});
  CHECK(comparison.same == std::vector<std::string>{"program"});
  CHECK(comparison.differences[1].values ==
        std::array<std::string, 2>{"mill.toml (bbbbbbbbbbbbbbbb)", "mill.toml (dddddddddddddddd)"});
  CHECK(comparison.differences[2].values == std::array<std::string, 2>{"0.005", "0.01"});
  CHECK(comparison.differences[3].values == std::array<std::string, 2>{"direct", ""});
}

TEST_CASE("a run of another program is reported as such") {
  MadeUpRun run;
  const std::string a = made_up_report(1, run);
  run.facts.inputs[0].sha256 = std::string(64, 'd');
  const Comparison comparison =
      compare(report_named("a", a), report_named("b", made_up_report(1, run)), "0.1.0");
  CHECK(contains(comparison.conclusion, "The programs are different."));
}

TEST_CASE("missing values of a prediction are a dash on the terminal and null in the document") {
  const MadeUpRun run;
  const std::string prediction = to_json(predicted(run, made_up_waypoints()));
  const Comparison comparison =
      compare(report_named("a", prediction), report_named("b", made_up_report(1, run)), "0.1.0");
  const ComparedNumber& after = number_at(comparison, "/summary/after/max_mm");
  CHECK_FALSE(after.values[0]);
  CHECK_FALSE(after.difference());
  CHECK(contains(to_json(comparison), R"("values": [null, 0.006],
      "difference": null,
      "percent": null)"));
  const auto lines = lines_of(to_text(comparison, false));
  CHECK(std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
    return line == "  largest                                        -      0.0060           -";
  }));
  CHECK(contains(comparison.conclusion, "a, which corrects nothing, is off by up to 500.0 µm"));
}

TEST_CASE("two predictions, and runs without solved waypoints, also have a conclusion") {
  const MadeUpRun run;
  const ReportFile a = report_named("a", to_json(predicted(run, made_up_waypoints())));
  const ReportFile nothing = report_named(
      "b", to_json(predicted(run, {}, Failure{ErrorKind::not_compensated, 4, "no equilibrium"})));
  CHECK(contains(compare(a, a, "0.1.0").conclusion,
                 "Uncorrected, a and a are off by the same amount, by up to 500.0 µm."));
  const Comparison comparison = compare(a, nothing, "0.1.0");
  CHECK(comparison.runs[1].failure == "line 4: no equilibrium");
  CHECK(comparison.conclusion ==
        "There is no deviation to compare. b failed: its report has no deviations to compare.");
  CHECK(contains(to_text(comparison, false), "     failed: line 4: no equilibrium\n"));
  const ReportFile partly = report_named(
      "b",
      to_json(predicted(run, made_up_waypoints(), Failure{ErrorKind::not_compensated, 4, "no equilibrium"})));
  CHECK(contains(compare(a, partly, "0.1.0").conclusion,
                 " b failed: its numbers are those of the part that was solved."));
}

TEST_CASE("the conclusion is in the unit that both reports show deviations in, else in mm") {
  const auto report = [](const char* unit, const char* largest_mm) {
    return report_named("r", std::string(R"({"schema": "counterflex-report 1", "units": {"shown": ")") +
                                 unit + R"("}, "summary": {"after": {"max_mm": )" + largest_mm + "}}}");
  };
  const auto conclusion = [&](const char* unit_a, const char* unit_b) {
    return compare(report(unit_a, "0.254"), report(unit_b, "0.0508"), "").conclusion;
  };
  CHECK(contains(conclusion("inch", "inch"),
                 "a largest model residual of 0.00200 inch instead of 0.01000 inch."));
  CHECK(contains(conclusion("mm", "mm"), "of 0.0508 mm instead of 0.2540 mm."));
  CHECK(contains(conclusion("um", "um"), "of 50.8 µm instead of 254.0 µm."));
  CHECK(contains(conclusion("um", "inch"), "of 0.0508 mm instead of 0.2540 mm."));
}

TEST_CASE("operations are matched by tool and comment, and one that only the second run has comes last") {
  const auto report = [](const std::string& rows) {
    return R"({"schema": "counterflex-report 1", "units": {"shown": "um"}, "operations": [)" + rows + "]}";
  };
  const std::string a = R"({"tool": 1, "operation": "POCKET", "before": {"max_mm": 0.1}, "after": null},
                           {"tool": 2, "operation": "", "before": {"max_mm": 0.2}, "after": {"max_mm": 0.002}})";
  const std::string b = R"({"tool": 3, "operation": "POCKET", "before": {"max_mm": 0.3}, "after": null},
                           {"tool": 1, "operation": "POCKET", "before": {"max_mm": 0.4}, "after": {"max_mm": 0.004}})";
  const Comparison comparison = compare(report_named("a", report(a)), report_named("b", report(b)), "0.1.0");
  REQUIRE(comparison.operations.size() == 3);
  CHECK(comparison.operations[0].before_mm == std::array<std::optional<double>, 2>{0.1, 0.4});
  CHECK(comparison.operations[0].after_mm == std::array<std::optional<double>, 2>{std::nullopt, 0.004});
  CHECK(comparison.operations[1].operation.empty());
  CHECK(comparison.operations[2].tool == 3);
  CHECK_FALSE(comparison.operations[2].before_mm[0]);
  CHECK(comparison.unit == "um");
  CHECK(contains(to_text(comparison, false), "  T1 POCKET"));
}

TEST_CASE("the conclusion has µm where the terminal shows UTF-8, else um") {
  const MadeUpRun run;
  const ReportFile file = report_named("a", made_up_report(1, run));
  const Comparison comparison = compare(file, file, "0.1.0");
  CHECK(contains(to_text(comparison, false, true), "largest model residual: 6.0 µm."));
  CHECK(contains(to_text(comparison, false, false), "largest model residual: 6.0 um."));
}

TEST_CASE("lines of the comparison are at most 100 characters long, and colour only adds escape sequences") {
  const MadeUpRun run;
  const Comparison comparison =
      compare(report_named("a", made_up_report(1, run)), report_named("b", made_up_report(3, run)), "0.1.0");
  for (const std::string& line : lines_of(to_text(comparison, false))) {
    CAPTURE(line);
    CHECK(line.size() <= 100);
  }
  std::string coloured = to_text(comparison, true);
  REQUIRE(coloured != to_text(comparison, false));
  for (const std::string code : {"\033[1m", "\033[0m"})
    for (std::size_t at = coloured.find(code); at != std::string::npos; at = coloured.find(code))
      coloured.erase(at, code.size());
  CHECK(coloured == to_text(comparison, false));
}

TEST_CASE("a value of another type than in reports is an error with its pointer") {
  const ReportFile good = report_named("a", R"({"schema": "counterflex-report 1"})");
  for (const auto& [json, message] :
       {std::pair{R"({"summary": {"before": {"max_mm": "much"}}})",
                  "b.json: error: /summary/before/max_mm is \"much\"; a number or null is allowed"},
        std::pair{R"({"machine": 5})", "b.json: error: /machine is 5; a text or null is allowed"},
        std::pair{R"({"inputs": []})", "b.json: error: /inputs is []; an object or null is allowed"},
        std::pair{R"({"operations": {}})", "b.json: error: /operations is {}; a list or null is allowed"}}) {
    const auto& shown = json;
    CAPTURE(shown);
    CHECK_THROWS_WITH_AS(compare(good, report_named("b", json), ""), message, InputError);
  }
}
