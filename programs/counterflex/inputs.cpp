#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "counterflex/files/files.hpp"
#include "counterflex/geometry/units.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/machine/tool_table.hpp"
#include "values.hpp"

namespace counterflex::cli {
namespace {

constexpr double largest_condition = 1e6;  // as for waypoints

void override_work(const Options& options, Machine& machine) {
  for (const std::string& text : options.work) {
    const auto [name, X_MW] = work_of(text);
    machine.work[name] = WorkOffset{X_MW, {}};
  }
}

std::optional<LengthUnit> unit_of(const Options& options, const Machine* machine) {
  if (options.units || machine == nullptr || machine->control.units.empty()) return options.units;
  return machine->control.units == "inch" ? LengthUnit::inches : LengthUnit::millimetres;
}

void refuse_folder(const std::string& path, Exit exit) {
  std::error_code ignored;
  if (path != "-" && std::filesystem::is_directory(path, ignored))
    throw InputError(exit, {path}, "cannot read the file: it is a folder");
}

InputFile input_file(const std::string& role, const std::string& path, const std::string& bytes) {
  return {role, path, sha256(bytes)};
}

}  // namespace

std::string read_input(const std::string& path, Exit unreadable) {
  refuse_folder(path, unreadable);
  try {
    return read_file(path);
  } catch (const InputError& error) {
    if (unreadable == error.exit()) throw;
    const std::string what = error.what();
    const std::size_t at = what.find("cannot read");
    throw InputError(unreadable, error.where(), at == std::string::npos ? what : what.substr(at));
  }
}

void refuse_home(const Model& model, const Machine& machine) {
  const Location& home_at = machine.home_at;
  if (model.home_status != Status::converged)
    throw InputError(
        Exit::machine_or_force, home_at,
        fmt::format("home does not close: its chains miss each other by {:.3g} (m and rad), at most 1e-7 is "
                    "allowed; check [home], the joints' home values and the chains' lengths",
                    model.home_gap));
  if (model.mechanism.travel.empty()) return;
  const double condition = actuator_jacobian(model, model.home).condition;
  if (!(condition <= largest_condition))
    throw InputError(
        Exit::machine_or_force, home_at,
        fmt::format("home is singular: the matrix from actuators to the tip has condition {:.3g}, at most "
                    "1e6 is allowed; give joints other home values (home_deg, home_mm), or [home]",
                    condition));
  if (model.gravity_status != Status::converged)
    throw InputError(
        Exit::machine_or_force, machine.gravity.reference_at,
        fmt::format("gravity_reference is \"home\", but the perfect machine cannot be held true there under "
                    "its own weight: it is {}",
                    to_string(model.gravity_status)));
}

MachineInput read_machine_input(const Options& options) {
  const std::string text = read_input(options.machine, Exit::machine_or_force);
  const std::string name = shown_name(options.machine);
  MachineInput input{input_file("machine", options.machine, text), read_machine(text, name), {}};
  override_work(options, input.machine);
  input.model = prepare(input.machine);
  refuse_home(input.model, input.machine);
  return input;
}

ToolLengths read_tool_lengths(const Options& options, const Machine* machine) {
  ToolLengths tools;
  std::map<long, double> lengths;
  if (options.tool_table) {
    const std::string text = read_input(*options.tool_table, Exit::machine_or_force);
    tools.file = input_file("tool-table", *options.tool_table, text);
    lengths = read_tool_table(text, shown_name(*options.tool_table));
  }
  if (machine != nullptr) lengths.insert(machine->tool_lengths.begin(), machine->tool_lengths.end());
  for (const auto& [tool, length] : lengths) tools.mm[tool] = length / mm;
  return tools;
}

ReadOptions read_options(const Options& options, const Machine* machine, const ToolLengths& tools) {
  ReadOptions read;
  if (machine != nullptr) read.dialect = machine->control.dialect;
  if (options.dialect) read.dialect = *options.dialect;
  read.unit = unit_of(options, machine);
  read.integer_words = options.integer_words;
  read.expand_subprograms = options.expand_subprograms;
  read.tool_lengths_mm = tools.mm;
  if (machine != nullptr && machine->control.tool_change_moves) {
    read.tool_change_moves.emplace();
    for (const std::string& axis : *machine->control.tool_change_moves)
      read.tool_change_moves->push_back(axis[0]);
  }
  return read;
}

void blame_dialect(const InputError& error, const Options& options, const Machine* machine,
                   const std::string& program) {
  const bool of_machine = error.exit() == Exit::usage && machine != nullptr && !options.dialect;
  if (!of_machine) throw;
  throw InputError(
      Exit::program_text, {program},
      fmt::format("programs in the machine file's dialect, \"{}\", are not read yet; --dialect names another",
                  machine->control.dialect));
}

ProgramInput read_program_input(const std::string& role, const std::string& path, const Options& options,
                                const Machine* machine, const ReadOptions& read) {
  std::string text = read_input(path, Exit::usage);
  const InputFile file = input_file(role, path, text);
  try {
    return {file, read_program(std::move(text), shown_name(path), read)};
  } catch (const InputError& error) {
    blame_dialect(error, options, machine, shown_name(path));
  }
}

ProgramFile open_program(const std::string& role, const std::string& path) {
  refuse_folder(path, Exit::usage);
  FileReader bytes(path);
  InputFile file{role, path, sha256(bytes)};
  return {std::move(file), std::move(bytes)};
}

void warn_of(const Overview& program, Console& console) {
  for (const Remark& remark : program.remarks) console.warning(program.file, remark.line, remark.what);
  const Capped<LeftAlone>& left_alone = program.left_alone;
  for (const LeftAlone& block : left_alone.rows)
    console.warning(program.file, block.line, "not corrected: " + block.why);
  console.more_warnings(program.file, left_alone.count - left_alone.rows.size());
}

void refuse_two_forces(const Options& options, const Overview& program) {
  if (options.force && options.forces)
    throw InputError(Exit::usage, {}, "--force and --forces are both given; one of them says the force");
  if ((!options.force && !options.forces) || !program.first_force_line) return;
  throw InputError(
      Exit::usage, {program.file, *program.first_force_line},
      fmt::format("the program's FORCE comments and {} are both given; one of them says the force",
                  options.force ? "--force" : "--forces"));
}

ForceInput read_force_input(const Options& options, const Overview& program) {
  refuse_two_forces(options, program);
  ForceInput input;
  input.source.blend = options.blend;
  input.source.scale = options.load_scale;
  input.source.air_above_mm = options.air_above_mm;
  input.source.constant = options.force;
  if (!options.forces) return input;
  const std::string extension = std::filesystem::path(*options.forces).extension().string();
  if (extension == ".toml")
    throw InputError(Exit::machine_or_force, {*options.forces},
                     "cutting-force models are not read yet; .csv is");
  if (extension != ".csv")
    throw InputError(Exit::usage, {*options.forces},
                     fmt::format("a force file is .csv or .toml, not '{}'", extension));
  const std::string text = read_input(*options.forces, Exit::machine_or_force);
  input.file = input_file("forces", *options.forces, text);
  input.source.profile = read_force_csv(text, *options.forces);
  return input;
}

}  // namespace counterflex::cli
