#include "run/header/header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameters.hpp"
#include "process/version.hpp"

namespace counterflex::cli {
namespace {

constexpr std::string_view header_mark = "COUNTERFLEX 1 ";

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string short_hash(const InputFile& file) {
  return upper(file.sha256.substr(0, 16));
}

std::string text_of(const Vector6& F) {
  return fmt::format("{},{},{},{},{},{}", F[0], F[1], F[2], F[3], F[4], F[5]);
}

/// A name in characters that controls allow in comments. Other characters become one blank each sequence;
/// long names are cut.
std::string plain_name(const std::string& name) {
  constexpr std::size_t most = 40;
  std::string plain;
  for (const char c : upper(name)) {
    const bool allowed = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         std::string_view(".,+-=/_").find(c) != std::string_view::npos;
    if (allowed)
      plain += c;
    else if (!plain.empty() && plain.back() != ' ')
      plain += ' ';
  }
  if (plain.size() > most) plain.resize(most);
  while (!plain.empty() && plain.back() == ' ') plain.pop_back();
  return plain;
}

std::string file_name(const std::string& path) {
  return path == "-" ? "STANDARD INPUT" : plain_name(std::filesystem::path(path).filename().generic_string());
}

/// At most `decimals` digits, without zeros at the end.
std::string short_number(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// "X1 Y2 Z3".
std::string three(const std::array<const char*, 3>& letters, const Vector3& values) {
  constexpr int decimals = 4;
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i == 0 ? "" : " ") + (letters[static_cast<std::size_t>(i)] + short_number(values[i], decimals));
  return text;
}

/// A work offset at the first move in it.
struct PlacedOffset {
  std::string name;
  Pose X_MW;
  int line = 0;
  int changed_in = 0;  ///< line of the first move in another pose of this name; 0: it stays
};

/// The offsets in use in the order of the program, each name once.
std::vector<PlacedOffset> placed_offsets(const Run& run) {
  std::vector<PlacedOffset> all, named;
  for (std::size_t i = 0; i < run.program.frame_lines.size(); ++i) {
    const WorkFrame& frame = run.work.frames[i];
    if (run.program.frame_lines[i] > 0 && !frame.name.empty())
      all.push_back({frame.name, pose_of_offset(frame, run.program.frames[i]), run.program.frame_lines[i]});
  }
  std::ranges::stable_sort(all, {}, &PlacedOffset::line);
  for (PlacedOffset& offset : all) {
    const auto first = std::ranges::find(named, offset.name, &PlacedOffset::name);
    if (first == named.end())
      named.push_back(std::move(offset));
    else if (first->changed_in == 0 && difference(first->X_MW, offset.X_MW).norm() > 1e-9)
      first->changed_in = offset.line;
  }
  return named;
}

/// Whether a move is in an offset whose pose neither the machine file nor the program gives.
bool takes_machine_frame(const Run& run) {
  if (!run.machine.machine.work.empty()) return false;
  const std::vector<int>& lines = run.program.frame_lines;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i] > 0 && run.work.frames[i].name.empty()) return true;
  return false;
}

void add_work(const Run& run, std::vector<std::string>& lines) {
  if (takes_machine_frame(run)) lines.push_back("WORK OFFSETS NOT GIVEN, MACHINE FRAME TAKEN");
  for (const PlacedOffset& offset : placed_offsets(run)) {
    const std::string name = plain_name(offset.name);
    lines.push_back(fmt::format("WORK {} AT {} MM", name, three({"X", "Y", "Z"}, offset.X_MW.p / mm)));
    const Vector3 rpy_deg = to_rpy(offset.X_MW.R) / deg;
    if (rpy_deg.norm() > 1e-9)
      lines.push_back(fmt::format("WORK {} {} DEG", name, three({"ROLL ", "PITCH ", "YAW "}, rpy_deg)));
    if (offset.changed_in > 0)
      lines.push_back(fmt::format("WORK {} CHANGES IN LINE {}", name, offset.changed_in));
  }
}

void add_tools(const Run& run, std::vector<std::string>& lines) {
  if (run.tools.file) lines.push_back("TOOLS " + short_hash(*run.tools.file));
  for (const long tool : run.program.tools) {
    if (tool == 0) continue;
    const auto length = run.tools.mm.find(tool);
    lines.push_back(length == run.tools.mm.end()
                        ? fmt::format("TOOL T{} LENGTH NOT GIVEN, TIP OF THE MACHINE FILE", tool)
                        : fmt::format("TOOL T{} LENGTH {} MM", tool, short_number(length->second, 4)));
  }
}

