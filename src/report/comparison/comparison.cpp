#include "counterflex/report/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "report/comparison/comparison_parts.hpp"
#include "report/tally/causes.hpp"

namespace counterflex {

namespace {

struct NumberRow {
  const char* key;
  const char* heading;
  const char* label;
  const char* unit = "mm";
  int decimals = 4;
};

constexpr const char* before_heading = "Deviation before";
constexpr const char* after_heading = "Model residual after";
constexpr const char* sources_heading = "Largest deviation by its cause";
constexpr const char* other_force_heading = "Largest deviation under another force";
constexpr const char* program_heading = "Program";

/// Rows of each statistics, relative to its key and heading.
constexpr NumberRow statistics_rows[] = {
    {"/max_mm", "", "largest"},
    {"/p95_mm", "", "95 % of the length is below"},
    {"/rms_mm", "", "root mean square"},
    {"/mean_mm", "", "mean"},
    {"/max_axis_mm/0", "", "largest in x"},
    {"/max_axis_mm/1", "", "largest in y"},
    {"/max_axis_mm/2", "", "largest in z"},
    {"/max_across_mm", "", "largest across the path"},
    {"/max_tool_axis_mm", "", "largest along the tool axis"},
    {"/max_along_mm", "", "along the path (matters at ends)"},
    {"/max_rotation_deg", "", "largest rotation, in deg", "deg"},
};

/// The rows behind the causes, in their order.
constexpr NumberRow other_rows[] = {
    {"/summary/sources/superposition/max_mm", sources_heading, "superposition: their sum"},
    {"/summary/sensitivity/force_plus_30/max_mm", other_force_heading, "force 30 % higher"},
    {"/summary/sensitivity/force_minus_30/max_mm", other_force_heading, "force 30 % lower"},
    {"/summary/sensitivity/without_force/max_mm", other_force_heading, "no force (dry run, spring pass)"},
    {"/summary/path_mm", program_heading, "length of feed moves, in mm", "mm", 3},
    {"/summary/corrected_percent", program_heading, "of it corrected, in %", "%", 2},
    {"/summary/correction/max_mm", program_heading, "largest correction, in mm"},
    {"/forces/largest_N", program_heading, "largest force, in N", "N", 1},
    {"/blocks/moves", program_heading, "moves", "", 0},
    {"/blocks/corrected", program_heading, "moves corrected", "", 0},
    {"/blocks/not_corrected", program_heading, "moves not corrected", "", 0},
    {"/blocks/inserted", program_heading, "points added", "", 0},
    {"/text/blocks_after", program_heading, "blocks of the corrected program", "", 0},
    {"/control/short_blocks/count", program_heading, "short blocks", "", 0},
    {"/warning_count", program_heading, "warnings", "", 0},
};

std::string failure_in_words(const JsonSource& report) {
  if (report.object("/failure") == nullptr) return "";
  const auto line = report.number("/failure/line").value_or(0);
  const std::string where = line > 0 ? fmt::format("line {:.0f}: ", line) : "";
  return where + report.text("/failure/what");
}

ComparedRun compared_run(const ReportFile& file, const JsonSource& report) {
  return {.name = file.name,
          .path = file.path,
          .sha256 = file.sha256,
          .tool = report.text("/tool"),
          .command = report.text("/command"),
          .machine = report.text("/machine"),
          .program = report.text("/inputs/program/path"),
          .method = report.text("/options/method"),
          .tolerance_mm = report.number("/options/tolerance-mm"),
          .failure = failure_in_words(report)};
}

std::string common_unit(const TwoReports& reports) {
  const std::string a = reports[0].text("/units/shown"), b = reports[1].text("/units/shown");
  const bool known = a == "um" || a == "inch";
  return a == b && known ? a : "mm";
}

}  // namespace

std::optional<double> ComparedNumber::difference() const {
  if (!values[0] || !values[1]) return std::nullopt;
  return rounded(*values[1] - *values[0], 7);
}

std::optional<double> ComparedNumber::percent() const {
  const auto change = difference();
  const double least_shown = 1 / small_powers_of_ten[static_cast<std::size_t>(decimals)];
  if (!change || unit == "%" || std::abs(*values[0]) < least_shown) return std::nullopt;
  return rounded(100 * *change / std::abs(*values[0]), 3);
}

std::vector<ComparedNumber> compared_numbers(const TwoReports& reports) {
  std::vector<ComparedNumber> numbers;
  const auto add = [&](const std::string& key, const char* heading, const NumberRow& row) {
    const auto a = reports[0].number(key), b = reports[1].number(key);
    if (a || b) numbers.push_back({key, heading, row.label, row.unit, row.decimals, {a, b}});
  };
  for (const NumberRow& row : statistics_rows)
    add(std::string("/summary/before") + row.key, before_heading, row);
  for (const NumberRow& row : statistics_rows)
    add(std::string("/summary/after") + row.key, after_heading, row);
  for (const Cause& cause : all_causes)
    add(fmt::format("/summary/sources/{}/max_mm", cause.name), sources_heading, {"", "", cause.words});
  for (const NumberRow& row : other_rows) add(row.key, row.heading, row);
  return numbers;
}

Comparison compare(const ReportFile& a, const ReportFile& b, const std::string& version) {
  const Json document_a = parse_json(a.report, a.report, 0, a.path);
  const Json document_b = parse_json(b.report, b.report, 0, b.path);
  const TwoReports reports{JsonSource{document_a, a.path}, JsonSource{document_b, b.path}};
  Comparison comparison{.version = version,
                        .runs = {compared_run(a, reports[0]), compared_run(b, reports[1])},
                        .unit = common_unit(reports),
                        .numbers = compared_numbers(reports),
                        .differences = run_differences(reports),
                        .same = same_inputs(reports),
                        .operations = compared_operations(reports),
                        .conclusion = ""};
  comparison.conclusion = conclusion_of(comparison, true);
  return comparison;
}

}  // namespace counterflex
