#pragma once
/// The output files of a run.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/program/parts.hpp"
#include "counterflex/program/program_files.hpp"
#include "counterflex/report/formats.hpp"
#include "counterflex/report/page.hpp"
#include "process/spooled_text.hpp"
#include "run/job_files.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// The paths of outputs; an empty path is not written.
struct OutputPaths {
  std::string program;  ///< "-": standard output
  /// The data lists of the program, in its order. The list beside the program is always written, others if
  /// they change.
  struct List {
    std::string path;
    std::string input;
    bool always = false;
  };
  std::vector<List> lists{};
  std::string report_json;
  std::string report_csv;
  std::string report_page;
  std::string plot;
  std::vector<std::string> folders;  ///< created, with their parents, before any file is written
  /// Get the corrected program, and the rows of the CSV report with its header, besides the files.
  std::function<void(std::string_view)> take_program{}, take_rows{};
  const JobFiles* job_files = nullptr;  ///< of all jobs, in a batch or a watch
  bool force_overwrite = false;         ///< replaces data lists that counterflex did not write
};

/// The paths of outputs. For `compensate` this includes the corrected program: by default NAME.comp.EXT
/// beside the input, or standard output for standard input. Throws `InputError`: ErrorKind::usage if a path
/// is an input (also through links), if two paths are equal, or if the program and --json both use standard
/// output; ErrorKind::transient_io if a folder does not exist.
OutputPaths output_paths(const Options& options);

/// Throws `InputError` (ErrorKind::usage) if an output would replace one of `inputs`: of those that are known
/// only after the machine was read.
void refuse_replaced(const OutputPaths& paths, const std::vector<InputFile>& inputs);

/// The name of the corrected data list: the list's own name in the folder of the corrected program, or
/// NAME.comp.dat if that is the list itself. The list beside the program gets the stem of the corrected one.
std::string corrected_list(const std::string& list, const std::string& program, const std::string& corrected);

/// The files of the parts of a divided program, NAME_1.EXT ... in the folder of the corrected program, which
/// is the first of `parts`. Throws as `output_paths` and `refuse_foreign`, and ErrorKind::usage for standard
/// output, for a file of another job, and for a part of another divided program.
std::vector<std::string> part_paths(const OutputPaths& paths, const std::vector<ProgramPart>& parts,
                                    const Options& options);

/// Whether a data list has a name of the control, such as $config.dat: all programs use it.
bool belongs_to_control(const std::string& list);

/// The files that the options name as inputs. A machine file or --uncertainty may name a further one, its
/// covariance.
std::vector<std::string> inputs_of(const Options& options);

/// A file that a command writes, and whether the present file of that name was written by counterflex.
struct OwnFile {
  std::string path;  ///< empty or "-": no file
  std::function<bool(const std::string& path)> is_own;
};

/// A file that is counterflex's own if `mark` is in its first bytes. `mark` outlives it.
OwnFile marked_file(const std::string& path, std::string_view mark);

/// Throws `InputError` (ErrorKind::usage) if one of these files exists, is not empty and was not written by
/// counterflex.
void refuse_foreign(const std::vector<OwnFile>& files);

/// The same for the outputs of a run, unless --force-overwrite is given, but not for data lists that are
/// written only if they change. A program is recognised by its header. A program that is a part of a divided
/// one is not replaced, even with --force-overwrite.
void refuse_foreign_outputs(const OutputPaths& paths, const Options& options);

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
