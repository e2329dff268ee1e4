#pragma once
/// The numbers of Klartext blocks.
#include <string>

#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// `text`, which follows blocks with `numbers`, up to END PGM numbered on from the last of them, or from its first
/// number on, where `numbers` says so; else as it is. Moves `numbers` on.
std::string renumbered_klartext(const std::string& text, WrittenNumbers& numbers);

}  // namespace counterflex
