#pragma once
/// Reads what a run needs, and places it in the machine frame. All throw `InputError` with the exit status of
/// what is wrong.
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

/// A machine with its work table overridden by --work, and its model, whose home is fit to start from.
struct MachineInput {
  InputFile file;
  Machine machine;
  Model model;
};
MachineInput read_machine_input(const Options& options);

/// Throws (Exit::machine_or_force) where home misses its closures or is singular, or no offsets of the
/// actuators hold the machine true there under its weight, though the file says that the control does.
void refuse_home(const Model& model, const Machine& machine);

/// Lengths of tools by number: those of --tool-length, then of --tool-table, and of `machine` for tools that
/// it does not name.
struct ToolLengths {
  std::optional<InputFile> file;
  std::map<long, double> mm;
};
ToolLengths read_tool_lengths(const Options& options, const Machine* machine);

/// Gives the tools of `machine` the lengths of a tool table, which go before its own. With [spindle] a length
/// says where the tip is, of tools too that the machine file does not name; without it these stay unknown.
void take_lengths(const ToolLengths& lengths, Machine& machine);

/// How `options`, and `machine` where they are silent, say that programs are read.
ReadOptions read_options(const Options& options, const Machine* machine, const ToolLengths& tools);

struct ProgramInput {
  InputFile file;
  Program program;
};
ProgramInput read_program_input(const std::string& role, const std::string& path, const Options& options,
                                const Machine* machine, const ReadOptions& read);

/// A program that is read in windows, as often as needed; `bytes` is at its beginning. The file's hash comes
/// with the first look through it.
struct ProgramFile {
  InputFile file;
  FileReader bytes;
};
ProgramFile open_program(const std::string& role, const std::string& path);

/// Throws `error`, of a program's reader, where it is the dialect of `machine` that is not known, as an error
/// of the machine file; else throws it as it is. Called in its handler.
[[noreturn]] void blame_dialect(const InputError& error, const Options& options, const Machine* machine,
                                const std::string& program);

/// Warns of what the reader remarked and left alone, in the words of `command`.
void warn_of(const Overview& program, Command command, Console& console);

/// The feed of a cycle is the control's own: no part of the path, so that no force acts there.
std::optional<Remark> remark_of_cycles(const Overview& program, const ForceSource& source, Command command);

/// Where the forces come from: rules of files, in their order, and then those of --force.
struct ForceInput {
  std::vector<InputFile> files;
  ForceSource source;
};
ForceInput read_force_input(const Options& options);

}  // namespace counterflex::cli
