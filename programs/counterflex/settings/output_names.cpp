#include "settings/output_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "counterflex/settings/jobs_file.hpp"
#include "settings/setting_options.hpp"

namespace counterflex::cli {
namespace {

NameParts known_parts(const std::string& program) {
  if (program == "-" || program.empty()) return {};
  const std::filesystem::path path(program);
  return {path.stem().generic_string(), path.extension().generic_string(), std::nullopt};
}

std::string without_extension(const std::string& path) {
  return std::filesystem::path(path).replace_extension().generic_string();
}

/// The path for `text`, beside the program if it has no folder. Empty if a part is unknown.
std::optional<std::string> filled_path(const std::string& text, const std::string& program,
                                       const NameParts& parts) {
  if (!unknown_placeholder(text, parts).empty()) return std::nullopt;
  const std::string path = fill(text, parts);
  if (!is_pattern(text) || text.find('/') != std::string::npos || text.starts_with("{output}")) return path;
  return (std::filesystem::path(program).parent_path() / path).generic_string();
}

struct Naming {
  Options& options;
  const std::vector<Setting>& settings;
  NameParts parts;
};

[[noreturn]] void refuse_nameless(const Setting& setting, const std::string& text) {
  blame_setting(setting, 0,
                fmt::format("{} is '{}', but standard input has no name; give a path",
                            name_in_messages(setting), text));
}

/// The mark in names of reports of other commands than compensate.
std::string_view mark_of(Command command) {
  if (command == Command::predict) return ".predict";
  return command == Command::verify ? ".verify" : "";
}

/// The name of a report or plot with the mark of its command, before the extension of a plot. Names in flags
/// are for this run only and stay unchanged; {output} already has the mark.
std::string marked(std::string name, const Setting& setting, Command command) {
  const bool own = setting.option == "output" || setting.origin == Origin::flag;
  if (own || name.find("{output}") != std::string::npos) return name;
  const std::size_t ending = setting.option == "plot" ? std::string_view(".svg").size() : 0;
  return name.insert(name.size() - ending, mark_of(command));
}

/// `given` with its words replaced; empty if it has no value here. `in_folder` is the name used if `given` is
/// only a folder.
std::optional<std::string> named(const std::optional<std::string>& given, std::string_view option,
                                 std::string_view in_folder, const Naming& naming) {
  if (!given || *given == "-") return given;
  const Setting& setting = *std::find_if(naming.settings.begin(), naming.settings.end(),
                                         [&](const Setting& entry) { return entry.option == option; });
  const std::string pattern = marked(given->ends_with('/') ? *given + std::string(in_folder) : *given,
                                     setting, naming.options.command);
  if (!is_pattern(pattern)) return fill(pattern, {});
  const auto path = filled_path(pattern, naming.options.program, naming.parts);
  if (path) {
    naming.options.folders.push_back(std::filesystem::path(*path).parent_path().generic_string());
    return path;
  }
  if (setting.origin == Origin::flag) refuse_nameless(setting, *given);
  return std::nullopt;
}

/// {output}: the name of the corrected program, with the mark of the command.
std::optional<std::string> output_stem(const Options& options, const std::optional<std::string>& output) {
  const std::string mark(mark_of(options.command));
  if (options.command == Command::verify) return without_extension(options.verify.corrected) + mark;
  const std::string path = output && *output != "-" ? *output : default_output(options.program);
  if (path == "-") return std::nullopt;
  return without_extension(path) + mark;
}

}  // namespace

Setting with_folder_marked(Setting output) {
  for (std::string& text : output.values) {
    std::error_code ignored;
    const bool is_path = text != "-" && !text.ends_with('/') && !is_pattern(text);
    if (is_path && std::filesystem::is_directory(fill(text, {}), ignored)) text += '/';
  }
  return output;
}

void check_pattern(const std::string& name, const std::string& text) {
  const bool of_report = !name.ends_with("output");
  const NameParts all{"", "", of_report ? std::optional<std::string>("") : std::nullopt};
  const std::string unknown = unknown_placeholder(text, all);
  if (unknown.empty()) return;
  const std::string meant = nearest_placeholder(unknown);
  const bool is_hint = !meant.empty() && meant != unknown;
  throw InputError(ErrorKind::usage, {},
                   fmt::format("{} is '{}': unknown word {{{}}}; use {{name}}, {{ext}}{}{}", name, text,
                               unknown, of_report ? ", {output}" : "",
                               is_hint ? fmt::format("; did you mean {{{}}}?", meant) : ""));
}

void name_outputs(Options& options, const std::vector<Setting>& settings) {
  if (!has_setting(options.command, "output") || options.command == Command::watch) return;
  Naming naming{options, settings, known_parts(options.program)};
  options.output = named(options.output, "output", "{name}{ext}", naming);
  naming.parts.output = output_stem(options, options.output);
  if (options.command != Command::compensate) {
    options.output.reset();
    options.folders.clear();
  }
  options.report = named(options.report, "report", "{name}", naming);
  options.plot = named(options.plot, "plot", "{name}.svg", naming);
}

void remark_on_name(const Setting& setting, Options& options) {
  const bool names = setting.option == "output" || setting.option == "report" || setting.option == "plot";
  if (!names || setting.origin != Origin::file || setting.values.empty()) return;
  const std::string& text = setting.values[0];
  if (text == "-" || text.ends_with('/') || is_pattern(text)) return;
  SettingRemark& remark = options.remarks.emplace_back();
  remark.where = setting.where;
  remark.what =
      fmt::format("{} is '{}' for all programs; use a pattern with {{name}}, or a folder that ends in /",
                  name_in_messages(setting), fill(text, {}));
}

std::string default_output(const std::string& program) {
  const std::filesystem::path path(program);
  // Nothing is written beside /dev/stdin and /dev/fd/3.
  if (program == "-" || path.parent_path() == "/dev" || path.parent_path() == "/dev/fd") return "-";
  return (path.parent_path() / (path.stem().generic_string() + ".comp" + path.extension().generic_string()))
      .generic_string();
}

}  // namespace counterflex::cli
