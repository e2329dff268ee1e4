#include "run/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/program/program_files.hpp"
#include "process/read_input.hpp"
#include "run/joint_kinematics.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

constexpr double largest_condition = 1e6;  // as for waypoints

/// An offset without a datum keeps the datum of the machine file.
void override_work(const Options& options, Machine& machine) {
  for (const std::string& text : options.work) {
    const WorkText given = work_of(text);
    machine.work_is_machine_frame = given.offset.empty();
    if (machine.work_is_machine_frame) return machine.work.clear();
    WorkOffset& offset = machine.work[given.offset];
    offset.X_MW = given.place.X_MW;
    offset.shown = given.place.shown;  // those of the machine file belong to its pose
    if (given.place.datum.stated()) offset.datum = given.place.datum;
  }
}

/// At the temperature of the options. A machine without a table has no temperature.
Machine at_temperature_of(const Options& options, Machine machine) {
  if (!options.temperature) return machine;
  if (!machine.thermal)
    throw InputError(ErrorKind::usage, {},
                     "--temperature-C needs [thermal] in the machine file: the shift of the tip by "
                     "temperature");
  const std::vector<double>& known = machine.thermal->temperatures;
  const double t = *options.temperature;
  if (!(t >= known.front() && t <= known.back()))
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("--temperature-C is {:.6g}; [thermal] of the machine file is known from {:.6g} "
                    "to {:.6g}",
                    t, known.front(), known.back()));
  return at_temperature(machine, t);
}

std::optional<LengthUnit> unit_of(const Options& options, const Machine* machine) {
  if (options.units || machine == nullptr || machine->control.units.empty()) return options.units;
  return machine->control.units == "inch" ? LengthUnit::inches : LengthUnit::millimetres;
}

/// By extension, in small letters or capitals; standard input is CSV.
bool is_cutting_model(const std::string& path) {
  const std::string extension =
      path == "-" ? ".csv" : std::filesystem::path(path).extension().generic_string();
  std::string small = extension;
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return std::tolower(c); });
  if (small == ".csv" || small == ".toml") return small == ".toml";
  throw InputError(ErrorKind::usage, {path},
                   fmt::format("a force file is .csv or .toml, not '{}'", extension));
}

InputFile input_file(const std::string& role, const std::string& path, const std::string& bytes) {
  return {role, path, sha256(bytes)};
}

std::vector<ForceRule> read_cutting_models(const std::string& role, const std::string& path,
                                           std::vector<InputFile>& files) {
  const std::string text = read_input(path, ErrorKind::machine_or_force);
  files.push_back(input_file(role, path, text));
  return read_force_toml(text, shown_name(path));
}

/// Reads a profile without holding it in memory: it may be as long as the program.
std::vector<ForceRule> read_profile(const std::string& role, const std::string& path,
                                    std::vector<InputFile>& files) {
  refuse_folder(path, ErrorKind::machine_or_force);
  FileReader bytes = or_unreadable(ErrorKind::machine_or_force, [&] { return FileReader(path); });
  files.push_back({role, path, or_unreadable(ErrorKind::machine_or_force, [&] { return sha256(bytes); })});
  std::vector<ForceRule> rules = read_force_csv(bytes, shown_name(path));
  bytes.refuse_change();  // the file was read twice
  return rules;
}

}  // namespace

const std::pair<const long, Tool>& tool_named(const std::string& text, const Machine& machine) {
  const std::optional<long> number = read_tool_number(text);
  if (!number)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("--tool is '{}', must be T and its number, as T3", text));
  std::string known;
  for (const auto& entry : machine.tools) {
    if (entry.first == 0) continue;  // no known tool: [tool]
    if (entry.first == *number) return entry;
    known += fmt::format("{}T{}", known.empty() ? "" : ", ", entry.first);
  }
  throw InputError(ErrorKind::usage, {},
                   fmt::format("--tool {}: the machine file has no such tool; it has {}", text,
                               known.empty() ? "none" : known));
}

