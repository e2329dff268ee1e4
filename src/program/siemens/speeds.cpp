#include "program/siemens/speeds.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/expand/control_flow.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// A feed or a speed; 0: unknown.
double known_or_zero(const Word& value) {
  return value.literal ? std::max(value.value, 0.0) : 0;
}

/// The spindle of "S1" or "M1"; 0 is the main spindle.
long spindle_of(std::string_view name) {
  long number = -1;
  std::from_chars(name.data() + 1, name.data() + name.size(), number);
  return number;
}

enum class IsMain { yes, no, unknown };

IsMain is_main(const ModalState& state, long spindle) {
  if (spindle == 0) return IsMain::yes;
  if (!state.main_spindle) return IsMain::unknown;
  return spindle == *state.main_spindle ? IsMain::yes : IsMain::no;
}

void apply_numbered_speed(Reading& r, IsMain main, const Word& value) {
  // S of a dwell is a number of turns, S of G25 and G26 is a limit.
  if (main == IsMain::no || r.sorted.has(Action::dwell) || r.sorted.has(Action::limits)) return;
  const bool known = main == IsMain::yes && !r.state.surface_speed;
  r.state.spindle_rpm = known ? known_or_zero(value) : 0;
}

/// M1=3 and M1=4 start the spindle, M1=5, M1=19 and M1=70 stop it.
void apply_numbered_code(ModalState& state, IsMain main, const Word& value) {
  if (main == IsMain::no) return;
  const bool starts = value.literal && (value.value == 3 || value.value == 4);
  const bool stops = !value.literal || value.value == 5 || value.value == 19 || value.value == 70;
  if (stops || (starts && main == IsMain::yes)) state.spindle_off = stops;
}

void set_main_spindle(ModalState& state, const Word& value) {
  state.main_spindle.reset();
  state.spindle_rpm = 0;
  if (value.literal) state.main_spindle = std::lround(value.value);
}

/// Whether F of "FGROUP(X,Y,Z,C)" is the feed of the path: the group has X, Y and Z, or no axis.
bool is_feed_of_path(std::string_view axes) {
  if (trimmed_text(axes).empty()) return true;
  std::size_t linear = 0;
  while (!axes.empty()) {
    const std::size_t comma = std::min(axes.find(','), axes.size() - 1);
    const std::string_view axis = trimmed_text(axes.substr(0, axes[comma] == ',' ? comma : comma + 1));
    linear += is_word(axis, "X") || is_word(axis, "Y") || is_word(axis, "Z");
    axes.remove_prefix(comma + 1);
  }
  return linear == 3;
}

void apply_speed_word(Reading& r, std::string_view name, const Word& value) {
  ModalState& state = r.state;
  if (is_word(name, "FB"))
    r.own_feed = known_or_zero(value);
  else if (is_word(name, "FGROUP"))
    state.feed_of_axes = !is_feed_of_path(part(r.program.text, value.number));
  else if (is_word(name, "FZ"))
    state.feed = 0;
  else if (is_word(name, "OVR"))
    state.feed_share = known_or_zero(value) / 100;
  else if (is_word(name, "SVC"))
    state.spindle_rpm = 0;
  else if (is_word(name, "SETMS"))
    set_main_spindle(state, value);
  else if (is_word(name.substr(0, 4), "SPOS"))
    state.spindle_off = true;
  else if (upper(name[0]) == 'S')
    apply_numbered_speed(r, is_main(state, spindle_of(name)), value);
  else
    apply_numbered_code(state, is_main(state, spindle_of(name)), value);
}

}  // namespace

void apply_speed_words(const Block& block, Reading& r) {
  for (const SpeedWord& word : block.speed_words)
    apply_speed_word(r, part(r.program.text, word.name), word.value);
}

void forget_unread_speeds(const Block& block, ModalState& state) {
  if (!block.speed_words.empty()) forget_speeds(state);
  for (const Word& word : block.words) {
    if (word.letter == 'F') state.feed = 0;
    if (word.letter == 'S') state.spindle_rpm = 0;
  }
}

}  // namespace counterflex
