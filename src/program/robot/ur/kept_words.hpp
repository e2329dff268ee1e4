#pragma once
/// What of a statement of URScript a correction may change besides its numbers.
#include <string_view>

#include "program/robot/kept_words.hpp"

namespace counterflex {

/// Adds to `form`: the names of the target and of the blend radius, which positional arguments do not have;
/// the mode of movec, which may become movel; a target in joint values, which may become a pose.
void describe_ur_statement(std::string_view text, const Move& move, StatementForm& form);

}  // namespace counterflex
