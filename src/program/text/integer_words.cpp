#include "program/text/integer_words.hpp"

#include <fmt/format.h>

#include "counterflex/program/read_program.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// The axis word of the move that is a number without a point, as in the text; empty if there is no such word.
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

bool may_doubt_integers(const Program& program, const Dialect& dialect) {
  return dialect.integer_words_doubtful && program.integer_words == IntegerWords::unsaid;
}

std::string integer_question(std::string_view word) {
  return fmt::format("{} has no point: it may mean units or increments; say which with --integer-words units|increments",
                     word);
}

std::optional<Remark> integer_word_in_doubt(const Program& window, int line) {
  if (!may_doubt_integers(window, *find_dialect(window.dialect))) return std::nullopt;
  for (const Move& move : window.moves) {
    if (move.line > line) break;
    if (const std::string word = integer_word_of(window, move); !word.empty())
      return Remark{move.line, integer_question(word)};
  }
  return std::nullopt;
}

}  // namespace counterflex
