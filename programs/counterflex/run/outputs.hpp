#pragma once
/// What a run writes, and where it may.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/report/formats.hpp"
#include "counterflex/report/page.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// Where a run writes to; an empty path is not written.
struct OutputPaths {
  std::string program;  ///< "-": standard output
  std::string report_json;
  std::string report_csv;
  std::string report_page;
  std::string plot;
  std::vector<std::string> folders;  ///< made, with those above them, before anything is written
};

/// The paths of `options`, the program's among them for `compensate`: NAME.comp.EXT beside the input unless
/// given, standard output for standard input. Throws `InputError`: Exit::usage where a path is that of an
/// input, by whatever name, where two are the same, or where the program and --json both want standard
/// output; Exit::transient_io where its folder does not exist.
OutputPaths output_paths(const Options& options);

/// One name for all paths of a file, which need not exist.
std::string canonical_name(const std::string& path);

/// A file that a command writes, and whether what has its name now was written by counterflex.
struct OwnFile {
  std::string path;  ///< empty or "-": none
  std::function<bool(const std::string& path)> is_own;
};

/// A file with this text in its first bytes. `mark` outlives it.
OwnFile marked_file(const std::string& path, std::string_view mark);

/// Throws `InputError` (Exit::usage) where one of these files exists, is not empty and is not counterflex's
/// own.
void refuse_foreign(const std::vector<OwnFile>& files);

/// The same of what a run writes, unless --force-overwrite is given. A program is recognized by its header.
void refuse_foreign_outputs(const OutputPaths& paths, const Options& options);

/// What `compare` writes; empty paths without --report.
struct ComparisonPaths {
  std::string json, page;
};

/// Throws as `output_paths` and `refuse_foreign`. The pages beside the reports are inputs, too.
ComparisonPaths comparison_paths(const Options& options);

/// Throws as `output_paths` and `refuse_foreign` where --output of a command that writes a table cannot be
/// written; tables begin with `mark`.
void check_output(const Options& options, std::string_view mark);

/// The files of a run, written as it goes; they get their names when it has ended, or never.
class RunFiles {
 public:
  /// Throws `InputError` (Exit::transient_io), as all members do, where a file cannot be written.
  /// `hashed`: what is written is hashed on the way.
  RunFiles(const OutputPaths& paths, const CsvColumns& columns, bool hashed = false);

  bool program_to_stdout() const { return paths_.program == "-"; }

  void add_program(std::string_view text);
  void add_waypoints(const std::vector<Waypoint>& waypoints);

  /// What is known when the run has ended. Nothing where neither report nor plot is wanted.
  void add_report(const RunReport& report, const std::string& report_json, const PathCurves& curves);

  /// All of them together, the corrected program among them if `with_program`.
  void publish(bool with_program);

  /// The files that have got their names, the corrected program first where it is one of them; without hashes
  /// unless they were asked for.
  const std::vector<FileHash>& published() const { return published_; }

 private:
  OutputPaths paths_;
  CsvColumns columns_;
  std::size_t next_row_ = 0;
  std::optional<FileWriter> program_, csv_, json_, page_, plot_;
  std::vector<FileHash> published_;
};

/// Publishes files that belong together, none where one of them cannot be written: first all are completed,
/// then streams receive what is theirs, and at last the files get their names, deaf to interrupts meanwhile.
/// nullptr is none. Throws `InputError` (Exit::transient_io).
void publish_together(std::vector<FileWriter*> files);

/// nullptr: there is none.
FileWriter* if_any(std::optional<FileWriter>& file);

}  // namespace counterflex::cli
