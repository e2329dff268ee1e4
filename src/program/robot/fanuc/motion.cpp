// The words of motion statements.
#include <algorithm>
#include <array>

#include "program/robot/fanuc/read.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

// The options are those of programs that were seen, not of a manual: a motion with another one is refused.

/// Options that a copy of the statement may repeat, in upper case up to their number.
constexpr auto copied_options =
    std::to_array<std::string_view>({"ACC", "PTH", "EV", "IND.EV", "MROT", "BREAK"});
/// Options that act once, at the end of the motion.
constexpr auto single_options =
    std::to_array<std::string_view>({"ARC", "WELD", "START", "END", "AP_LD", "RT_LD", "ORNT_BASE"});
/// The rest of the statement is an action at the end of the motion: "TB .50sec,CALL GRIP".
constexpr auto timed_options = std::to_array<std::string_view>({"TA", "TB", "DB"});
/// Options that move the tool away from the target, or that end the motion before it.
constexpr auto displacing_options =
    std::to_array<std::string_view>({"OFFSET", "TOOL_OFFSET", "VOFFSET", "INC", "SKIP", "COORD", "RTCP",
                                     "TRACK", "SEARCH", "TOUCH", "WEAVE"});

struct SpeedUnit {
  std::string_view name;
  double mm_min;  ///< 0: not a speed of the tool centre point
};
constexpr auto speed_units = std::to_array<SpeedUnit>({{"MM/SEC", 60},
                                                       {"CM/MIN", 10},
                                                       {"MM/MIN", 1},
                                                       {"M/MIN", 1000},
                                                       {"INCH/MIN", 25.4},
                                                       {"INCH/SEC", 1524},
                                                       {"IN/MIN", 25.4},
                                                       {"IPM", 25.4},
                                                       {"DEG/SEC", 0},
                                                       {"%", 0}});
constexpr auto time_units = std::to_array<std::string_view>({"SEC", "MSEC"});

/// The letters, '_' and '.' at the begin of a word: "ACC" of "ACC80", "Tool_Offset" of "Tool_Offset,PR[1]".
std::string head_of(std::string_view word) {
  std::size_t size = 0;
  while (size < word.size() && (is_letter(word[size]) || word[size] == '_' || word[size] == '.')) ++size;
  return tp_word(word.substr(0, size));
}

/// The speed behind the targets, "100mm/sec", "100 mm/sec" or "R[1]mm/sec". Returns the number of its words.
std::size_t read_speed(std::string_view text, std::span<const Span> words, TpMotion& motion) {
  if (words.empty()) return 0;
  const Span first = words.front();
  const auto at = [&](std::size_t i) { return i < words.size() ? tp_word(part(text, words[i])) : ""; };
  std::string unit;
  double value = 0;
  if (is_digit(text[first.begin]) || text[first.begin] == '.') {
    Span digits{first.begin, first.begin};
    while (digits.end < first.end && (is_digit(text[digits.end]) || text[digits.end] == '.')) ++digits.end;
    if (const auto number = number_at(text.substr(0, digits.end), digits.begin)) value = number->value;
    unit = tp_word(part(text, {digits.end, first.end}));
  } else if (at(0).starts_with("R[") || at(0).starts_with("AR[")) {
    unit = at(0).substr(at(0).rfind(']') + 1);
  } else {
    const std::string name = at(0);  // WELD_SPEED, max_speed
    return name.ends_with("SPEED") ? 1 : 0;
  }
  const bool apart = unit.empty();
  if (apart) unit = at(1);
  const auto speed = std::ranges::find(speed_units, unit, &SpeedUnit::name);
  if (speed != speed_units.end()) motion.feed_mm_min = value * speed->mm_min;
  const bool is_time = is_among(unit, time_units);
  motion.acts_once = motion.acts_once || is_time;
  const bool known = speed != speed_units.end() || is_time;
  return apart && known ? 2 : 1;
}

/// An option; false for one behind which the other words belong to it.
bool read_option(std::string_view text, Span word, TpMotion& motion) {
  const std::string whole = tp_word(part(text, word)), head = head_of(part(text, word));
  const auto note = [&](Span& place) {
    if (empty(place)) place = word;
  };
  if (head == "FINE") return true;
  if (head == "CNT") {
    motion.passes = whole != "CNT0";
  } else if (head == "CD" || head == "CR") {
    motion.passes = motion.passes || whole != head + "0";
  } else if (is_among(head, displacing_options)) {
    note(motion.refused);
  } else if (is_among(head, timed_options)) {
    motion.acts_once = true;
    return false;
  } else if (is_among(head, single_options)) {
    motion.acts_once = true;
  } else if (head == "WJNT") {
    motion.wrist_joint = true;
  } else if (!is_among(head, copied_options)) {
    const bool is_argument = is_digit(whole[0]) || whole.starts_with("R[") || whole.starts_with("AR[");
    if (!is_argument) note(motion.unknown);
  }
  return true;
}

}  // namespace

TpMotion tp_motion(std::string_view text, Span code) {
  TpMotion motion;
  const std::vector<Span> words = tp_words(text, code);
  if (words.size() < 2 || words[0].end != words[0].begin + 1) return motion;
  const char type = upper(text[words[0].begin]);
  const std::size_t operands = type == 'C' ? 2 : 1;
  std::size_t next = 1;
  for (; next < words.size() && motion.operands.size() < operands; ++next) {
    auto operand = tp_operand(text, words[next]);
    if (!operand || (operand->array != "P" && operand->array != "PR")) break;
    motion.operands.push_back(std::move(*operand));
  }
  if (motion.operands.empty() || std::string_view("JLCAS").find(type) == std::string_view::npos)
    return motion;
  motion.type = type;
  next += read_speed(text, std::span(words).subspan(next), motion);
  while (next < words.size() && read_option(text, words[next], motion)) ++next;
  if (next < words.size()) {  // at a timed option
    const std::string action = tp_word(part(text, {words[next].begin, code.end}));
    motion.action = action.substr(std::min(action.find(','), action.size() - 1) + 1);
  }
  return motion;
}

}  // namespace counterflex
