#include "settings/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "counterflex/files/text.hpp"
#include "counterflex/settings/environment.hpp"
#include "process/standard_output.hpp"
#include "process/terminal.hpp"
#include "process/version.hpp"
#include "settings/command_options.hpp"
#include "settings/completion.hpp"
#include "settings/help.hpp"
#include "settings/layers.hpp"

namespace counterflex::cli {
namespace {

void describe_program(CLI::App& app) {
  app.description(
      "Corrects machining programs for the errors of assembly and the deflection of their machine, and "
      "reports "
      "the deviation before and after.");
  app.footer(
      "Exit status: 0 done, 1 internal error, 2 usage, 3 program text, 4 machine, force, job or\n"
      "project file, 5 tolerance missed or not converged, 6 travel or correction limit,\n"
      "75 input or output failed, 130 interrupted (143 by SIGTERM).");
  app.set_version_flag("--version", fmt::format("counterflex {}", version), "Print the version");
  for (CLI::Option* option : app.get_options()) option->group(std::string(group::common));
  app.require_subcommand(1);
  app.formatter(help_formatter());
}

/// Refuses an option with "=" and no value. CLI11 would take the next word as the value of "--output=", and
/// "=" as that of "-o=".
void refuse_no_value(std::string_view word) {
  const bool names_an_option = word.starts_with("--") || (word.size() == 3 && word[0] == '-');
  if (!names_an_option || word.find('=') != word.size() - 1) return;
  word.remove_suffix(1);
  throw InputError(ErrorKind::usage, {}, fmt::format("{} has no value", word));
}

/// Joins a value that begins with a minus with the option before it: "--at -10,0,0" becomes "--at=-10,0,0".
/// Throws `InputError` (ErrorKind::usage) for "--at=".
std::vector<std::string> joined(int argc, const char* const* argv) {
  std::vector<std::string> words;
  bool options_end = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    options_end = options_end || word == "--";
    if (!options_end) refuse_no_value(word);
    const bool negative =
        word.size() > 1 && word[0] == '-' && (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
    const bool takes_numbers =
        !words.empty() && words.back().starts_with("--") && words.back().find('=') == std::string::npos;
    if (negative && takes_numbers)
      words.back().append("=").append(word);
    else
      words.emplace_back(word);
  }
  return words;
}

std::vector<std::string_view> names_of_commands(const CLI::App& app) {
  std::vector<std::string_view> names{"help"};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// "; did you mean compensate? See counterflex help", without the question if no name is near.
std::string advice(std::string_view name, const std::vector<std::string_view>& known,
                   const std::string& help) {
  std::string_view meant = nearest(name, known);
  if (meant.empty()) {  // the beginning of a name: --tolernce for --tolerance-mm
    std::vector<std::string_view> beginnings;
    for (const std::string_view candidate : known) beginnings.push_back(candidate.substr(0, name.size()));
    const auto found = std::ranges::find(beginnings, nearest(name, beginnings));
    if (found != beginnings.end()) meant = known[static_cast<std::size_t>(found - beginnings.begin())];
  }
  const std::string see = "counterflex help" + help;
  return meant.empty() ? fmt::format("; see {}", see) : fmt::format("; did you mean {}? See {}", meant, see);
}

/// "counterflex help compensate" is "counterflex compensate --help".
void translate_help(std::vector<std::string>& words) {
  if (words.empty() || words[0] != "help") return;
  words.erase(words.begin());
  words.resize(std::min<std::size_t>(words.size(), 1));
  words.emplace_back("--help");
}

/// "counterflex forces fit O1001.NC" is "counterflex forces --fit O1001.NC".
void translate_fit(std::vector<std::string>& words) {
  if (words.size() > 1 && words[0] == "forces" && words[1] == "fit") words[1] = "--fit";
}

/// "counterflex O1001.NC" is "counterflex compensate O1001.NC". Throws `InputError` (ErrorKind::usage) for a
/// first word that is neither a command nor a file.
void add_missing_command(std::vector<std::string>& words, const CLI::App& app) {
  if (words.empty() || (words[0].starts_with('-') && words[0] != "-")) return;
  const auto is_meant = [&](const CLI::App* command) { return command->get_name() == words[0]; };
  if (!app.get_subcommands(is_meant).empty()) return;
  std::error_code ignored;
  if (words[0] != "-" && !std::filesystem::exists(words[0], ignored))
    throw InputError(ErrorKind::usage, {},
                     fmt::format("'{}' is neither a command nor a file{}", words[0],
                                 advice(words[0], names_of_commands(app), "")));
  words.insert(words.begin(), "compensate");
}

/// Throws `InputError` (ErrorKind::usage) for --shard with a command without this option.
void refuse_shard_of_program(const std::vector<std::string>& words) {
  const auto is_shard = [](const std::string& word) {
    return word == "--shard" || word.starts_with("--shard=");
  };
  const auto end = std::ranges::find(words, "--");
  if (words.empty() || words[0] == "batch" || std::none_of(words.begin(), end, is_shard)) return;
  throw InputError(
      ErrorKind::usage, {},
      "--shard divides the jobs of a batch: one program is always done by one process. Leave out --shard, "
      "or list several programs in a jobs file and use counterflex batch JOBS.toml --shard I/N");
}

/// Throws `InputError` (ErrorKind::usage) for the first option that the command does not have.
void refuse_unknown_option(const std::vector<std::string>& words, const CLI::App& app) {
  if (words.empty() || words[0].starts_with('-')) return;
  const CLI::App* command = app.get_subcommand(words[0]);
  std::vector<std::string> names;
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const auto end = std::ranges::find(words, "--");
  for (auto word = words.begin() + 1; word != end; ++word) {
    const std::string name = word->substr(0, word->find('='));
    if (!name.starts_with("--") || std::ranges::find(names, name) != names.end()) continue;
    throw InputError(ErrorKind::usage, {},
                     fmt::format("counterflex {} has no option {}{}", words[0], without_controls(name),
                                 advice(name, {names.begin(), names.end()}, " " + words[0])));
  }
}

std::optional<ErrorKind> leave(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    app.exit(error);  // prints the help
    return std::nullopt;
  }
  const auto chosen = app.get_subcommands();
  fmt::print(stderr, "error: {}\nSee counterflex help {}.\n", without_controls(error.what()),
             chosen.empty() ? "COMMAND" : chosen.front()->get_name());
  return ErrorKind::usage;
}

/// The program that decides where the project file is searched: its folder and those above. The first one of
/// several files.
std::string placing_program(const Options& options) {
  if (options.command == Command::watch)
    return (std::filesystem::path(options.watch.folder) / "any").generic_string();
  if (options.command == Command::identify) return options.identify.program;
  if (options.command != Command::check) return options.program;
  const auto program = std::find_if(options.check.files.begin(), options.check.files.end(),
                                    [](const std::string& file) { return !file.ends_with(".toml"); });
  return program == options.check.files.end() ? options.check.files.front() : *program;
}

/// Whether settings besides flags are read here. `check` reads those of each program beside it.
bool reads_sources(const Options& options) {
  if (options.print_config || options.sources.config) return true;
  return options.command != Command::check && options.command != Command::compare &&
         options.command != Command::batch && options.command != Command::import &&
         options.command != Command::create && !options.forces_table.materials;
}

std::vector<SettingRemark> remarks_on_environment() {
  std::vector<SettingRemark> remarks;
  for (const auto& [name, meant] : misspelt_variables(environment_variables())) {
    SettingRemark& remark = remarks.emplace_back();
    remark.where.file = name;
    remark.what = fmt::format("is not a setting and has no effect; did you mean {}?", meant);
  }
  return remarks;
}

}  // namespace

std::variant<Options, std::optional<ErrorKind>> read_command_line(int argc, const char* const* argv) {
  Options options;
  CLI::App app("", "counterflex");
  app.allow_windows_style_options(false);  // "/cam/part.nc" is a path
  describe_program(app);
  add_commands(app, options);
  try {
    auto words = joined(argc, argv);
    if (words.empty()) {
      fmt::print(stderr, "{}", short_usage());
      return ErrorKind::usage;
    }
    if (words[0] == "completion") {
      write_result(completion_script(app, words.size() > 1 ? words[1] : ""));
      return std::nullopt;
    }
    translate_help(words);
    translate_fit(words);
    add_missing_command(words, app);
    refuse_shard_of_program(words);
    refuse_unknown_option(words, app);
    std::reverse(words.begin(), words.end());
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return leave(app, error);
  }
  if (options.sources.config && options.sources.no_config)
    throw InputError(ErrorKind::usage, {}, "--config and --no-config exclude each other");
  options.remarks = remarks_on_environment();
  options.sources.environment = read_environment(environment_variables());
  if (!reads_sources(options)) return with_settings(options, {options.sources.flags});
  const ProgramLayers found = layers_of(options.sources, placing_program(options));
  options.project_file = found.project_file;
  const bool print = options.print_config;
  Options result = with_settings(std::move(options), found.layers);
  if (print) {
    write_result(config_text(result.command, found.layers));
    return std::nullopt;
  }
  refuse_no_machine(result);
  return result;
}

}  // namespace counterflex::cli
