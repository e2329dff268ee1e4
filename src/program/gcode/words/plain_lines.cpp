#include "program/gcode/words/plain_lines.hpp"

#include <limits>

#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/words/modal_words.hpp"
#include "program/gcode/words/plain_words.hpp"
#include "program/text/line_length.hpp"

namespace counterflex {
namespace {

/// Remarks begin at this length; such lines are not plain.
std::size_t longest_without_remark(const Dialect& dialect) {
  return dialect.line_limit == 0 ? std::numeric_limits<std::size_t>::max()
                                 : dialect.line_limit - room_for_words;
}

bool is_straight(MotionMode motion) {
  return motion == MotionMode::rapid || motion == MotionMode::feed;
}

bool is_arc(MotionMode motion) {
  return motion == MotionMode::clockwise || motion == MotionMode::counter_clockwise;
}

/// Reads lines one by one into moves. Values that blocks share are computed once.
class PlainReader {
 public:
  PlainReader(Reading& reading, Block& block)
      : r_(reading),
        block_(block),
        text_(reading.program.text.data()),
        longest_(longest_without_remark(reading.dialect)),
        unit_mm_(mm_per(*reading.state.unit)) {}

  /// Reads the next line. False, without effect, if the line is not plain.
  bool read_line() {
    const std::size_t begin = block_.line_end.end;
    const char* const end = scan_words(text_ + begin, words_);
    if (end == nullptr || !words_.has_axis() || !is_valid_here()) return false;
    const std::size_t line_end = *end == '\r' ? 1 : 0;
    const Span span{begin, static_cast<std::size_t>(end - text_)};
    if (end[line_end] != '\n' || span.end - span.begin > longest_) return false;
    block_.span = span;
    block_.line_end = {span.end, span.end + line_end + 1};
    block_.line = ++block_.text_line;
    add_move();
    return true;
  }

 private:
  /// Behind arcs the line must have its motion word. Under G91 the axis must be known. A negative feed is an
  /// error.
  bool is_valid_here() const {
    if (!words_.has(PlainWord::code) && !is_straight(r_.state.motion)) return false;
    if (words_.has(PlainWord::feed) && *number(PlainWord::feed).begin == '-') return false;
    if (!r_.state.relative || all_known(r_.state.known)) return true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (words_.has(static_cast<PlainWord>(axis)) && !r_.state.known[axis]) return false;
    return true;
  }

  const PlainNumber& number(PlainWord word) const { return words_.numbers[static_cast<std::size_t>(word)]; }

  void set_modes() {
    ModalState& state = r_.state;
    ++r_.program.block_count;
    if (words_.has(PlainWord::code)) state.motion = words_.code == 0 ? MotionMode::rapid : MotionMode::feed;
    if (!words_.has(PlainWord::feed)) return;
    set_feed(r_, number(PlainWord::feed).value, unit_of_feed(r_));
  }

  void add_move() {
    r_.feed_before_mm_min = feed_mm_min(r_);
    set_modes();
    Move& move = begin_move(block_, r_, r_.state.motion == MotionMode::feed ? Motion::feed : Motion::rapid);
    if (words_.has(PlainWord::number)) move.block_number = static_cast<long>(words_.block_number);
    move.end_mm = r_.state.position_mm;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (words_.has(static_cast<PlainWord>(axis))) place(axis, move);
    move.known_end = r_.state.known;
    allow_plain_changes(r_, move);
  }

  void place(std::size_t axis, Move& move) {
    const PlainNumber& number = words_.numbers[axis];
    const auto begin = static_cast<std::size_t>(number.begin - text_);
    move.words[axis] = AxisWord{{begin, static_cast<std::size_t>(number.end - text_)}, number.decimals};
    const double value = number.value * unit_mm_;
    const double end = r_.state.relative ? coordinate(move.start_mm, axis) + value : value;
    // Stored twice: a copy of all three would wait for the stores.
    coordinate(move.end_mm, axis) = coordinate(r_.state.position_mm, axis) = end;
    if (!r_.state.known[axis]) r_.state.known[axis] = true;  // a byte just stored delays the copy of all
  }

  Reading& r_;
  Block& block_;
  PlainWords words_;
  const char* const text_;
  const std::size_t longest_;
  const double unit_mm_;
};

}  // namespace

bool takes_plain_lines(const Reading& r) {
  const ModalState& state = r.state;
  const bool moves = is_straight(state.motion) || is_arc(state.motion);
  const bool followed = state.unit && !state.turns_tool && state.unknown_modes == 0 && state.displaced == 0 &&
                        !r.in_body() && !state.entering_data && !r.called && state.untravelled_mm.isZero(0);
  const bool alone = state.contour == Contour::none && !r.after_corner;
  const bool in_place = r.program.expansion.lines.empty() && r.program.expansion.unused.empty();
  const bool increments =
      r.options.integer_words == IntegerWords::increments && r.dialect.integer_words_ambiguous;
  return moves && followed && alone && in_place && !increments && state.feed_mode != FeedUnit::inverse_time;
}

std::size_t read_plain_lines(Reading& reading, Block& block, std::size_t most_moves) {
  PlainReader lines(reading, block);
  std::size_t count = 0;
  while (reading.program.moves.size() < most_moves && lines.read_line()) ++count;
  return count;
}

}  // namespace counterflex
