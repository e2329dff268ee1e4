#include "commands/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "commands/commands.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/report/formats.hpp"
#include "process/standard_output.hpp"
#include "run/command_outputs.hpp"
#include "run/sanity.hpp"
#include "settings/layers.hpp"

namespace counterflex::cli {
namespace {

bool is_machine(const std::string& path) {
  return path.ends_with(".toml");
}

/// --draw and --parameters are for machine files.
void refuse_machine_options(const Options& options) {
  const std::vector<std::string>& files = options.check.files;
  const auto machines = std::count_if(files.begin(), files.end(), is_machine);
  if (options.check.parameters && static_cast<std::size_t>(machines) != files.size())
    throw InputError(ErrorKind::usage, {}, "--parameters is for machine files (.toml) only");
  if (!options.check.draw) return;
  if (machines != 1)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("--draw draws one machine file (.toml), and {} are given", machines));
  if (options.check.parameters)
    throw InputError(ErrorKind::usage, {}, "--draw and --parameters exclude each other");
  check_drawing_output(options);
}

/// The options with which a program is checked: those of the project file beside or above it, too.
Options options_at(const Options& options, const std::string& program, Console& console) {
  if (options.sources.config) return options;
  const ProgramLayers found = layers_of(options.sources, program);
  Options own = options_of(Command::check, found.layers, program);
  own.project_file = found.project_file;
  if (!own.project_file.empty()) console.detail("project file " + own.project_file);
  return own;
}

Checked check_placed(const std::string& program, const Options& options, Console& console) {
  const Options own = options_at(options, program, console);
  std::optional<MachineInput> machine;
  if (!own.machine.empty()) {
    machine = read_machine_input(own);
    take_lengths(read_tool_lengths(own, &machine->machine), machine->machine);
  }
  return check_program(program, own, machine ? &*machine : nullptr, console);
}

Checked check_file(const std::string& path, const Options& options, Console& console) {
  try {
    return is_machine(path) ? check_machine(path, options, console) : check_placed(path, options, console);
  } catch (const InputError& error) {
    console.error(error.what());
    return {"", "", {{"file", path}, {"error", error.what()}}, error.kind()};
  }
}

}  // namespace

void add_sanity(const SanityChecks& checks, const Machine& machine, Checked& checked, Console& console) {
  checked.sanity = sanity_block(checks, console.colour_out(), console.marks_out());
  checked.json["sanity"] = nlohmann::ordered_json::parse(to_json(checks));
  try {
    refuse_wrong(checks, machine);
  } catch (const InputError& error) {
    console.error(error.what());
    checked.error_kind = error.kind();
  }
}

std::string row(std::string_view label, std::string_view text) {
  return fmt::format("{:<12} {}\n", label, text);
}

std::optional<ErrorKind> run_check(const Options& options, Console& console) {
  refuse_machine_options(options);
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  std::optional<ErrorKind> first;
  std::string text;
  for (const std::string& path : options.check.files) {
    Checked checked = check_file(path, options, console);
    if (!first) first = checked.error_kind;
    if (!checked.text.empty())
      text += (text.empty() ? "" : "\n\n") + lines_without_controls(checked.text) + checked.sanity;
    files.push_back(std::move(checked.json));
  }
  console.finish_warnings();
  if (options.json)
    write_result(nlohmann::ordered_json{{"schema", "counterflex-check 1"}, {"files", files}}.dump(2) + "\n");
  else
    write_painted_result(text);
  return first;
}

}  // namespace counterflex::cli
