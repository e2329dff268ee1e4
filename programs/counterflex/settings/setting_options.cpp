#include "settings/setting_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"
#include "settings/help.hpp"
#include "settings/output_names.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

void take_dialect(const std::string&, const std::string& text, Options& options) {
  if (const auto problem = unknown_dialect(text)) throw InputError(ErrorKind::usage, {}, *problem);
  options.dialect = text;
}

void take_units(const std::string& name, const std::string& text, Options& options) {
  options.units = choice_of(name, text, {"mm", "inch"}) == 0 ? LengthUnit::millimetres : LengthUnit::inches;
}

void take_integer_words(const std::string& name, const std::string& text, Options& options) {
  options.integer_words =
      choice_of(name, text, {"units", "increments"}) == 0 ? IntegerWords::units : IntegerWords::increments;
}

void take_arc_centres(const std::string& name, const std::string& text, Options& options) {
  options.absolute_centres = choice_of(name, text, {"incremental", "absolute"}) == 1;
}

void take_method(const std::string& name, const std::string& text, Options& options) {
  constexpr std::array methods{Method::direct, Method::nested, Method::linear};
  options.method = methods[choice_of(name, text, {"direct", "nested", "linear"})];
}

void take_free(const std::string& name, const std::string& text, Options& options) {
  choice_of(name, text, {"spin"});
  options.free_spin = true;
}

void take_work(const std::string& name, const std::string& text, Options& options) {
  const bool machine = work_of(text, name).offset.empty();
  for (const std::string& other : options.work)
    if (machine != work_of(other).offset.empty())
      throw InputError(ErrorKind::usage, {},
                       fmt::format("{} is '{}' and '{}': machine, which makes program coordinates machine "
                                   "coordinates, goes with no offset",
                                   name, other, text));
  options.work.push_back(text);
}

void take_tool_length(const std::string& name, const std::string& text, Options& options) {
  const auto [tool, length_mm] = tool_length_of(name, text);
  options.tool_lengths_mm[tool] = length_mm;
}

void take_plot(const std::string& name, const std::string& text, Options& options) {
  check_pattern(name, text);
  if (!text.ends_with(".svg") && !text.ends_with('/'))
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{} writes a file that ends in .svg, not '{}'", name, text));
  options.plot = text;
}

void take_report(const std::string& name, const std::string& text, Options& options) {
  check_pattern(name, text);
  options.report = text;
}

using Text = const std::string&;

