#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "counterflex/files/text.hpp"
#include "program/dialect.hpp"
#include "program/gcode/remarks.hpp"
#include "program/klartext/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// "7.1" of CYCL DEF 7.1 and the position behind it; 0.0 without a number.
struct CycleNumber {
  int cycle = 0;
  int line = 0;
  std::size_t end = 0;
};

int take_integer(std::string_view text, std::size_t& at, std::size_t end) {
  int value = 0;
  for (; at < end && text[at] >= '0' && text[at] <= '9' && value < 100000; ++at)
    value = 10 * value + (text[at] - '0');
  return value;
}

CycleNumber number_of(std::string_view text, const KlartextBlock& block) {
  CycleNumber number;
  std::size_t at = text.find_first_of("0123456789", block.parts[0].begin);
  const std::size_t end = block.parts[0].end;
  if (at >= end) return number;
  number.cycle = take_integer(text, at, end);
  if (at < end && text[at] == '.') number.line = take_integer(text, ++at, end);
  number.end = at;
  return number;
}

/// Cycles that stay above or in the point at which they are called: holes, taps, pockets about the point.
bool stays_where_called(int cycle) {
  constexpr std::array in_place{1,   2,   17,  18,  240, 241, 251, 252, 253,
                                254, 256, 257, 262, 263, 264, 265, 267};
  return std::find(in_place.begin(), in_place.end(), cycle) != in_place.end() ||
         (cycle >= 200 && cycle <= 215);
}

/// Cycles of the control that only set states, or that move when they are called. Others may move by their
/// definition.
bool acts_when_called(int cycle) {
  constexpr std::array others{32, 39, 225, 230, 231, 232, 233, 235, 1271, 1272, 1273, 1274, 1276, 1278, 1281};
  return std::find(others.begin(), others.end(), cycle) != others.end() || (cycle >= 1 && cycle <= 29) ||
         (cycle >= 200 && cycle <= 215) || (cycle >= 240 && cycle <= 241) || (cycle >= 251 && cycle <= 258) ||
         (cycle >= 262 && cycle <= 277);
}

/// Cycles of older controls, which start from the height of the tool.
bool counts_from_tool(int cycle) {
  return (cycle >= 1 && cycle <= 5) || cycle == 17 || cycle == 18;
}

/// Drilling and tapping return to the start. The end of slots and pockets is not followed.
bool returns_to_start(int cycle) {
  return cycle == 1 || cycle == 2 || cycle == 17;
}

/// Cycles whose heights and depths are all relative to their surface, without a position of their own.
bool counts_from_surface(int cycle) {
  return (cycle >= 200 && cycle <= 209) || cycle == 240 || cycle == 241;
}

/// BORE MILLING: the cutter moves along the wall of the bore, whose diameter is Q335.
constexpr int bore_milling = 208;

/// A parameter that is a plain number in mm.
struct ParameterWord {
  double value_mm;
  AxisWord word;
};

bool names(const KlartextBlock& block, std::string_view parameter, const KlartextReading& r) {
  return std::any_of(block.parts.begin(), block.parts.end(), [&](const Span& line) {
    return part(r.program.text, line).find(parameter) != std::string_view::npos;
  });
}

/// The value of the parameter `name` in the block; empty if it is not a plain number.
std::optional<ParameterWord> parameter_of(std::string_view name, const KlartextBlock& block,
                                          const KlartextReading& r) {
  const std::string_view text = r.program.text;
  for (const Span& line : block.parts) {
    const std::size_t found = part(text, line).find(name);
    if (found == std::string_view::npos) continue;
    const std::size_t equals = text.find_first_not_of(" \t", line.begin + found + name.size());
    if (equals >= line.end || text[equals] != '=') return std::nullopt;
    const std::size_t begin = text.find_first_not_of(" \t", equals + 1);
    const std::size_t end = std::min(text.find_first_of(" \t\r\n;~", begin), line.end);
    if (begin >= end) return std::nullopt;
    std::string number(part(text, {begin, end}));
    std::replace(number.begin(), number.end(), ',', '.');
    const std::optional<double> value = read_number(number);
    if (!value || std::abs(*value) > 99999.9999 || number.find_first_of("eE") != std::string::npos)
      return std::nullopt;
    const std::size_t point = std::min(number.find('.'), number.size() - 1);
    return ParameterWord{*value * mm_per(r.state.unit.value_or(LengthUnit::millimetres)),
                         {{begin, end}, static_cast<int>(number.size() - 1 - point)}};
  }
  return std::nullopt;
}

