#include "program/text/integer_words.hpp"

#include <fmt/format.h>

#include "counterflex/program/read_program.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// The axis word of the move that has no decimal point, as in the text; empty if there is no such word.
std::string integer_word_of(const Program& program, const Move& move) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!move.words[axis]) continue;
    const std::string_view number = part(program.text, move.words[axis]->number);
    const bool integer = number.find('.') == std::string_view::npos;
    if (integer && number.find_first_of("123456789") != std::string_view::npos)
      return fmt::format("{}{}", "XYZ"[axis], number);
  }
  return {};
}

}  // namespace

bool integers_may_be_ambiguous(const Program& program, const Dialect& dialect) {
  return dialect.integer_words_ambiguous && program.integer_words == IntegerWords::unspecified;
}

std::string integer_question(std::string_view word) {
  return fmt::format(
      "{} has no decimal point: it may mean units or increments; give --integer-words units or "
      "--integer-words increments",
      word);
}

std::optional<Remark> ambiguous_integer_word(const Program& window, int line) {
  if (!integers_may_be_ambiguous(window, *find_dialect(window.dialect))) return std::nullopt;
  for (const Move& move : window.moves) {
    if (move.line > line) break;
    if (const std::string word = integer_word_of(window, move); !word.empty())
      return Remark{move.line, integer_question(word)};
  }
  return std::nullopt;
}

}  // namespace counterflex
