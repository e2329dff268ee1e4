#include <fmt/core.h>

#include "counterflex/report/comparison.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {

namespace {

Json number_or_null(const std::optional<double>& value) {
  return value ? number(*value, 7) : Json(nullptr);
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json two_numbers(const std::array<std::optional<double>, 2>& values) {
  return Json::array({number_or_null(values[0]), number_or_null(values[1])});
}

Json run_json(const ComparedRun& run) {
  return {{"name", run.name},
          {"path", run.path},
          {"sha256", run.sha256},
          {"tool", text_or_null(run.tool)},
          {"command", text_or_null(run.command)},
          {"machine", text_or_null(run.machine)},
          {"program", text_or_null(run.program)},
          {"method", text_or_null(run.method)},
          {"tolerance_mm", number_or_null(run.tolerance_mm)},
          {"failure", text_or_null(run.failure)}};
}

Json numbers_json(const std::vector<ComparedNumber>& numbers) {
  Json list = Json::array();
  for (const ComparedNumber& row : numbers)
    list.push_back({{"key", row.key},
                    {"label", row.heading + ": " + row.label},
                    {"unit", text_or_null(row.unit)},
                    {"values", two_numbers(row.values)},
                    {"difference", number_or_null(row.difference())},
                    {"percent", number_or_null(row.percent())}});
  return list;
}

Json differences_json(const std::vector<RunDifference>& differences) {
  Json list = Json::array();
  for (const RunDifference& row : differences)
    list.push_back({{"what", row.what},
                    {"values", Json::array({text_or_null(row.values[0]), text_or_null(row.values[1])})}});
  return list;
}

Json compared_operations_json(const std::vector<ComparedOperation>& operations) {
  Json list = Json::array();
  for (const ComparedOperation& row : operations)
    list.push_back({{"tool", row.tool ? Json(static_cast<long>(*row.tool)) : Json(nullptr)},
                    {"operation", row.operation},
                    {"before_max_mm", two_numbers(row.before_mm)},
                    {"after_max_mm", two_numbers(row.after_mm)}});
  return list;
}

}  // namespace

std::string to_json(const Comparison& comparison) {
  const Json document = {{"schema", "counterflex-comparison 1"},
                         {"tool", fmt::format("counterflex {}", comparison.version)},
                         {"runs", Json::array({run_json(comparison.runs[0]), run_json(comparison.runs[1])})},
                         {"summary", numbers_json(comparison.numbers)},
                         {"operations", compared_operations_json(comparison.operations)},
                         {"differences", differences_json(comparison.differences)},
                         {"same", comparison.same},
                         {"conclusion", comparison.conclusion}};
  return dump(document);
}

}  // namespace counterflex
