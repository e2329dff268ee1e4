#include "run/command_outputs.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "counterflex/files/input_error.hpp"
#include "counterflex/report/machine_drawing.hpp"
#include "counterflex/report/map.hpp"
#include "counterflex/report/page.hpp"
#include "run/header/corrected_header.hpp"
#include "run/output_paths.hpp"

namespace counterflex::cli {

namespace fs = std::filesystem;

ComparisonPaths comparison_paths(const Options& options) {
  if (!options.report) return {};
  ComparisonPaths paths{stem_of_report(options) + ".json", stem_of_report(options) + ".html"};
  std::vector<std::string> inputs = options.compare.reports;
  for (const std::string& report : options.compare.reports)
    if (const std::string page = page_beside(report); !page.empty()) inputs.push_back(page);
  check_paths({paths.json, paths.page}, inputs);
  if (!options.force_overwrite)
    refuse_foreign({marked_file(paths.json, "\"counterflex-comparison"), page_file(paths.page)});
  return paths;
}

void check_output(const Options& options, std::string_view mark) {
  if (!options.output) return;
  if (*options.output == "-" && options.json)
    throw InputError(
        ErrorKind::usage, {},
        "the table and the document of --json cannot both go to standard output; give -o a file");
  check_paths({*options.output}, inputs_of(options));
  const std::string extension = fs::path(*options.output).extension().generic_string();
  if (*options.output != "-" && extension != ".csv")
    throw InputError(ErrorKind::usage, {*options.output},
                     fmt::format("a table is written to a .csv file, not to '{}'", extension));
  if (!options.force_overwrite) refuse_foreign({marked_file(*options.output, mark)});
}

namespace {

/// Of files that people edit.
void refuse_existing(const std::string& output, bool overwrite) {
  std::error_code error;
  if (overwrite || !fs::is_regular_file(output, error) || fs::file_size(output, error) == 0) return;
  throw InputError(ErrorKind::usage, {output},
                   "the file exists; give another name, or --force-overwrite to replace it");
}

}  // namespace

void check_machine_output(const std::string& output, const std::vector<std::string>& inputs, bool overwrite) {
  if (output.empty() || output == "-") return;
  check_paths({output}, inputs);
  if (fs::path(output).extension() != ".toml")
    throw InputError(ErrorKind::usage, {output}, "a machine file has a name that ends in .toml");
  refuse_existing(output, overwrite);
}

void check_coupon_outputs(const Options& options) {
  const std::string &program = *options.output, &sheet = *options.testcut.sheet;
  for (const std::string& path : {program, sheet})
    if (path == "-")
      throw InputError(ErrorKind::usage, {}, "testcut writes two files; -o and --sheet cannot be '-'");
  check_paths({program, sheet}, inputs_of(options));
  if (fs::path(sheet).extension() != ".csv")
    throw InputError(ErrorKind::usage, {sheet}, "a sheet has a name that ends in .csv");
  refuse_existing(sheet, options.force_overwrite);
  refuse_part_of_other(program, program);
  if (!options.force_overwrite) refuse_foreign({{program, has_corrected_header}});
}

void check_map_outputs(const Options& options) {
  check_output(options, map_table_mark);
  if (!options.map.plot) return;
  const std::string& path = *options.map.plot;
  refuse_no_svg("--plot", path);
  check_paths({path}, inputs_of(options));
  if (!options.force_overwrite) refuse_foreign({marked_file(path, map_picture_mark)});
}

void check_drawing_output(const Options& options) {
  const std::string& path = *options.check.draw;
  refuse_no_svg("--draw", path);
  check_paths({path}, options.check.files);
  if (!options.force_overwrite) refuse_foreign({marked_file(path, drawing_mark)});
}

}  // namespace counterflex::cli
