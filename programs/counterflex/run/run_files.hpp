#pragma once
/// The files of a run, and how they are published together.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/program/parts.hpp"
#include "counterflex/report/formats.hpp"
#include "counterflex/report/page.hpp"
#include "process/spooled_text.hpp"
#include "run/output_paths.hpp"

namespace counterflex::cli {

/// A program whose end of a loop is not known yet, and its data list.
struct CountedProgram {
  std::string program{};
  SpooledText list{};
};

/// The files of a run, written under temporary names. They get their names only when the run succeeds.
class RunFiles {
 public:
  /// Throws `InputError` (ErrorKind::transient_io), as all members, if a file cannot be written. `hashed`:
  /// computes the hashes of the files.
  RunFiles(const OutputPaths& paths, const CsvColumns& columns, bool hashed = false);

  bool program_to_stdout() const { return paths_.program == "-"; }

  void add_program(std::string_view text);
  void add_waypoints(const std::vector<Waypoint>& waypoints);

  /// From now on `add_program` collects the program: it may be divided when it is complete.
  void hold_program() { held_.emplace(); }
  const std::string& held_program() const { return *held_; }

  /// The data list of the program follows its loop: its end and the size of the array are counted when all
  /// targets are known.
  void count_loop() { counted_.emplace(); }

  /// Writes what is held: whole, or the main program and its parts into these files.
  void write_held();
  void write_parts(const std::vector<ProgramPart>& parts, const std::vector<std::string>& paths);

  bool with_page() const { return page_.has_value(); }

  /// Writes report and plot, if requested, when the run has ended. `machine`: for the page, as `machine_json`
  /// writes it. `program`: the original one.
  void add_report(const RunReport& report, const std::string& report_json, const PathCurves& curves,
                  const std::string& machine, FileReader& program);

  /// Completes the corrected program, its data lists and parts: nothing can be added to them any more.
  /// Returns them, the program first; with hashes if `hashed`.
  std::vector<FileHash> complete_program();

  /// Publishes all files together, with the corrected program if `with_program`.
  void publish(bool with_program);

  /// The published files, the corrected program first; with hashes if `hashed`.
  const std::vector<FileHash>& published() const { return published_; }

 private:
  /// The data lists that have changed, and the one beside the program. Throws `InputError` if a list of the
  /// control (ErrorKind::program_text) has changed, and as `refuse_changed`.
  std::vector<FileWriter*> written_lists();

  /// For a list that is written because it has changed. Throws `InputError` (ErrorKind::usage) if it is one
  /// of another job, or a file that counterflex did not write.
  void refuse_changed(const OutputPaths::List& list) const;

  /// Throws `InputError` (ErrorKind::usage) if one of `files` would replace a file that came to be during the
  /// run, and that counterflex did not write.
  void refuse_foreign_of(const std::vector<FileWriter*>& files) const;

  void write_counted();

  OutputPaths paths_;
  CsvColumns columns_;
  std::size_t next_row_ = 0;
  std::optional<FileSplitter> splitter_;  ///< of a program with data lists
  std::vector<FileWriter> lists_, parts_;
  std::optional<std::string> held_;
  std::optional<CountedProgram> counted_;
  std::optional<FileWriter> program_, csv_, json_, page_, plot_;
  std::optional<std::vector<FileWriter*>> completed_lists_;  ///< when the program is complete
  std::vector<FileHash> published_;
};

/// Publishes all files, or no file if one of them cannot be written. First completes all, then writes to
/// streams, then renames the files with signals blocked. Ignores nullptr. Throws `InputError`
/// (ErrorKind::transient_io).
void publish_together(std::vector<FileWriter*> files);

/// nullptr if there is no such output.
FileWriter* if_any(std::optional<FileWriter>& file);

}  // namespace counterflex::cli
