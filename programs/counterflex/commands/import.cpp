#include "counterflex/import/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "commands/commands.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/machine/volcomp.hpp"
#include "process/read_input.hpp"
#include "process/standard_output.hpp"
#include "run/command_outputs.hpp"

namespace counterflex::cli {
namespace {

std::string text_of(const std::string& path) {
  return read_input(path, ErrorKind::machine_or_force);
}

/// The INI file with the HAL files that it loads, which are relative to its folder; or the HAL file alone.
std::vector<ConfigurationFile> read_configuration(const std::string& path) {
  std::vector<ConfigurationFile> files = {{shown_name(path), text_of(path)}};
  if (!path.ends_with(".ini")) return files;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const std::string& hal : hal_files_of(files[0])) {
    const std::string name = (folder / hal).generic_string();
    files.push_back({name, text_of(name)});
  }
  return files;
}

/// Throws `InputError` (ErrorKind::usage) for an option of another source.
void refuse_foreign_options(const ImportOptions& options) {
  const auto refuse = [&](bool given, std::string_view option, std::string_view source) {
    if (given && options.source != source)
      throw InputError(ErrorKind::usage, {},
                       fmt::format("{} is an option of `import {}`; remove it from `import {}`", option,
                                   source, options.source));
  };
  refuse(options.base.has_value(), "--base", "urdf");
  refuse(options.tip.has_value(), "--tip", "urdf");
  refuse(options.convention.has_value(), "--convention", "dh");
  refuse(options.format.has_value(), "--format", "volcomp");
  refuse(options.negate, "--negate", "volcomp");
}

DhConvention read_convention(const std::optional<std::string>& text) {
  if (!text)
    throw InputError(
        ErrorKind::usage, {},
        "`import dh` needs --convention standard or --convention modified: the same table describes "
        "different arms");
  if (*text != "standard" && *text != "modified")
    throw InputError(ErrorKind::usage, {},
                     fmt::format("--convention is '{}'; it must be standard or modified", *text));
  return *text == "standard" ? DhConvention::standard : DhConvention::modified;
}

VolcompFormat read_format(const std::optional<std::string>& text) {
  if (text == "isg") return VolcompFormat::isg;
  if (text == "etalon") return VolcompFormat::etalon;
  throw InputError(ErrorKind::usage, {}, "`import volcomp` needs --format isg or --format etalon");
}

/// Tables for a machine file, and what of the file no table can have.
std::string imported_tables(const ImportOptions& options) {
  const std::string name = shown_name(options.file);
  const Volcomp volcomp =
      read_volcomp(text_of(options.file), name, read_format(options.format), options.negate);
  std::string text = fmt::format(
      "# counterflex import volcomp: {}\n"
      "# Put these tables into the machine file, and error_table = \"x\" into the actuator of axis X.\n",
      name);
  for (const auto& [error, value] : volcomp.position_errors)
    text += fmt::format("# {} = {:.6g} {} is an error between two axes: put it into an error slot.\n", error,
                        1e6 * value, error[0] >= 'X' ? "um" : "urad");
  for (const auto& [axis, table] : volcomp.tables) text += fmt::format("\n{}", table_text(axis, table));
  return text;
}

std::string imported(const ImportOptions& options) {
  const std::string name = shown_name(options.file);
  if (options.source == "dh") {
    const DhConvention convention = read_convention(options.convention);
    return import_dh(text_of(options.file), name, convention);
  }
  if (options.source == "linuxcnc") return import_linuxcnc(read_configuration(options.file));
  if (options.source == "ur-calibration") return import_ur_calibration(text_of(options.file), name);
  if (options.source == "urdf")
    return import_urdf(text_of(options.file), name, options.base.value_or(""), options.tip.value_or(""));
  throw InputError(
      ErrorKind::usage, {},
      fmt::format("unknown source '{}' of import; use dh, linuxcnc, ur-calibration, urdf or volcomp",
                  options.source));
}

int count_of(std::string_view text, std::string_view word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + word.size())) ++count;
  return count;
}

}  // namespace

std::optional<ErrorKind> run_import(const Options& options, Console& console) {
  refuse_foreign_options(options.import);
  const std::string output = options.output.value_or("-");
  check_machine_output(output, {options.import.file}, options.force_overwrite);
  if (options.import.source == "volcomp") {
    write_file(output, imported_tables(options.import));
    return std::nullopt;
  }
  const std::string text = imported(options.import);
  write_file(output, text);
  console.note(
      fmt::format("{}: {} placeholders, each with a comment; `counterflex check` shows the machine\n",
                  output == "-" ? "the machine file" : output, count_of(text, "PLACEHOLDER") - 1));
  return std::nullopt;
}

}  // namespace counterflex::cli
