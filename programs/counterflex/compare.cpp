#include "commands.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/report/comparison.hpp"
#include "outputs.hpp"
#include "run.hpp"
#include "version.hpp"

namespace counterflex::cli {

Exit run_compare(const Options& options, Console& console) {
  refuse_stdin_twice(options);
  const ComparisonPaths paths = comparison_paths(options);
  const WithCurves with = options.report ? WithCurves::yes : WithCurves::no;
  ReportFile a = read_report_file(options.reports.front(), with);
  ReportFile b = read_report_file(options.reports.back(), with);
  tell_apart(a, b);
  for (const ReportFile* file : {&a, &b})
    if (!file->remark.empty()) console.warning(file->path, 0, file->remark);
  const Comparison comparison = compare(a, b, version);
  const std::string json = to_json(comparison);
  if (!paths.json.empty()) write_file(paths.json, json);
  console.finish_warnings();
  write_result(options.json ? json : to_text(comparison, console.colour_out()));
  return Exit::done;
}

}  // namespace counterflex::cli
