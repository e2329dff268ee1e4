#include "program/siemens/cycles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/files/text.hpp"
#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/remarks.hpp"
#include "program/gcode/words/modal_words.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 10> drilling_cycles{"CYCLE81", "CYCLE82", "CYCLE83", "CYCLE84",
                                                           "CYCLE85", "CYCLE86", "CYCLE87", "CYCLE88",
                                                           "CYCLE89", "CYCLE840"};

/// A cycle that mills around a centre: the index of the centre in the argument list, and the number of
/// arguments. Newer versions have longer lists, whose last arguments may make the depth a difference.
struct MillingCycle {
  std::string_view name;
  std::size_t centre, arguments;
};
constexpr std::array<MillingCycle, 10> milling_cycles{{{"POCKET1", 8, 20},
                                                       {"POCKET2", 6, 17},
                                                       {"POCKET3", 7, 23},
                                                       {"POCKET4", 5, 19},
                                                       {"SLOT1", 8, 25},
                                                       {"SLOT2", 8, 23},
                                                       {"LONGHOLE", 7, 15},
                                                       {"CYCLE71", 4, 16},
                                                       {"CYCLE76", 8, 20},
                                                       {"CYCLE77", 6, 16}}};

/// Without DPR: its place in the list has another argument.
constexpr auto without_depth_below = std::to_array<std::string_view>({"POCKET3", "POCKET4", "CYCLE71"});

constexpr std::string_view modal_call = "MCALL";

// Indices in the argument list.
constexpr std::size_t retract_plane = 0, reference_plane = 1, final_depth = 3, depth_below = 4,
                      first_depth = 5, bore_feed = 6;

/// The name of a call and the spans of its arguments, without blanks.
struct ArgumentList {
  std::string_view name;
  std::vector<Span> arguments;
};

Span trimmed(std::string_view text, Span span) {
  while (span.begin < span.end && is_blank(text[span.begin])) ++span.begin;
  while (span.end > span.begin && is_blank(text[span.end - 1])) --span.end;
  return span;
}

/// "CYCLE81(50, 0, 2, -20)" from `at` on; empty if the brackets do not enclose a plain list.
std::optional<ArgumentList> call_at(std::string_view text, std::size_t at, std::size_t end) {
  const std::size_t open = text.find('(', at), close = text.find(')', at);
  if (open >= end || close >= end) return std::nullopt;
  const Span name = trimmed(text, {at, open});
  ArgumentList call{part(text, name), {}};
  if (call.name.empty() ||
      text.substr(open + 1, close - open - 1).find_first_of("(\"") != std::string_view::npos)
    return std::nullopt;
  if (!empty(trimmed(text, {close + 1, end}))) return std::nullopt;
  for (std::size_t begin = open + 1; begin <= close;) {
    const std::size_t comma = std::min(text.find(',', begin), close);
    call.arguments.push_back(trimmed(text, {begin, comma}));
    begin = comma + 1;
  }
  return call;
}

bool is_plain(std::string_view number) {
  return !number.empty() && number.find_first_not_of("+-.0123456789") == std::string_view::npos &&
         read_number(number).has_value();
}

struct Argument {
  AxisWord word;
  double value;
};

/// The argument at `place`; empty if it is not a plain number.
std::optional<Argument> number_at(std::string_view text, const ArgumentList& call, std::size_t place) {
  const Span span = call.arguments[place];
  const std::string_view number = part(text, span);
  if (!is_plain(number)) return std::nullopt;
  const std::size_t point = number.find('.');
  const int decimals = point == std::string_view::npos ? 0 : static_cast<int>(number.size() - point - 1);
  if (decimals > most_decimals) return std::nullopt;
  return Argument{{span, decimals}, *read_number(number)};
}

/// DPR, the depth below the reference plane; empty if the list has none.
std::string_view depth_below_reference(std::string_view text, const ArgumentList& call) {
  if (depth_below >= call.arguments.size() || is_one_of(call.name, without_depth_below)) return {};
  return part(text, call.arguments[depth_below]);
}

/// Whether DPR has priority over DP: Siemens, SINUMERIK 840D Programming Manual Cycles, "Drilling, centering
/// - CYCLE81". Programs that use DP often give zero for DPR.
bool takes_depth_below(std::string_view text, const ArgumentList& call) {
  const std::string_view depth = depth_below_reference(text, call);
  return !depth.empty() && !(is_plain(depth) && read_number(depth) == 0.0);
}