std::optional<KlartextSurface> surface_of(const KlartextBlock& block, const KlartextReading& r) {
  const auto found = parameter_of("Q203", block, r);
  if (!found) return std::nullopt;
  return KlartextSurface{found->value_mm, found->word, true};
}

/// Whether Q206 is the feed of a plunge: not for boring upwards, milling of holes, and tapping with the feed
/// of the spindle.
bool plunges(int cycle) {
  return counts_from_surface(cycle) && cycle != 204 && cycle != 207 && cycle != bore_milling && cycle != 209;
}

/// Q206 of the block, in mm/min.
void read_plunging_feed(const KlartextBlock& block, KlartextReading& r) {
  const auto found = parameter_of("Q206", block, r);
  const bool known = found && r.state.unit == LengthUnit::millimetres && r.state.feed_per_turn == false;
  r.state.plunging_feed_mm_min = known ? std::max(found->value_mm, 0.0) : 0;
}

/// Q200, Q201 and Q204 of the block.
void read_heights(const KlartextBlock& block, KlartextReading& r, bool followed) {
  const auto read = [&](std::string_view name, std::optional<double>& height_mm) {
    if (!names(block, name, r)) return;
    const auto found = parameter_of(name, block, r);
    height_mm = followed && found ? std::optional(found->value_mm) : std::nullopt;
  };
  read("Q200", r.state.clearance_mm);
  read("Q201", r.state.depth_mm);
  read("Q204", r.state.second_clearance_mm);
}

/// Whether Q201 is not the depth: a centring to a diameter (Q343), or one of which this is not known.
bool centres_to_diameter(int cycle, const KlartextBlock& block, const KlartextReading& r) {
  if (cycle != 240 || !names(block, "Q343", r)) return false;
  const auto selection = parameter_of("Q343", block, r);
  return !selection || selection->value_mm != 0;
}

/// The heights of the hole at the end of a move. They are not words of its block.
CalledCycle called_cycle(const KlartextState& state, const KlartextSurface& surface, double end_mm) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  CalledCycle cycle;
  cycle.heights_mm = {surface.z_mm, end_mm, state.depth_mm ? surface.z_mm + *state.depth_mm : unknown,
                      unknown};
  return cycle;
}

/// The words behind the number in the line of an old cycle. Empty if one of them is unknown.
bool lex_cycle_words(const KlartextBlock& block, std::size_t begin, KlartextReading& r) {
  KlartextBlock words = block;
  words.head.clear();
  words.parts[0].begin = begin;
  return read_words(words, r);
}

/// "SCL1", "SCL1.000".
bool is_scale_of_one(std::string_view rest) {
  const std::size_t digit = std::min(rest.find_first_of("0123456789"), rest.size());
  return read_number(rest.substr(digit)) == 1.0;
}

/// Mirror, scale, tilt: active unless the words are neutral.
void turn_coordinates(const KlartextBlock& block, const CycleNumber& number, KlartextReading& r) {
  const std::string rest = squeezed(part(r.program.text, {number.end, block.parts[0].end}));
  if (number.cycle == 10) return turn_frame(block, rest, r);
  bool acts = rest.find_first_of("Q123456789") != std::string::npos;
  if (number.cycle == 8 || number.cycle == 26) acts = !rest.empty();
  if (number.cycle == 11) acts = !is_scale_of_one(rest);
  set_displacement(r, number.cycle, acts, "mirrored, scaled or tilted coordinates");
}

