#include <fmt/core.h>

#include <algorithm>

#include "report/comparison/comparison_parts.hpp"

namespace counterflex {

namespace {

ComparedOperation& operation_of(const JsonSource& report, const std::string& at,
                                std::vector<ComparedOperation>& list) {
  const auto tool = report.number(at + "/tool");
  const std::string operation = report.text(at + "/operation");
  const auto found = std::find_if(list.begin(), list.end(), [&](const ComparedOperation& row) {
    return row.tool == tool && row.operation == operation;
  });
  if (found != list.end()) return *found;
  list.push_back({.tool = tool, .operation = operation, .before_mm = {}, .after_mm = {}});
  return list.back();
}

}  // namespace

std::vector<ComparedOperation> compared_operations(const TwoReports& reports) {
  std::vector<ComparedOperation> list;
  for (std::size_t run = 0; run < reports.size(); ++run) {
    const Json* rows = reports[run].list("/operations");
    for (std::size_t i = 0; rows != nullptr && i < rows->size(); ++i) {
      const std::string at = fmt::format("/operations/{}", i);
      ComparedOperation& row = operation_of(reports[run], at, list);
      row.before_mm[run] = reports[run].number(at + "/before/max_mm");
      row.after_mm[run] = reports[run].number(at + "/after/max_mm");
    }
  }
  return list;
}

}  // namespace counterflex