/// The bottom by DPR as a height; NaN if it is not a plain number.
double height_below(std::string_view text, const ArgumentList& call, double reference_mm) {
  const std::string_view depth = depth_below_reference(text, call);
  return is_plain(depth) ? reference_mm - std::abs(*read_number(depth))
                         : std::numeric_limits<double>::quiet_NaN();
}

/// Indices of the arguments that newer controls append to a list: the drilling axis, the selection of the
/// depth
/// (_GMODE, then _DMODE for the plane and _AMODE for absolute heights or differences).
struct AppendedArguments {
  std::string_view name;
  std::size_t axis, selections;
};
constexpr std::size_t without_axis = 0;
constexpr auto appended_arguments = std::to_array<AppendedArguments>({{"CYCLE81", without_axis, 6},
                                                                      {"CYCLE82", without_axis, 6},
                                                                      {"CYCLE83", 12, 17},
                                                                      {"CYCLE84", 12, 21},
                                                                      {"CYCLE85", without_axis, 8},
                                                                      {"CYCLE86", without_axis, 11},
                                                                      {"CYCLE87", without_axis, 6},
                                                                      {"CYCLE88", without_axis, 7},
                                                                      {"CYCLE89", without_axis, 6},
                                                                      {"CYCLE840", 11, 17}});

/// Whether the argument at `place` is left out or one of `values`.
bool is_absent_or(std::string_view text, const ArgumentList& call, std::size_t place,
                  std::initializer_list<double> values) {
  if (place >= call.arguments.size() || empty(call.arguments[place])) return true;
  const auto argument = number_at(text, call, place);
  return argument && std::ranges::find(values, argument->value) != values.end();
}

/// Whether _AMODE takes each height as its place in the list does: 0 for both, 1 for DPR, 2 for DP, and for
/// CYCLE83 the same of the first depth in its tens.
bool agrees_with_heights(std::string_view text, const ArgumentList& call, std::size_t place) {
  if (is_absent_or(text, call, place, {0})) return true;
  const auto mode = number_at(text, call, place);
  if (!mode || mode->value < 0 || mode->value != std::floor(mode->value)) return false;
  const auto fits = [&](double digit, std::size_t absolute) {
    const bool has_absolute = !is_absent_or(text, call, absolute, {});
    const bool has_relative = !is_absent_or(text, call, absolute + 1, {0});
    return digit == 0 || (digit == 1 && !has_absolute && has_relative) ||
           (digit == 2 && has_absolute && !has_relative);
  };
  const double units = std::fmod(mode->value, 10), tens = std::fmod(std::floor(mode->value / 10), 10);
  return fits(units, final_depth) && (!is_word(call.name, "CYCLE83") || fits(tens, first_depth));
}

/// Whether the arguments that newer controls append leave the axis and the heights as the others give them:
/// Siemens, SINUMERIK 840D sl Programming Manual Job Planning, "Drilling, centering - CYCLE81".
bool has_plain_appendix(std::string_view text, const ArgumentList& call) {
  const auto known =
      std::find_if(appended_arguments.begin(), appended_arguments.end(),
                   [&](const AppendedArguments& cycle) { return is_word(call.name, cycle.name); });
  const std::size_t selections = known->selections;
  if (known->axis != without_axis && !is_absent_or(text, call, known->axis, {0, 3})) return false;
  for (std::size_t place = selections + 3; place < call.arguments.size(); ++place)
    if (!is_absent_or(text, call, place, {0})) return false;
  return is_absent_or(text, call, selections, {0}) && is_absent_or(text, call, selections + 1, {0, 1}) &&
         agrees_with_heights(text, call, selections + 2);
}

/// Fills `cycle` from the arguments; false if a height is not a plain number.
bool take_heights(std::string_view text, const ArgumentList& call, CalledCycle& cycle) {
  const bool pecks = is_word(call.name, "CYCLE83");
  std::size_t i = 0;
  for (const std::size_t place : {reference_plane, retract_plane, final_depth, first_depth}) {
    const std::size_t height = i++;
    if (place == first_depth && !pecks) continue;
    if (place == final_depth && takes_depth_below(text, call)) continue;
    const bool given = place < call.arguments.size() && !empty(call.arguments[place]);
    if (!given && (place == reference_plane || place == retract_plane)) return false;
    if (!given) continue;
    const auto argument = number_at(text, call, place);
    if (!argument) return false;
    cycle.heights[height] = argument->word;
    cycle.heights_mm[height] = argument->value;
  }
  if (!cycle.heights[2]) cycle.heights_mm[2] = height_below(text, call, cycle.heights_mm[0]);
  return true;
}

