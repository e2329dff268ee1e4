#pragma once
/// Numbers of Klartext blocks.
#include <optional>
#include <string>

namespace counterflex {

/// State of the numbers of the written blocks.
struct WrittenNumbers {
  std::optional<unsigned long> last{};
  bool renumbers = false;  ///< a block was inserted: the blocks behind it are numbered from `last` on
  bool ended = false;      ///< END PGM was written: the following text is another program
};

/// Renumbers `text`, which follows the blocks of `numbers`, up to END PGM. If `numbers.renumbers`, the
/// numbers continue from the last block, or start with the first number of the text; else the text does not
/// change. Updates `numbers`.
std::string renumbered_klartext(const std::string& text, WrittenNumbers& numbers);

}  // namespace counterflex
