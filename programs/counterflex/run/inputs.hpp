#pragma once
/// Reads the inputs of a run. All functions throw `InputError` of the kind of their input.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/forces/forces.hpp"
#include "counterflex/program/overview.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/report/report.hpp"
#include "counterflex/statics/equilibrium.hpp"
#include "process/console.hpp"
#include "process/read_input.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// A machine with the work offsets of --work, and its model. Its home is a valid start.
struct MachineInput {
  InputFile file;
  Machine machine;
  Model model;
  std::string text{};  ///< of the file, as it was read; empty for a machine that is known
};
MachineInput read_machine_input(const Options& options);

/// The same for a machine that is known; `file` is where it is from.
MachineInput ready_machine(const Options& options, InputFile file, Machine machine);

/// The tool of --tool ("T3") and its number. Throws (ErrorKind::usage) with the list of known tools.
const std::pair<const long, Tool>& tool_named(const std::string& text, const Machine& machine);

/// Throws (ErrorKind::machine_or_force) if home does not close or is singular, or if gravity_reference is
/// "home" and no actuator values hold the machine there under its weight.
void refuse_home(const Model& model, const Machine& machine);

/// Tool lengths by number: from --tool-length, else from --tool-table, else from `machine`.
struct ToolLengths {
  std::optional<InputFile> file;
  std::map<long, double> mm;
};
ToolLengths read_tool_lengths(const Options& options, const Machine* machine);

/// Gives the tools of `machine` the lengths of a tool table, which override its own. With [spindle] a length
/// defines the tip, also of tools that the machine file does not name. Without [spindle] those tools stay
/// unknown.
void take_lengths(const ToolLengths& lengths, Machine& machine);

/// How programs are read: by `options`, else by `machine`.
ReadOptions read_options(const Options& options, const Machine* machine, const ToolLengths& tools);

/// A program that is read in windows, as often as needed; `bytes` is at its beginning. The first complete
/// pass computes the hash of the file.
struct ProgramFile {
  InputFile file;
  FileReader bytes;
  std::vector<InputFile> data_lists{};  ///< behind the program in `bytes`, with their hashes
  /// Where the data list follows its loop in `bytes`: the files one behind the other, as lines are counted.
  std::optional<FileReader> lines{};

  FileReader& by_line() { return lines ? *lines : bytes; }
};

/// The data lists of `path` are the one beside it and `data_lists`. The console then names lines in the file
/// in which they are.
ProgramFile open_program(const std::string& role, const std::string& path,
                         const std::vector<std::string>& data_lists, Console& console);

/// The program, the data list beside it, and those of the options.
std::vector<std::string> files_of_program(const std::string& path,
                                          const std::vector<std::string>& data_lists);

/// Warns of the reader's remarks and of blocks that are not corrected, in the words of `command`.
void warn_of(const Overview& program, Command command, Console& console);

/// The feed of a cycle is made by the control. It is not part of the path, so no force acts there.
std::optional<Remark> remark_of_cycles(const Overview& program, const ForceSource& source, Command command);

/// The force source: rules of files in their order, then those of --force.
struct ForceInput {
  std::vector<InputFile> files;
  ForceSource source;
};
ForceInput read_force_input(const Options& options);

}  // namespace counterflex::cli
