#pragma once
/// Two runs side by side: machines, methods, tolerances, before and after calibration. Lengths in mm, angles
/// in degrees, as reports have them.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/report/report.hpp"

namespace counterflex {

/// The data that identify one of the two runs. Empty texts: the report does not give them.
struct ComparedRun {
  std::string name, path, sha256;
  std::string tool, command, machine, program, method;
  std::optional<double> tolerance_mm;
  std::string failure;  ///< in words where the run failed
};

/// One number of both reports. `none`: a report does not have it (a prediction has no residual).
struct ComparedNumber {
  std::string key;      ///< where reports have it, a JSON pointer
  std::string heading;  ///< of the rows that belong together
  std::string label;    ///< among them
  std::string unit;     ///< "mm", "deg", "%"; empty for counts
  int decimals = 0;     ///< to show
  std::array<std::optional<double>, 2> values;

  std::optional<double> difference() const;  ///< second minus first

  /// Of the first; none where the values are percents, or the first is too small for its share to mean
  /// something.
  std::optional<double> percent() const;
};

/// Something that the runs do not have in common, in words; empty where one of them lacks it.
struct RunDifference {
  std::string what;
  std::array<std::string, 2> values;
};

/// The largest deviations of one tool and operation.
struct ComparedOperation {
  std::optional<double> tool;  ///< its number; none or 0: none known
  std::string operation;
  std::array<std::optional<double>, 2> before_mm, after_mm;
};

struct Comparison {
  std::string version;  ///< of the tool that compares
  std::array<ComparedRun, 2> runs;
  std::string unit;  ///< that both reports show deviations in, "um", "mm" or "inch"; else "mm"
  std::vector<ComparedNumber> numbers;
  std::vector<RunDifference> differences;
  std::vector<std::string> same;              ///< inputs that both have, by role
  std::vector<ComparedOperation> operations;  ///< those of the first run, then those that only the second has
  std::string conclusion;                     ///< in a sentence or two, UTF-8
};

/// Throws `InputError` (ErrorKind::usage) where something in a report is of another kind than reports have
/// it.
Comparison compare(const ReportFile& a, const ReportFile& b, const std::string& version);

/// "counterflex-comparison 1": indented by two spaces, one newline at the end.
std::string to_json(const Comparison& comparison);

/// Tables for people, lines of at most 100 characters (paths and other long words stay whole).
/// `marks`: the terminal shows UTF-8, and so "µm".
std::string to_text(const Comparison& comparison, bool colour, bool marks = false);

}  // namespace counterflex
