#pragma once
/// What of a block of Klartext correction never changes.
#include <string>
#include <string_view>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// As `kept_words`, of a program in Klartext.
std::string klartext_kept_words(const Program& program, const Move& move);

/// As `line_kept_words`: without the number of the block, and nothing of a CC (`ActingWords`).
std::string klartext_line_kept_words(std::string_view line);

/// The CC that acts behind a line without a move, where `before` acts before it.
std::string klartext_pole_behind(std::string_view line, std::string before);

/// Whether the path of `move` depends on a CC and is not followed. Correction changes neither of their
/// blocks.
bool needs_klartext_pole(std::string_view text, const Move& move);

}  // namespace counterflex