const std::array option_table{
    SettingOption{"machine", "-m,--machine", "MACHINE", group::common,
                  "The machine file (default: from the project file)", "", false,
                  [](Text, Text text, Options& options) { options.machine = text; }},
    SettingOption{"forces", "-f,--forces", "FORCES", group::common,
                  "Forces by place, tool or operation (.csv), cutting models (.toml); may be repeated", "",
                  true, [](Text, Text text, Options& options) { options.forces.push_back(text); }},
    SettingOption{
        "force", "--force", "[T3=]FX,FY,FZ[,MX,MY,MZ]", group::common,
        "A constant wrench on the tool at its tip in all feed moves, or in those of a tool: N and N m, "
        "machine "
        "frame; may be repeated",
        "", true,
        [](Text, Text text, Options& options) { options.force_rules.push_back(parse_force_rule(text)); }},
    SettingOption{
        "load-scale", "--load-scale", "SCALE", group::common,
        "Multiplies all cutting forces (default 1); 0 corrects geometry and weight only", "1", false,
        [](Text name, Text text, Options& options) { options.load_scale = number_of(name, text, {0}); }},
    SettingOption{
        "air-above", "--air-above", "Z", group::forces,
        "Feed moves entirely above this Z of the program (mm) have no force", "", false,
        [](Text name, Text text, Options& options) { options.air_above_mm = number_of(name, text); }},
    SettingOption{
        "blend-mm", "--blend-mm", "LENGTH", group::forces,
        "A step of the force acts as a ramp over this length in mm (default 2); 0: as a jump", "2", false,
        [](Text name, Text text, Options& options) {
          constexpr double least_mm = 0.01;  // words have hardly finer digits
          const double blend_mm = number_of(name, text, {0});
          if (blend_mm > 0 && blend_mm < least_mm)
            throw InputError(
                ErrorKind::usage, {},
                fmt::format("{} is '{}', must be 0 for jumps, or at least {}", name, text, least_mm));
          options.blend = blend_mm * mm;
        }},
    SettingOption{
        "dialect", "--dialect", "NAME", group::reading,
        "The control: auto, linuxcnc, grbl, fanuc, haas, mach3, siemens, heidenhain, kuka, abb, ur, apt, "
        "fanuc_tp or yaskawa (default: of the machine file, or auto)",
        "", false, take_dialect},
    SettingOption{"units", "--units", "mm|inch", group::common, "Units before the program states its own", "",
                  false, take_units},
    SettingOption{"integer-words", "--integer-words", "units|increments", group::reading,
                  "The meaning of length words without a point on fanuc and haas controls", "", false,
                  take_integer_words},
    SettingOption{
        "arc-centres", "--arc-centres", "incremental|absolute", group::reading,
        "I, J and K of arcs before G90.1 or G91.1: distances from the start, or coordinates (default: of the "
        "machine file, or incremental)",
        "", false, take_arc_centres},
    SettingOption{"evaluate", "--evaluate", "", group::reading,
                  "Compute variables that the program sets to constants, and expressions of them", "false",
                  false,
                  [](Text name, Text text, Options& options) { options.evaluate = truth_of(name, text); }},
    SettingOption{
        "expand-subprograms", "--expand-subprograms", "", group::reading,
        "Replace calls of subprograms by their bodies, and loops, conditions and jumps of constants by what "
        "they execute",
        "false", false,
        [](Text name, Text text, Options& options) { options.expand_subprograms = truth_of(name, text); }},
    SettingOption{
        "data", "--data", "FILE.dat", group::reading,
        "A data list with targets of a KUKA program; NAME.dat beside NAME.src is read without this. "
        "May be repeated",
        "", true, [](Text, Text text, Options& options) { options.data_lists.push_back(text); }},
    SettingOption{"work", "--work", "G54=X,Y,Z[,RX,RY,RZ][/DATUM][/offset=X,Y,Z]", group::common,
                  "A work offset in the machine frame, mm and degrees. DATUM is how it was found: machine or "
                  "touched=X,Y,Z. offset gives the numbers on the control, for --guard. May be repeated. "
                  "--work machine: program coordinates are machine coordinates",
                  "", true, take_work},
    SettingOption{"tool-table", "--tool-table", "FILE", group::reading,
                  "Tool lengths in mm, in LinuxCNC's format", "", false,
                  [](Text, Text text, Options& options) { options.tool_table = text; }},
    SettingOption{"tool-length", "--tool-length", "T1=LENGTH", group::reading,
                  "The length of a tool in mm; overrides tool table and machine file; may be repeated", "",
                  true, take_tool_length},
    SettingOption{
        "temperature-C", "--temperature-C", "TEMPERATURE", group::common,
        "The temperature at which [thermal] of the machine file shifts the machine", "", false,
        [](Text name, Text text, Options& options) { options.temperature = number_of(name, text); }},
    SettingOption{"uncertainty", "--uncertainty", "FILE", group::common,
                  "A file with [uncertainty], in place of the table of the machine file", "", false,
                  [](Text, Text text, Options& options) { options.uncertainty = text; }},
    SettingOption{"samples", "--samples", "N", group::correction,
                  "Check the bands of [uncertainty] with N machines drawn from it (default 0)", "0", false,
                  [](Text name, Text text, Options& options) {
                    options.samples = static_cast<std::size_t>(integer_of(name, text, 0, 100'000));
                  }},
    SettingOption{"method", "--method", "direct|nested|linear", group::correction,
                  "How targets are solved (default direct)", "direct", false, take_method},
    SettingOption{"tolerance-mm", "--tolerance-mm", "LENGTH", group::common,
                  "The largest deviation of the tip that may remain, in mm (default 0.005)", "0.005", false,
                  [](Text name, Text text, Options& options) {
                    options.tolerance = number_of(name, text, {0, true}) * mm;
                  }},
    SettingOption{
        "tolerance-tilt-deg", "--tolerance-tilt-deg", "ANGLE", group::correction,
        "Of a program that turns the tool: the largest tilt of its axis that may remain, in degrees "
        "(default 0.02)",
        "0.02", false,
        [](Text name, Text text, Options& options) {
          options.tilt_tolerance = number_of(name, text, {0, true}) * deg;
        }},
    SettingOption{"tolerance-spin-deg", "--tolerance-spin-deg", "ANGLE", group::correction,
                  "The same about the tool's axis (default: any, a cutter does not see it)", "", false,
                  [](Text name, Text text, Options& options) {
                    options.spin_tolerance = number_of(name, text, {0, true}) * deg;
                  }},
    SettingOption{"free", "--free", "spin", group::correction,
                  "Of a robot: choose the turn about the spindle axis that lowers the deviation, along the "
                  "program (predict: show what it buys)",
                  "", false, take_free},
    SettingOption{"max-correction-mm", "--max-correction-mm", "LENGTH", group::common,
                  "The largest correction that is accepted, in mm (default: of the machine file, or 1)", "",
                  false,
                  [](Text name, Text text, Options& options) {
                    options.max_correction = number_of(name, text, {0, true}) * mm;
                  }},
    SettingOption{
        "accept-partial", "--accept-partial", "", group::correction,
        "Accept the verdict PARTLY: write the program though some feed moves miss the tolerance", "false",
        false, [](Text name, Text text, Options& options) { options.accept_partial = truth_of(name, text); }},
    SettingOption{
        "only-significant", "--only-significant", "", group::correction,
        "Leave targets as programmed where the deviation is below its own band (k = 2)", "false", false,
        [](Text name, Text text, Options& options) { options.only_significant = truth_of(name, text); }},
    SettingOption{
        "decimals", "--decimals", "N", group::correction,
        "Decimals in corrected words (default: as in the program)", "", false,
        [](Text name, Text text, Options& options) { options.decimals = integer_of(name, text, 0, 9); }},
    SettingOption{
        "number-pieces", "--number-pieces", "", group::correction,
        "Give the pieces of a split block Nn the numbers Nn+1, Nn+2 ..., if they are free", "", false,
        [](Text name, Text text, Options& options) { options.number_pieces = truth_of(name, text); }},
    SettingOption{
        "max-points", "--max-points", "N", group::correction,
        "The most targets that the control allows in a robot program (default: FANUC TP 999 positions, "
        "URScript 2500)",
        "", false,
        [](Text name, Text text,
           Options& options) { options.max_points = integer_of(name, text, 1, 1'000'000'000); }},
    SettingOption{
        "guard", "--guard", "", group::correction,
        "Write checks before the first cut: work offset, tool and units must be those of the correction",
        "false", false, [](Text name, Text text, Options& options) { options.guard = truth_of(name, text); }},
    SettingOption{"proof", "--proof", "", group::output,
                  "Begin STEM.html with a setup sheet: one printed page for the person at the machine",
                  "false", false,
                  [](Text name, Text text, Options& options) { options.proof = truth_of(name, text); }},
    SettingOption{
        "threads", "--threads", "N", group::correction,
        "Threads; the output does not depend on it (default: all processors)", "", false,
        [](Text name, Text text, Options& options) { options.threads = integer_of(name, text, 1, 1024); }},
    SettingOption{
        "min-block-ms", "--min-block-ms", "TIME", group::correction,
        "Shorter feed moves produce a warning, in ms (default 2)", "2", false,
        [](Text name, Text text, Options& options) { options.min_block_ms = number_of(name, text, {0}); }},
    SettingOption{"report", "--report", "STEM", group::common, "Write STEM.html, STEM.json and STEM.csv", "",
                  false, take_report},
    SettingOption{"plot", "--plot", "FILE.svg", group::output,
                  "Write the deviation along the path and its causes as a picture", "", false, take_plot},
    SettingOption{
        "force-overwrite", "--force-overwrite", "", group::output,
        "Replace existing machine files, sheets, and files that counterflex did not write", "", false,
        [](Text name, Text text, Options& options) { options.force_overwrite = truth_of(name, text); }},
    SettingOption{
        "output",
        "-o,--output", "OUTPUT", group::common,
        "The corrected program, a folder for it (DIR/) or a pattern ({name}_CF{ext}); - is standard output "
        "(default: NAME.comp.EXT beside the input)",
        "", false, [](Text name, Text text, Options& options) {
          check_pattern(name, text);
          options.output = text;
        }}};

bool is_among(std::string_view option, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), option) != list.end();
}

bool is_of_reading(std::string_view option) {
  return is_among(option, {"machine", "dialect", "units", "integer-words", "arc-centres", "evaluate",
                           "expand-subprograms", "data", "work", "tool-table", "tool-length"});
}

}  // namespace

std::span<const SettingOption> setting_options() {
  return option_table;
}

const SettingOption& setting_option(std::string_view option) {
  return *std::find_if(option_table.begin(), option_table.end(),
                       [&](const SettingOption& entry) { return entry.option == option; });
}

bool has_setting(Command command, std::string_view option) {
  switch (command) {
    case Command::compensate:
    case Command::predict:
    case Command::verify:
    case Command::watch:
      return true;
    case Command::analyze:
      return is_among(option, {"machine", "method", "force-overwrite"});
    case Command::forces:
      return is_of_reading(option) ||
             is_among(option, {"forces", "force", "load-scale", "air-above", "force-overwrite"});
    case Command::check:
      return is_of_reading(option) || option == "force-overwrite";
    case Command::batch:
      return is_among(option, {"threads", "force-overwrite"});
    case Command::identify:
      return (is_of_reading(option) && option != "data") ||
             is_among(option, {"forces", "force", "load-scale", "air-above", "blend-mm", "threads",
                               "force-overwrite"});
    case Command::testcut:
      return is_among(option, {"machine", "forces", "force", "load-scale", "air-above", "blend-mm", "work",
                               "tolerance-mm", "max-correction-mm", "threads", "force-overwrite"});
    case Command::map:
      return is_of_reading(option) || is_among(option, {"threads", "force-overwrite"});
    case Command::compare:
    case Command::create:
    case Command::import:
      return option == "force-overwrite";
  }
  return false;
}

std::string name_in_messages(const Setting& setting) {
  return shown_option(setting.option, setting.origin == Origin::environment ? Origin::file : setting.origin);
}

void blame_setting(const Setting& setting, std::size_t i, const std::string& message) {
  throw InputError(setting.origin == Origin::file ? ErrorKind::machine_or_force : ErrorKind::usage,
                   place_of(setting, i), message);
}

std::string message_without_place(const InputError& error) {
  const std::string_view what = error.what(), prefix = "error: ";
  return std::string(what.starts_with(prefix) ? what.substr(prefix.size()) : what);
}

void apply_setting(const Setting& setting, Options& options) {
  const SettingOption& option = setting_option(setting.option);
  for (std::size_t i = 0; i < setting.values.size(); ++i) {
    try {
      option.take(name_in_messages(setting), setting.values[i], options);
    } catch (const InputError& error) {
      blame_setting(setting, i, message_without_place(error));
    }
  }
}

}  // namespace counterflex::cli
