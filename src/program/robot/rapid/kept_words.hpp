#pragma once
/// What of a statement of RAPID a correction may change besides its numbers.
#include <string_view>

#include "program/robot/kept_words.hpp"

namespace counterflex {

/// Adds to `form` what Offs and RelTool have around the target that they displace: a corrected target is a
/// list with all its numbers.
void describe_rapid_statement(std::string_view text, const Move& move, StatementForm& form);

}  // namespace counterflex
