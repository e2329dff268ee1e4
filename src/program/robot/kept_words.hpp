#pragma once
/// What of a statement of a robot program correction never changes.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// The numbers of the target of `move` in the order of the text.
std::vector<Span> target_numbers(const Move& move);

/// The statement of `move` without the comment of its line: copies of the statement have none.
std::string_view statement_without_comment(const Program& program, const Move& move,
                                           std::string_view comment_mark);

/// `text` without blanks and tabs.
std::string without_spaces(std::string_view text);

/// As `kept_words`, of a language that writes zones and targets as KUKA, ABB or Universal Robots do.
/// `comment_mark` begins a comment.
std::string statement_kept_words(const Program& program, const Move& move, std::string_view comment_mark);

}  // namespace counterflex
