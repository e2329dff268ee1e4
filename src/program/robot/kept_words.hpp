#pragma once
/// What of a statement of a robot program correction never changes.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// How the statements of a language are compared.
struct StatementForm {
  std::string_view comment_mark;   ///< begins a comment
  bool has_named_numbers = false;  ///< "{X 1, Y 2}": a number follows its name
  bool may_lack_numbers = false;   ///< a target may get numbers that it does not have
  std::vector<Span> ignored{};     ///< other parts of the statement that a correction may change
  std::optional<Span> replaced{};  ///< a target of another form, which `replacement` may replace
  std::string_view replacement{};  ///< without numbers
};

/// Before the words of the auxiliary point of an arc.
constexpr char auxiliary_mark = '|';

/// The numbers that correction changes in the target of `move`, in the order of the text.
std::vector<Span> target_numbers(const Move& move);

/// The numbers that correction changes in the auxiliary point of the arc of `move`, in the order of the text.
std::vector<Span> auxiliary_numbers(const Move& move);

/// The statement of `move` without the comment of its line: copies of the statement have none.
std::string_view statement_without_comment(const Program& program, const Move& move,
                                           std::string_view comment_mark);

/// `text` without blanks and line ends.
std::string without_spaces(std::string_view text);

/// The bytes `within` of `text` without blanks and without `spans`, which are in the order of the text.
std::string words_without(std::string_view text, Span within, const std::vector<Span>& spans);

/// The same of a text that declares a target with `numbers`, or a part of it.
std::string target_kept_words(std::string_view text, Span within, const std::vector<Span>& numbers,
                              const StatementForm& form);

/// As `kept_words`, of a language that writes targets as KUKA, ABB or Universal Robots do, in brackets or by
/// names. A target that is declared elsewhere takes the place of its name.
std::string statement_kept_words(const Program& program, const Move& move, const StatementForm& form);

}  // namespace counterflex