bool is_drilling(std::string_view name) {
  return std::any_of(drilling_cycles.begin(), drilling_cycles.end(),
                     [&](auto known) { return is_word(name, known); });
}

std::optional<CalledCycle> drilling_at(std::string_view text, Span span) {
  const auto call = call_at(text, span.begin, span.end);
  CalledCycle cycle;
  if (!call || !is_drilling(call->name) || !has_plain_appendix(text, *call)) return std::nullopt;
  if (!take_heights(text, *call, cycle)) return std::nullopt;
  return cycle;
}

/// Whether holes are drilled along Z in known coordinates.
bool drills_along_z(const Block& block, const Reading& r) {
  return empty(block.block_delete) && why_not_followed(r).empty() && r.state.normal == 2 &&
         r.state.unit == LengthUnit::millimetres && r.state.contour == Contour::none;
}

void stop_modal_cycle(Reading& r) {
  r.called.reset();
  r.state.displaced |= modal_macro;
}

/// The feed (mm/min) with which a call drills: F, or FFR of CYCLE85, which has the unit of F. 0: not known.
/// Taps follow the spindle.
double plunging_feed(std::string_view statement, const Reading& r, double feed_mm_min) {
  const auto call = call_at(statement, 0, statement.size());
  if (!call || is_word(call->name, "CYCLE84") || is_word(call->name, "CYCLE840")) return 0;
  if (!is_word(call->name, "CYCLE85")) return feed_mm_min;
  const auto unit = unit_of_feed(r);
  if (call->arguments.size() <= bore_feed || !unit || r.state.feed_mode != FeedUnit::per_minute) return 0;
  const auto feed = number_at(statement, *call, bore_feed);
  return feed ? std::max(feed->value, 0.0) * mm_per(*unit) : 0;
}

void make_hole(const CalledCycle& cycle, std::string_view statement, Reading& r, Move& move) {
  move.called = cycle;
  move.makes_hole = move.takes_no_z = true;
  move.motion = Motion::rapid;  // the path to a hole is a rapid, as with the cycles of G-code
  move.feed_mm_min = plunging_feed(statement, r, move.feed_mm_min);
  // The heights are absolute, also under G91.
  if (move.relative) move.incremental = 3;
  move.relative = false;
  move.words[2] = cycle.heights[0];
  if (!cycle.modal.empty())  // the number is not in this block, so it has no position here
    move.words[2] = AxisWord{{move.block.begin, move.block.begin + 1}, cycle.heights[0]->decimals};
  r.state.position_mm.z() = cycle.heights_mm[0];
  r.state.untravelled_mm.z() = 0;
  r.state.known[2] = true;
}

Move& start_call(const CalledCycle& cycle, const Block& block, Reading& r) {
  Move& move = start_move(block, r, Motion::rapid);
  for (const Word& word : block.words)
    if (word.letter == 'N') move.block_number = count_of(word);
  make_hole(cycle, part(r.program.text, block.statement_text), r, move);
  return move;
}

void end_call(const CalledCycle& cycle, Reading& r, Move& move) {
  finish_move(r, move);
  move.may_insert_words = move.may_jump = move.may_split = false;
  r.state.position_mm.z() = cycle.heights_mm[1];
}

struct MillingCall {
  CalledCycle cycle;
  std::array<Argument, 2> centre;
};

/// The call of a milling cycle whose centre and heights are plain numbers.
std::optional<MillingCall> milling_call(const Block& block, const Reading& r) {
  const std::string_view text = r.program.text;
  const auto call = call_at(text, block.statement_text.begin, block.statement_text.end);
  if (!call) return std::nullopt;
  const auto known = std::find_if(milling_cycles.begin(), milling_cycles.end(),
                                  [&](const MillingCycle& cycle) { return is_word(call->name, cycle.name); });
  if (known == milling_cycles.end()) return std::nullopt;
  const std::size_t given = call->arguments.size();
  if (given > known->arguments || given < known->centre + 2) return std::nullopt;
  MillingCall milling;
  const auto x = number_at(text, *call, known->centre), y = number_at(text, *call, known->centre + 1);
  if (!x || !y || !take_heights(text, *call, milling.cycle)) return std::nullopt;
  milling.cycle.line = block.line;
  milling.centre = {*x, *y};
  return milling;
}

