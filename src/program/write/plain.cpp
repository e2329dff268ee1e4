#include "program/write/plain.hpp"

#include <algorithm>
#include <cstring>

#include "program/dialect.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"
#include "program/write/text_position.hpp"

namespace counterflex {
namespace {

/// A number to be written.
struct NewNumber {
  Span span;
  std::int64_t steps;
  int decimals, least_decimals;
};

/// The numbers of a block, in the order of the text, and the position after it.
struct PlainEdit {
  std::array<NewNumber, 3> numbers;
  std::size_t count = 0;
  std::array<double, 3> position_mm;
};

/// Whether the coordinates of the words alone determine the end of the move, and words keep their number of
/// digits: those of G92 may get more.
bool is_plain_move(const Move& move) {
  return !move.arc && !move.cycle && !move.called && move.angle_axis == 0 && !move.relative &&
         move.incremental == 0 && !move.orientation && !move.block_delete &&
         move.handling != Handling::held && !move.fixed[0] && !move.fixed[1] && !move.fixed[2] &&
         all_known(move.known_end);
}

/// A digit first, or a minus and a digit: no plus, and a zero before the decimal point.
bool is_in_plain_style(const std::string& text, Span number) {
  return is_digit(text[text[number.begin] == '-' ? number.begin + 1 : number.begin]);
}

int decimals_for(const PlainRewriting& common, const Move& move, int shown) {
  return common.decimals >= 0 ? common.decimals : std::max(resolution_decimals(move.unit), shown);
}

/// As `round_axis` for a block with a word for the axis.
bool round_word(const PlainRewriting& common, const Move& move, std::size_t axis, double wanted_mm,
                PlainEdit& edit) {
  const AxisWord word = *move.words[axis];
  const double end_mm = component(move.end_mm, axis), wanted = in_unit(wanted_mm, move.unit);
  const int decimals = decimals_for(common, move, word.decimals);
  edit.position_mm[axis] = end_mm;
  if (rounds_to(in_unit(end_mm, move.unit), wanted, decimals)) return true;
  const std::optional<double> steps = whole_steps(wanted, decimals);
  const bool in_order = edit.count == 0 || edit.numbers[edit.count - 1].span.end < word.number.begin;
  if (!steps || !in_order || !is_in_plain_style(common.program.text, word.number)) return false;
  edit.position_mm[axis] = value_of_steps(*steps, decimals) * mm_per(move.unit);
  edit.numbers[edit.count++] = {word.number, static_cast<std::int64_t>(*steps), decimals,
                                std::min(word.decimals, decimals)};
  return true;
}

/// As `round_axis` for a block without a word, if no word is inserted.
bool round_no_word(const PlainRewriting& common, const Move& move, std::size_t axis, double wanted_mm,
                   const TextPosition& position, PlainEdit& edit) {
  if (!move.known_start[axis] || !position[axis]) return false;
  edit.position_mm[axis] = *position[axis];
  return move.ignored[axis] || !move.may_insert_words ||
         rounds_to(in_unit(*position[axis], move.unit), in_unit(wanted_mm, move.unit),
                   decimals_for(common, move, 0));
}

bool round_words(const PlainRewriting& common, const MoveEdit& to, const TextPosition& position,
                 PlainEdit& edit) {
  const Move& move = common.program.moves[to.move];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double wanted_mm = component(to.end_mm, axis);
    if (!(move.words[axis] ? round_word(common, move, axis, wanted_mm, edit)
                           : round_no_word(common, move, axis, wanted_mm, position, edit)))
      return false;
  }
  return edit.count == 0 || !common.integers_ambiguous;
}

constexpr std::size_t most_digits = 32, at_once = 16;

/// Copies at least the bytes [begin, end) to `to`, which has space for more, and returns their end.
char* copy_short(const std::string& text, std::size_t begin, std::size_t end, char* to) {
  const bool short_enough = end - begin <= at_once && begin + at_once <= text.size();
  std::memcpy(to, text.data() + begin, short_enough ? at_once : end - begin);
  return to + (end - begin);
}

char* put_number(const NewNumber& number, char* to) {
  to = put_steps(number.steps, number.decimals, to);
  for (int more = number.decimals - number.least_decimals; more > 0 && to[-1] == '0'; --more) --to;
  return to;
}

/// The text from `begin` to `end` with its new numbers; nullptr if the buffer is too small.
template <std::size_t size>
char* put_text(const std::string& text, Span span, const PlainEdit& edit, std::array<char, size>& buffer) {
  if (span.end - span.begin + 3 * most_digits + at_once > size) return nullptr;
  char* to = buffer.data();
  std::size_t at = span.begin;
  for (std::size_t i = 0; i < edit.count; ++i) {
    const NewNumber& number = edit.numbers[i];
    to = put_number(number, copy_short(text, at, number.span.begin, to));
    at = number.span.end;
  }
  return copy_short(text, at, span.end, to);
}

}  // namespace

PlainRewriting::PlainRewriting(const Program& window, const WriteOptions& options)
    : program(window), decimals(options.decimals) {
  const Dialect& dialect = *find_dialect(window.dialect);
  line_limit = dialect.line_limit;
  integers_ambiguous = dialect.integer_words_ambiguous && window.integer_words == IntegerWords::unspecified;
}

bool append_plain_block(const PlainRewriting& common, const MoveEdit& to, std::size_t copied,
                        TextPosition& position, Rewritten& out) {
  const Move& move = common.program.moves[to.move];
  if (to.jump || !to.inserted.empty() || !is_plain_move(move)) return false;
  PlainEdit edit;
  if (!round_words(common, to, position, edit)) return false;
  std::array<char, 256> buffer;
  const char* const end = put_text(common.program.text, {copied, move.block.end}, edit, buffer);
  if (end == nullptr) return false;
  const auto size = static_cast<std::size_t>(end - buffer.data());
  if (common.line_limit > 0 && size - (move.block.begin - copied) > common.line_limit) return false;
  out.text.append(buffer.data(), size);
  out.changed_words += edit.count;
  for (std::size_t axis = 0; axis < 3; ++axis) position[axis] = edit.position_mm[axis];
  return true;
}

}  // namespace counterflex
