#pragma once
/// Reports that earlier runs have written, read back.
#include <string>

namespace counterflex {

/// A run's report, as text, and what its page shows besides.
struct ReportFile {
  std::string name;    ///< of the run, for people: the file's stem
  std::string path;    ///< as it was given
  std::string sha256;  ///< of that file
  std::string report;  ///< "counterflex-report 1", JSON
  std::string curves;  ///< JSON, as the page's data has it; empty: none
  std::string loads;   ///< likewise
  std::string remark;  ///< why there are no curves though they were asked for; empty: nothing to remark
};

enum class WithCurves { no, yes };

/// Reads STEM.json, or STEM.html with the report in it; "-" is standard input, with JSON. Curves and loads of
/// STEM.json are those of STEM.html beside it, where that page shows the same report. Throws `InputError`
/// (Exit::usage) where the file cannot be read, at line and column where it is no JSON, and where it is
/// another document than the report of one run.
ReportFile read_report_file(const std::string& path, WithCurves with);

/// Gives two runs of the same name different ones: folders before it as far as these differ, else numbers
/// behind it.
void tell_apart(ReportFile& a, ReportFile& b);

/// The page beside `path`, STEM.html of STEM.json; empty where `path` has another ending.
std::string page_beside(const std::string& path);

}  // namespace counterflex