void refuse_home(const Model& model, const Machine& machine) {
  const Location& home_at = machine.home_at;
  if (model.home_status != Status::converged)
    throw InputError(
        ErrorKind::machine_or_force, home_at,
        fmt::format("home does not close: its chains miss each other by {:.3g} (m and rad), at most 1e-7 is "
                    "allowed; check [home], the joints' home values and the chains' lengths",
                    model.home_gap));
  if (model.mechanism.travel.empty()) return;
  const double condition = actuator_jacobian(model, model.home).condition;
  if (!(condition <= largest_condition))
    throw InputError(
        ErrorKind::machine_or_force, home_at,
        fmt::format("home is singular: the matrix from actuators to the tip has condition {:.3g}, at most "
                    "1e6 is allowed; give joints other home values (home_deg, home_mm), or [home]",
                    condition));
  if (model.gravity_status != Status::converged)
    throw InputError(ErrorKind::machine_or_force, machine.gravity.reference_at,
                     fmt::format("gravity_reference is \"home\", but no actuator values hold the perfect "
                                 "machine at home under its weight: it is {}",
                                 to_string(model.gravity_status)));
}

MachineInput read_machine_input(const Options& options) {
  const std::string text = read_input(options.machine, ErrorKind::machine_or_force);
  const std::string name = shown_name(options.machine);
  MachineInput input =
      ready_machine(options, input_file("machine", options.machine, text), read_machine(text, name));
  input.text = text;
  return input;
}

MachineInput ready_machine(const Options& options, InputFile file, Machine machine) {
  MachineInput input{std::move(file), std::move(machine), {}, {}};
  override_work(options, input.machine);
  input.machine = at_temperature_of(options, std::move(input.machine));
  input.model = prepare(input.machine);
  refuse_home(input.model, input.machine);
  return input;
}

ToolLengths read_tool_lengths(const Options& options, const Machine* machine) {
  ToolLengths tools;
  std::map<long, double> lengths;
  for (const auto& [number, length_mm] : options.tool_lengths_mm) lengths[number] = length_mm * mm;
  if (options.tool_table) {
    const std::string text = read_input(*options.tool_table, ErrorKind::machine_or_force);
    tools.file = input_file("tool-table", *options.tool_table, text);
    lengths.merge(read_tool_table(text, shown_name(*options.tool_table)));
  }
  if (machine != nullptr)
    for (const auto& [number, tool] : machine->tools)
      if (tool.length) lengths.emplace(number, *tool.length);
  for (const auto& [tool, length] : lengths) tools.mm[tool] = length / mm;
  return tools;
}

void take_lengths(const ToolLengths& lengths, Machine& machine) {
  for (const auto& [number, length_mm] : lengths.mm) {
    const auto named = machine.tools.find(number);
    if (named != machine.tools.end())
      named->second.length = length_mm * mm;
    else if (machine.X_PS)
      machine.tools[number] = {.length = length_mm * mm, .in_file = false};
  }
}

ReadOptions read_options(const Options& options, const Machine* machine, const ToolLengths& tools) {
  ReadOptions read;
  if (machine != nullptr) read.dialect = machine->control.dialect;
  if (options.dialect) read.dialect = *options.dialect;
  read.unit = unit_of(options, machine);
  read.integer_words = options.integer_words;
  read.absolute_centres =
      options.absolute_centres.value_or(machine != nullptr && machine->control.absolute_centres);
  read.tool_orientation = machine != nullptr && controls_pose(*machine);
  if (machine != nullptr) read.spindle_axis = machine->spindle_axis;
  if (machine != nullptr && machine->joint_values_as_shown) read.kinematics = joint_kinematics(*machine);
  read.evaluate = options.evaluate;
  read.expand_subprograms = options.expand_subprograms;
  read.tool_lengths_mm = tools.mm;
  if (machine != nullptr) read.harmless_calls = machine->control.harmless_calls;
  if (machine != nullptr && machine->control.tool_change_moves) {
    read.tool_change_moves.emplace();
    for (const std::string& axis : *machine->control.tool_change_moves)
      read.tool_change_moves->push_back(axis[0]);
  }
  return read;
}

