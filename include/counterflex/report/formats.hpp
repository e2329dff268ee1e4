#pragma once
/// A run's report as JSON, as CSV, and as text for a terminal. The same report gives the same bytes: no time
/// stamps, no locale, a fixed order of keys.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/report/report.hpp"

namespace counterflex {

/// "counterflex-report 1" (programs/guide/report.md), indented by two spaces, one newline at the end. Lengths
/// are rounded to 1e-7 mm, angles to 1e-7 deg. Values that were not computed are null (`summary.after` of a
/// prediction).
std::string to_json(const RunReport& report);

/// The document of a run that ended before it had a report: with the verdict FAILED, and `failure`, whose
/// `exit` is `exit_status`.
std::string failed_json(Command command, std::string_view version, const InputError& error, int exit_status);

/// The checks as a list of objects with check, state and text.
std::string to_json(const SanityChecks& checks);

/// Which columns of the CSV were computed; the others keep their place and are empty.
struct CsvColumns {
  /// geometry_, load_, gravity_, preloads_, superposition_; with `corrected` also air_.
  bool attribution = true;
  bool corrected = true;  ///< after_, correction_: not for a prediction
  /// The columns before_band_mm and after_band_mm at the end, which are missing without it.
  bool bands = false;
  /// The last columns, fixture_, which are missing without it.
  bool fixture = false;
};

/// The names of the columns, in a line.
std::string csv_header(const CsvColumns& columns = {});

/// One row a waypoint that is not `between`, in order; `next_index` is that of the first row (a file's first
/// has 0) and becomes that of the row after the last; `cutting` is 0 or 1. Rotations of the correction follow
/// as correction_rx_deg, correction_ry_deg, correction_rz_deg.
std::string csv_rows(std::span<const Waypoint> waypoints, const CsvColumns& columns, std::size_t& next_index);

/// The summary that a person reads first, at most twelve lines of at most 100 characters (paths and other
/// long words stay whole): verdict, deviation before and after with its line and causes there, force,
/// program, checks, `files` that were written. Deviations in mm with four decimals. `colour` adds ANSI
/// sequences, nothing else.
std::string summary_text(const RunReport& report, const std::vector<std::string>& files, bool colour);

/// The same run in all details. `marks`: the terminal shows UTF-8.
std::string details_text(const RunReport& report, bool colour, bool marks = false);

/// The sanity block, a line for each check; empty without checks.
std::string sanity_block(const SanityChecks& checks, bool colour, bool marks);

/// "NAME: OK, 2.0734 mm before, 0.0041 mm after (model residual)": a run in one line, without a newline.
std::string one_line(const RunReport& report);

}  // namespace counterflex
