#include "program/gcode/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "program/text/line_length.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t most_remarks = 1000;

/// "0.0039 inch = 0.09906 mm", or the number without a unit if the unit is unknown.
std::string length_text(double value, const ModalState& state) {
  if (!state.unit) return fmt::format("{} in the program's unit", value);
  if (*state.unit == LengthUnit::millimetres) return fmt::format("{} mm", value);
  return fmt::format("{} inch = {:.6g} mm", value, value * mm_per(*state.unit));
}

/// P and Q of G64 are read as those of LinuxCNC. Other controls may have neither.
std::string blend_text(const Reading& reading, const FoundG& blend) {
  const Word* p = reading.sorted.word('P');
  const Word* q = reading.sorted.word('Q');
  if (p == nullptr)
    return fmt::format("G{}{}: the control may leave the path by any distance", blend.word->value,
                       (reading.dialect.family & linuxcnc_family) != 0 ? " without P" : "");
  std::string text = fmt::format("G64 P{}: the control may leave the path by {}", p->value,
                                 length_text(p->value, reading.state));
  const double merged = q != nullptr ? q->value : p->value;
  if (merged > 0)
    text += fmt::format(" and merges moves within {} of a line: smaller corrections can vanish",
                        length_text(merged, reading.state));
  return text;
}

void record_tolerance(const Block& block, Reading& reading) {
  const double unit = mm_per(reading.state.unit.value_or(LengthUnit::millimetres));
  const auto length = [&](char letter) -> std::optional<double> {
    const Word* word = reading.sorted.word(letter);
    if (word == nullptr) return std::nullopt;
    return word->value * unit;
  };
  const PathTolerance tolerance{block.line, length('P'), length('Q')};
  auto& known = reading.program.path_tolerances;
  if (std::none_of(known.begin(), known.end(), [&](const PathTolerance& other) {
        return other.path_mm == tolerance.path_mm && other.merge_mm == tolerance.merge_mm;
      }))
    known.push_back(tolerance);
}

/// What a called program may change and the reader keeps.
std::string_view kept_behind_calls(std::string_view dialect) {
  if (dialect == "heidenhain")
    return "the datum, the coordinates (shift, rotation, mirror image, scale, tilt, M128) and the tool";
  if (dialect == "kuka") return "$BASE, $TOOL, $VEL, $ORI_TYPE and $CIRC_TYPE";
  if (dialect == "abb")
    return "work objects and tools, VelSet, SingArea and CirPathMode, and do not displace targets (PDispOn, "
           "EOffsOn)";
  if (dialect == "ur") return "features and the tool centre point, and do not offset the path";
  if (dialect == "fanuc_tp") return "the numbers of user frames and tools, and do not offset positions";
  if (dialect == "yaskawa") return "user frames and tools, and do not shift positions (SFTON)";
  return "the unit, the work offset, the coordinates (shift, rotation, mirror image, scale, tilt), the tool, "
         "its length, G40 to G42 and G93 to G97";
}

std::optional<double> known_length(const Reading& reading, long tool) {
  const auto found = reading.options.tool_lengths_mm.find(tool);
  if (found == reading.options.tool_lengths_mm.end()) return std::nullopt;
  return found->second;
}

/// "80 mm", of the tool with this number.
std::string length_in_words(const Reading& reading, long tool) {
  const auto length = known_length(reading, tool);
  return length ? fmt::format("{:.6g} mm", *length) : std::string("length not known");
}

/// The tip at which moves with this tool are computed.
std::string tip_of(const Reading& reading, long tool) {
  return known_length(reading, tool) ? fmt::format("the tip of T{}", tool) : "the tip of [tool]";
}

}  // namespace

void assume_of_calls(Program& program, int line) {
  add_remark(program, line,
             fmt::format("{}{}; see that their text agrees", assumption_of_calls,
                         kept_behind_calls(program.dialect)));
}

bool is_stated_harmless(Program& program, const ReadOptions& options, int line, std::string_view name) {
  std::string known = upper_case(name);
  std::erase(known, ' ');
  if (!options.harmless_calls.contains(known)) return false;
  add_remark(program, line,
             fmt::format("assumed: '{}' neither moves the machine nor changes its state, as [program] "
                         "harmless_calls of the machine file states",
                         name));
  return true;
}

void add_remark(Program& program, int line, std::string what) {
  if (program.remarks.size() >= most_remarks) return;
  const bool known = std::any_of(program.remarks.begin(), program.remarks.end(),
                                 [&](const Remark& remark) { return remark.what == what; });
  if (!known) program.remarks.push_back({line, std::move(what)});
}

void remark_path_mode(const Block& block, Reading& reading) {
  if (const FoundG* blend = reading.sorted.find(Action::blend)) {
    add_remark(reading.program, block.line, blend_text(reading, *blend));
    record_tolerance(block, reading);
  }
  if (const FoundG* smooth = reading.sorted.find(Action::smooth))
    add_remark(
        reading.program, block.line,
        fmt::format("G{}: the control smooths the path; corrections smaller than its tolerance can vanish",
                    smooth->word->value));
}