void add_forces(const Options& options, const Run& run, std::vector<std::string>& lines) {
  const auto& files = run.force_input.files;
  for (const InputFile& forces : files) lines.push_back("FORCES " + short_hash(forces));
  for (const InputFile& forces : files) lines.push_back("WITH FORCES OF FILE " + file_name(forces.path));
  for (const ForceRule& rule : options.force_rules) lines.push_back("FORCE " + upper(force_rule_text(rule)));
  if (!options.force_rules.empty()) lines.push_back("FORCE IN N AND N M, AXES OF THE MACHINE");
  if (run.program.commented_force) lines.push_back("WITH FORCES OF COMMENTS IN THE PROGRAM");
  const bool none = files.empty() && options.force_rules.empty() && !run.program.commented_force;
  if (none || options.load_scale == 0)
    lines.push_back("NO CUTTING FORCE, GEOMETRY AND WEIGHT ONLY");
  else if (options.load_scale != 1)
    lines.push_back("WITH FORCES TIMES " + short_number(options.load_scale, 6));
  if (none || options.load_scale == 0) return;
  if (options.blend != Options{}.blend)
    lines.push_back(fmt::format("WITH FORCES BLENDED OVER {} MM", short_number(options.blend / mm, 6)));
  if (options.air_above_mm)
    lines.push_back(fmt::format("NO FORCE ABOVE Z{} MM", short_number(*options.air_above_mm, 6)));
}

void add_reading(const Run& run, std::vector<std::string>& lines) {
  std::string how;
  for (const ReadingWord& word : reading_words(run.read))
    if (word.acts) how += fmt::format("{}{}", how.empty() ? "" : ", ", word.in_header);
  if (!how.empty()) lines.push_back("READ WITH " + how);
}

}  // namespace

std::vector<ReadingWord> reading_words(const ReadOptions& read) {
  return {{read.integer_words == IntegerWords::units, "INTEGER WORDS UNITS", "--integer-words units"},
          {read.integer_words == IntegerWords::increments, "INTEGER WORDS INCREMENTS",
           "--integer-words increments"},
          {read.absolute_centres, "ARC CENTRES ABSOLUTE", "--arc-centres absolute"},
          {read.evaluate, "EVALUATE", "--evaluate"},
          {read.expand_subprograms, "EXPAND SUBPROGRAMS", "--expand-subprograms"}};
}

std::string force_rule_text(const ForceRule& rule) {
  const std::string tool = rule.selector.tool ? fmt::format("T{}=", *rule.selector.tool) : "";
  return tool + text_of(std::get<ConstantForce>(rule.content).F);
}

std::vector<std::string> header_of(const Options& options, const Run& run) {
  const std::string name = plain_name(run.machine.machine.name);
  std::vector<std::string> lines{
      fmt::format("VERSION {} METHOD {}", upper(version), upper(std::string(to_string(run.options.method)))),
      "PROGRAM " + short_hash(run.file.file), "MACHINE " + short_hash(run.machine.file),
      "MADE FOR " + (name.empty() ? "A MACHINE WITHOUT A NAME" : name)};
  if (is_unmeasured(run.machine.machine)) lines.push_back("UNMEASURED MACHINE, ITS STIFFNESS IS ASSUMED");
  for (const InputFile& list : run.file.data_lists) lines.push_back("DATA LIST " + short_hash(list));
  if (const auto& temperature = run.machine.machine.temperature)
    lines.push_back(fmt::format("TEMPERATURE {} DEGREES CELSIUS", short_number(*temperature, 4)));
  add_work(run, lines);
  add_tools(run, lines);
  add_forces(options, run, lines);
  add_reading(run, lines);
  if (const auto line = first_unread_call(run.program))
    lines.push_back(fmt::format("CALLED PROGRAMS FROM LINE {} ON MUST KEEP OFFSETS AND TOOL", *line));
  if (options.only_significant) lines.push_back(std::string(only_significant_mark) + ", REST AS PROGRAMMED");
  for (std::string& line : lines) line.insert(0, header_mark);
  return lines;
}

}  // namespace counterflex::cli