/// Makes the call a move to the cycle's centre. The motions of the cycle about the centre are not corrected.
/// Its end in X and Y is not followed.
void mill(const MillingCall& milling, const Block& block, Reading& r) {
  Move& move = start_call(milling.cycle, block, r);
  move.makes_hole = false;
  move.mills_at_end = true;
  move.incremental = 0;
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    move.words[axis] = milling.centre[axis].word;
    r.state.position_mm[static_cast<Eigen::Index>(axis)] = milling.centre[axis].value;
    r.state.known[axis] = true;
  }
  end_call(milling.cycle, r, move);
  r.state.known[0] = r.state.known[1] = false;
  note_uncorrected(block, r, milled_as_a_whole);
}

}  // namespace

std::optional<CalledCycle> drilling_cycle(const Block& block, const Reading& r) {
  const std::string_view text = r.program.text;
  const Span statement = trimmed(text, block.statement_text);
  std::optional<CalledCycle> cycle;
  if (block.statement == Statement::modal_call)
    cycle = modal_drilling_cycle(part(text, statement));
  else
    cycle = drilling_at(text, statement);
  if (cycle) cycle->line = block.line;
  return cycle;
}

std::optional<CalledCycle> modal_drilling_cycle(std::string_view statement) {
  const std::string_view line = statement.substr(0, statement.find(';'));
  if (line.size() <= modal_call.size() || !is_word(line.substr(0, modal_call.size()), modal_call) ||
      !is_blank(line[modal_call.size()]))
    return std::nullopt;
  const Span call = trimmed(line, {modal_call.size(), line.size()});
  auto cycle = drilling_at(line, call);
  if (cycle) cycle->modal = std::string(line.substr(0, call.end));
  return cycle;
}

bool read_called_cycle(const Block& block, Reading& r) {
  if (r.called || !drills_along_z(block, r)) return false;
  const bool position_known = r.state.known[0] && r.state.known[1];
  if (const auto cycle = drilling_cycle(block, r); cycle && position_known) {
    Move& move = start_call(*cycle, block, r);
    move.may_position = r.state.motion == MotionMode::rapid && !r.state.relative;
    end_call(*cycle, r, move);
    return true;
  }
  const auto milling = milling_call(block, r);
  if (milling) mill(*milling, block, r);
  return milling.has_value();
}

bool begin_modal_cycle(const Block& block, Reading& r) {
  r.called.reset();
  if (!drills_along_z(block, r)) return false;
  r.called = drilling_cycle(block, r);
  return r.called.has_value();
}

bool takes_modal_hole(const Block& block, Reading& r) {
  const Word *x = r.sorted.word('X'), *y = r.sorted.word('Y');
  const auto comes_to = [&](const Word* word, std::size_t axis) {
    const bool given = word != nullptr && word->literal && !r.relative();
    return given || (r.state.known[axis] && (word == nullptr || word->literal));
  };
  const bool line = r.state.motion == MotionMode::rapid || r.state.motion == MotionMode::feed;
  const bool follows = drills_along_z(block, r) && line && r.sorted.word('Z') == nullptr &&
                       (x != nullptr || y != nullptr) && comes_to(x, 0) && comes_to(y, 1);
  if (!follows) stop_modal_cycle(r);
  return follows;
}

void place_modal_hole(Reading& r, Move& move) {
  make_hole(*r.called, std::string_view(r.called->modal).substr(modal_call.size()), r, move);
}

void end_called_hole(Reading& r) {
  Move& move = r.program.moves.back();
  move.may_jump = move.may_split = false;
  r.state.position_mm.z() = r.called->heights_mm[1];
  const bool goes =
      !move.known_start[0] || !move.known_start[1] || move.start_mm.head<2>() != move.end_mm.head<2>();
  // Above the surface it only positions the tool.
  const bool is_above = move.known_start[2] && move.start_mm.z() > r.called->heights_mm[0];
  if (r.state.motion != MotionMode::feed || !goes || is_above) return;
  r.last_reason = feed_to_hole;
  r.program.left_alone.push_back({move.line, r.last_reason, false, move.text_line, true});
}

}  // namespace counterflex