void remark_tool_length(const Block& block, Reading& reading) {
  const FoundG* length = reading.sorted.find(Action::tool_length);
  if (length == nullptr) return;
  const Word* h = reading.sorted.word('H');
  const std::string code = fmt::format("G{}", length->word->value);
  const auto remark = [&](std::string_view what) {
    add_remark(reading.program, block.line, fmt::format("{}: {}", code, what));
  };
  const long in_spindle = reading.state.tool;
  if (length->code->tenths == 431 || length->code->tenths == 432)
    return remark(
        fmt::format("the length that it sets is not followed; {} is used", tip_of(reading, in_spindle)));
  const long tool = h != nullptr && h->literal ? static_cast<long>(h->value) : in_spindle;
  if (tool <= 0 && in_spindle > 0)
    return remark(fmt::format("the length under H0 is not known; {} is used", tip_of(reading, in_spindle)));
  if (tool <= 0) return remark("the tool and its length are not known; the tip of [tool] is used");
  if (reading.lengths_set)
    return remark(fmt::format("a variable or G10 before may have set the length of T{}", tool));
  if (is_other_length(reading)) return;
  if (known_length(reading, tool))
    return remark(fmt::format("the value of H is not known; {} is used", tip_of(reading, tool)));
  remark(
      fmt::format("the length of T{} is not known; the tip of [tool] is used (give length_mm in "
                  "[tools.T{}], --tool-table, or --tool-length T{}=MM)",
                  tool, tool, tool));
}

bool is_other_length(const Reading& reading) {
  const ModalState& state = reading.state;
  const double h = state.tool_length.value_or(0);
  if (state.tool <= 0 || h == 0 || std::abs(h) > INT32_MAX || reading.dialect.sinumerik_words) return false;
  const long number = static_cast<long>(h);
  if (number == state.tool || reading.lengths_set) return false;
  const auto of_number = known_length(reading, number);
  return !of_number || of_number != known_length(reading, state.tool);
}

void remark_other_length(int line, Reading& reading) {
  if (!is_other_length(reading)) return;
  const long number = static_cast<long>(*reading.state.tool_length), tool = reading.state.tool;
  add_remark(reading.program, line,
             fmt::format("H{} ({}) acts while T{} ({}) is in the spindle; {} is used: see that offset {} of "
                         "the control holds the length of T{}, or program H{}",
                         number, length_in_words(reading, number), tool, length_in_words(reading, tool),
                         tip_of(reading, tool), number, tool, tool));
}

namespace {

/// G49, H0 of a known length of 0, or before the first tool length.
bool acts_no_length(const Reading& reading) {
  const ModalState& state = reading.state;
  if (reading.dialect.sinumerik_words) return false;
  if (!state.tool_length) return !reading.uses_tool_length;
  return *state.tool_length == 0 && state.tool_length_mm == 0.0;
}

void remark_without_length(int line, long tool, Reading& reading) {
  add_remark(reading.program, line,
             fmt::format("T{} ({}) cuts where the program applies no tool length (G49, or before the first "
                         "G43); {} is used: see that the work offset includes the length of T{}, or program "
                         "it (G43)",
                         tool, length_in_words(reading, tool), tip_of(reading, tool), tool));
}

}  // namespace

void remark_cut_without_length(int line, Reading& reading) {
  const long tool = reading.state.tool;
  if (tool <= 0 || !acts_no_length(reading) || known_length(reading, tool) == 0.0) return;
  const bool is_first = reading.cuts_without_tool_length.try_emplace(tool, line).second;
  if (is_first && reading.uses_tool_length) remark_without_length(line, tool, reading);
}

void remark_cuts_before_length(Reading& reading) {
  for (const auto& [tool, line] : reading.cuts_without_tool_length)
    remark_without_length(line, tool, reading);
}

void remark_named_tool(const Block& block, Reading& reading) {
  if (const Word* t = reading.sorted.word('T'); t != nullptr && !t->literal)
    add_remark(reading.program, block.line, std::string(tool_without_number));
}

void remark_machine_codes(const Block& block, Reading& reading) {
  for (const FoundM& m : reading.sorted.m)
    if (m.action == MAction::machine)
      add_remark(reading.program, block.line,
                 fmt::format("M{}: defined by the machine builder; assumed not to move an axis", m.code));
}

void remark_length(const Block& block, Reading& reading) {
  const std::size_t limit = reading.dialect.line_limit;
  const std::string_view line = part(reading.program.text, block.span);
  if (limit == 0 || line.size() + room_for_words <= limit) return;
  const std::size_t length = counted_length(reading.dialect, line);
  if (length > limit) {
    add_remark(reading.program, block.line,
               fmt::format("the line has {} characters; {} reads {}", length, reading.dialect.name, limit));
  } else if (length + room_for_words > limit) {
    add_remark(reading.program, block.line,
               fmt::format("the line has {} of the {} characters that {} reads: little space for corrections",
                           length, limit, reading.dialect.name));
  }
}

}  // namespace counterflex
