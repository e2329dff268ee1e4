#pragma once
/// The output files of commands that write no corrected program of a run.
#include <string>
#include <string_view>
#include <vector>

#include "run/output_paths.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// The outputs of `compare`; empty paths without --report.
struct ComparisonPaths {
  std::string json, page;
};

/// Throws as `output_paths` and `refuse_foreign`. Pages beside the reports also count as inputs.
ComparisonPaths comparison_paths(const Options& options);

/// Checks --output of a command that writes a table, which begins with `mark`. Throws as `output_paths` and
/// `refuse_foreign`.
void check_output(const Options& options, std::string_view mark);

/// Checks the machine file that a command makes from `inputs`. People edit machine files: an existing one is
/// replaced only with --force-overwrite. Throws as `output_paths`. Standard output, "-" or empty, is allowed.
void check_machine_output(const std::string& output, const std::vector<std::string>& inputs, bool overwrite);

/// Checks --output and --plot of `map`. Throws as `output_paths` and `refuse_foreign`.
void check_map_outputs(const Options& options);

/// Checks --output and --sheet of `testcut`. People fill in sheets: an existing one is replaced only with
/// --force-overwrite, a part of a divided program not even then. Throws as `output_paths` and
/// `refuse_foreign`.
void check_coupon_outputs(const Options& options);

/// Checks --draw of `check`. Throws as `output_paths` and `refuse_foreign`.
void check_drawing_output(const Options& options);

}  // namespace counterflex::cli