void define_cycle(const KlartextBlock& block, KlartextReading& r) {
  const CycleNumber number = number_of(r.program.text, block);
  const int cycle = number.cycle;
  if (cycle == 7 && number.line > 0) return shift_datum(block, lex_cycle_words(block, number.end, r), r);
  if ((cycle == 8 || cycle == 10 || cycle == 11 || cycle == 19 || cycle == 26) && number.line > 0)
    return turn_coordinates(block, number, r);
  if (cycle == 247) return define_preset(block, r);
  if (cycle == 220 || cycle == 221 || cycle == 224)
    return add_unfollowed_move(block, r, "patterns of cycles are not corrected");
  if (!acts_when_called(cycle)) {
    forget_klartext_speeds(r.state);
    add_unfollowed_move(block, r, fmt::format("CYCL DEF {} is not supported", cycle));
  }
  if (cycle == 32 && number.line == 1)
    add_remark(r.program, line_of_file(r.program.expansion, block.line),
               fmt::format("CYCL DEF 32{}: the control smooths the path; corrections smaller than its "
                           "tolerance can vanish",
                           part(r.program.text, {number.end - 2, block.parts[0].end})));
  if (cycle == 12 && number.line == 1)  // PGM CALL
    assume_of_calls(r.program, line_of_file(r.program.expansion, block.line));
  const bool state_only = cycle == 7 || cycle == 8 || cycle == 9 || cycle == 10 || cycle == 11 ||
                          cycle == 13 || cycle == 19 || cycle == 26 || cycle == 32;
  if (state_only || number.line != 0) return;
  r.state.calls_each = false;  // a new cycle ends M89
  r.state.cycle_acts_here = stays_where_called(cycle);
  r.state.surface.reset();
  const bool runs_once = !may_not_run(block, r);
  r.state.cycle_is_relative = counts_from_tool(cycle) && r.state.tool_along_z && runs_once;
  r.state.cycle_returns = returns_to_start(cycle);
  r.state.takes_surface = counts_from_surface(cycle) && runs_once;
  r.state.cycle_mills = cycle == bore_milling;
  r.state.clearance_mm.reset();
  r.state.second_clearance_mm.reset();
  r.state.depth_mm.reset();
  r.state.plunging_feed_mm_min = 0;
  if (!r.state.takes_surface) return;
  if (plunges(cycle)) read_plunging_feed(block, r);
  r.state.surface = surface_of(block, r);
  if (r.state.surface) r.state.surface->of_definition = true;
  read_heights(block, r, true);
  if (centres_to_diameter(cycle, block, r)) r.state.depth_mm.reset();
}

}  // namespace

bool take_hole(KlartextReading& r, Move& move) {
  KlartextState& state = r.state;
  const bool rigid = state.surface && state.tool_along_z && !move.block_delete && !move.arc &&
                     move.group == 0 && !move.words[2] && !move.fixed[0] && !move.fixed[1] && !move.fixed[2];
  if (!rigid) {
    state.surface.reset();
    return false;
  }
  KlartextSurface& surface = *state.surface;
  const bool end_is_known = state.clearance_mm && state.second_clearance_mm;
  move.may_split = move.may_jump = false;
  move.makes_hole = move.takes_no_z = true;
  move.mills_at_end = state.cycle_mills;
  move.motion = Motion::rapid;  // the path to a hole is a rapid, as with the cycles of G-code
  move.feed_mm_min = state.plunging_feed_mm_min;
  if (!end_is_known) move.handling = Handling::held;
  const bool first = std::exchange(surface.just_set, false);
  // The whole definition could be repeated before a hole, but it would end M89 and set its other parameters
  // again.
  if (first || !surface.of_definition || (surface.repeatable && !state.calls_each)) {
    // The word of the surface is absolute.
    for (std::size_t axis = 0; axis < 2; ++axis)
      if (move.relative && move.words[axis]) move.incremental = (move.incremental | 1U << axis) & 7U;
    move.relative = false;
    move.words[2] = surface.word;
    move.repeats_surface = !first;
  }
  move.end_mm.z() = surface.z_mm;
  move.known_end[2] = state.known[2] = end_is_known;
  if (!end_is_known) return true;
  state.position_mm.z() = surface.z_mm + std::max(*state.clearance_mm, *state.second_clearance_mm);
  move.called = called_cycle(state, surface, state.position_mm.z());
  return true;
}

void read_cycle_parameter(const KlartextBlock& block, KlartextReading& r) {
  const bool followed = r.state.takes_surface && !may_not_run(block, r) && r.state.displacements.empty();
  read_heights(block, r, followed);
  if (r.state.plunging_feed_mm_min > 0 && names(block, "Q206", r)) {
    if (followed)
      read_plunging_feed(block, r);
    else
      r.state.plunging_feed_mm_min = 0;
  }
  if (part(r.program.text, block.parts[0]).find("203") == std::string_view::npos) return;
  r.state.surface = followed ? surface_of(block, r) : std::nullopt;
}

void read_klartext_cycle(const KlartextBlock& block, KlartextReading& r) {
  const std::string rest = squeezed(after_head(r.program.text, block));
  if (rest.starts_with("DEF")) return define_cycle(block, r);
  const bool here = rest == "CALL" || (rest.starts_with("CALLM") && rest.size() > 5);
  if (here) return add_cycle_call(block, r);
  add_unfollowed_move(block, r, "cycles are not corrected");
}

}  // namespace counterflex