std::vector<std::string> files_of_program(const std::string& path,
                                          const std::vector<std::string>& data_lists) {
  std::vector<std::string> files{path};
  if (!takes_data_lists(path)) return files;
  if (std::string own = data_list_beside(path); !own.empty()) files.push_back(std::move(own));
  for (const std::string& list : data_lists)
    if (std::none_of(files.begin(), files.end(), [&](const std::string& f) { return is_same_file(f, list); }))
      files.push_back(list);
  return files;
}

ProgramFile open_program(const std::string& role, const std::string& path,
                         const std::vector<std::string>& data_lists, Console& console) {
  refuse_folder(path, ErrorKind::usage);
  const std::vector<std::string> files = files_of_program(path, data_lists);
  if (!data_lists.empty() && !takes_data_lists(path))
    console.warning(shown_name(path), 0, "data lists (--data) are read with KUKA programs (.src) only");
  auto by_motion = join_files_by_motion(files);
  const bool has_lines = by_motion.has_value();
  ProgramFile program{{role, path, {}}, has_lines ? std::move(*by_motion) : join_files(files)};
  if (has_lines) program.lines.emplace(join_files(files));
  if (files.size() == 1) return program;
  FileReader alone(path);
  program.file.sha256 = sha256(alone);
  for (std::size_t i = 1; i < files.size(); ++i) {
    FileReader list(files[i]);
    program.data_lists.push_back({"data-list", files[i], sha256(list)});
  }
  console.name_lines(shown_name(path), files, first_lines(files));
  return program;
}

void warn_of(const Overview& program, Command command, Console& console) {
  const std::string left = command == Command::forces ? "no force computed: " : "not corrected: ";
  for (const Remark& remark : program.remarks) console.warning(program.file, remark.line, remark.what);
  for (const Capped<LeftAlone>* blocks : {&program.machine_positions, &program.left_alone}) {
    for (const LeftAlone& block : blocks->rows) console.warning(program.file, block.line, left + block.why);
    console.more_warnings(program.file, blocks->count - blocks->rows.size());
  }
}

std::optional<Remark> remark_of_cycles(const Overview& program, const ForceSource& source, Command command) {
  const bool forces = !source.rules.empty() || program.commented_force;
  if (!program.first_cycle_line || !forces || source.scale == 0) return std::nullopt;
  if (command == Command::forces)
    return Remark{*program.first_cycle_line,
                  "holes of cycles are not listed; each has the force of a plunge"};
  const auto is_profile = [](const ForceRule& rule) {
    return std::holds_alternative<ForceProfile>(rule.content);
  };
  if (std::none_of(source.rules.begin(), source.rules.end(), is_profile)) return std::nullopt;
  return Remark{*program.first_cycle_line, "the rows of a force profile do not act in holes of cycles"};
}

ForceInput read_force_input(const Options& options) {
  ForceInput input;
  ForceSource& source = input.source;
  source.blend = options.blend;
  source.scale = options.load_scale;
  source.is_shared = options.shares_forces;
  source.air_above_mm = options.air_above_mm;
  for (const std::string& path : options.forces) {
    const std::string role =
        input.files.empty() ? "forces" : fmt::format("forces-{}", input.files.size() + 1);
    auto rules = is_cutting_model(path) ? read_cutting_models(role, path, input.files)
                                        : read_profile(role, path, input.files);
    source.rules.insert(source.rules.end(), std::make_move_iterator(rules.begin()),
                        std::make_move_iterator(rules.end()));
  }
  source.rules.insert(source.rules.end(), options.force_rules.begin(), options.force_rules.end());
  return input;
}

}  // namespace counterflex::cli
