#pragma once
/// The names of output files, and which existing files a run may replace.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/parts.hpp"
#include "counterflex/program/program_files.hpp"
#include "counterflex/report/report.hpp"
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
  bool force_overwrite = false;         ///< replaces files that counterflex did not write
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

/// The outputs of a run, without data lists that are written only if they change. A program is recognised by
/// its header.
std::vector<OwnFile> own_outputs(const OutputPaths& paths);

/// `refuse_foreign` for the outputs of a run, unless --force-overwrite is given. A program that is a part of
/// a divided one is not replaced, even with --force-overwrite.
void refuse_foreign_outputs(const OutputPaths& paths);

/// Throws `InputError` (ErrorKind::usage) if one of `outputs` is not the name of a file, has the name of one
/// of `inputs` (also through links) or of another output, or lies in a folder that neither exists nor is one
/// of `made`.
void check_paths(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                 const std::vector<std::string>& made = {});

/// Throws `InputError` (ErrorKind::usage) if the name of a drawing, given by `option`, does not end in .svg.
void refuse_no_svg(std::string_view option, const std::string& path);

/// The stem of --report. Throws `InputError` (ErrorKind::usage) if it is not a stem of file names.
std::string stem_of_report(const Options& options);

/// Throws `InputError` (ErrorKind::usage) if the file is a part of a divided program other than `program`: it
/// calls its parts by name, and would call another program.
void refuse_part_of_other(const std::string& file, const std::string& program);

/// A page of counterflex.
OwnFile page_file(const std::string& path);

/// A corrected data list has no header of its own: that of the corrected program counts.
OwnFile list_file(const OutputPaths::List& list, const std::string& corrected);

}  // namespace counterflex::cli
