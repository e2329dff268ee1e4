#include <fmt/format.h>

#include "commands/commands.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/report/comparison.hpp"
#include "counterflex/report/page.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "run/command_outputs.hpp"
#include "run/run.hpp"
#include "run/run_files.hpp"

namespace counterflex::cli {
namespace {

void name_runs(const Options& options, ReportFile& a, ReportFile& b) {
  if (options.compare.names.empty()) return tell_apart(a, b);
  if (options.compare.names.size() != 2)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("--name is given {} times; give it twice, in the order of the reports, or not at all",
                    options.compare.names.size()));
  a.name = options.compare.names[0];
  b.name = options.compare.names[1];
}

PageRun page_run(const ReportFile& file) {
  PageRun run;
  run.name = file.name;
  run.report = file.report;
  if (!file.curves.empty()) run.curves = file.curves;
  if (!file.loads.empty()) run.loads = file.loads;
  if (!file.machine.empty()) run.machine = file.machine;
  if (!file.source.empty()) run.source = file.source;
  return run;
}

void write_files(const ComparisonPaths& paths, const std::string& json, const std::string& conclusion,
                 const ReportFile& a, const ReportFile& b) {
  FileWriter document(paths.json), page(paths.page);
  document.write(json);
  write_page(
      a.name + " and " + b.name, {page_run(a), page_run(b)}, [&](std::string_view part) { page.write(part); },
      conclusion);
  publish_together({&document, &page});
}

}  // namespace

std::optional<ErrorKind> run_compare(const Options& options, Console& console) {
  refuse_stdin_twice(options);
  const ComparisonPaths paths = comparison_paths(options);
  const WithCurves with = options.report ? WithCurves::yes : WithCurves::no;
  ReportFile a = read_report_file(options.compare.reports.front(), with);
  ReportFile b = read_report_file(options.compare.reports.back(), with);
  name_runs(options, a, b);
  for (const ReportFile* file : {&a, &b})
    if (!file->remark.empty()) console.warning(file->path, 0, file->remark);
  const Comparison comparison = compare(a, b, version);
  const std::string json = to_json(comparison);
  if (options.report) write_files(paths, json, comparison.conclusion, a, b);
  console.finish_warnings();
  if (options.json)
    write_result(json);
  else
    write_painted_result(to_text(comparison, console.colour_out(), console.marks_out()));
  return std::nullopt;
}

}  // namespace counterflex::cli
