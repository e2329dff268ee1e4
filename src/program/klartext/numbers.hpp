#pragma once
/// The numbers of Klartext blocks.
#include <optional>
#include <string>

namespace counterflex {

/// The numbers of the written blocks.
struct WrittenNumbers {
  std::optional<unsigned long> last{};
  bool renumbers = false;  ///< a block was inserted: those behind it count on from `last`
  bool ended = false;      ///< END PGM: what follows is another program
};

/// `text`, which follows blocks with `numbers`, up to END PGM numbered on from the last of them, or from its first
/// number on, where `numbers` says so; else as it is. Moves `numbers` on.
std::string renumbered_klartext(const std::string& text, WrittenNumbers& numbers);

}  // namespace counterflex
