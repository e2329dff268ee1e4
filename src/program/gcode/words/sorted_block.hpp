#pragma once
/// The words of a block sorted by kind, and checked against each other.
#include <array>
#include <cstdint>
#include <vector>

#include "program/gcode/words/codes.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

struct FoundG {
  const GCode* code;
  const Word* word;
};

struct FoundM {
  MAction action;
  int code;
  const Word* word;
};

/// Points into the `Block` from which it was sorted.
struct SortedBlock {
  std::array<const Word*, 26> letters{};  ///< all letters except G and M, valid for those in `present`
  std::uint32_t present = 0;              ///< a bit for each letter
  std::vector<FoundG> g;
  std::vector<FoundM> m;
  std::uint64_t actions = 0;    ///< a bit for each Action in `g`
  std::uint32_t m_actions = 0;  ///< a bit for each MAction in `m`
  bool unknown_code = false;    ///< has a G or M whose number is an expression

  const Word* word(char letter) const {
    const auto i = static_cast<std::size_t>(letter - 'A');
    return (present >> i & 1) != 0 ? letters[i] : nullptr;
  }
  bool has_any(std::string_view wanted) const;
  const FoundG* find(Action action) const;
  bool has(Action action) const { return (actions >> static_cast<unsigned>(action) & 1) != 0; }
  bool has(MAction action) const { return (m_actions >> static_cast<unsigned>(action) & 1) != 0; }
};

/// Letters that a block may have in addition to those of its codes.
enum class Context { plain, arc, cycle, unknown };

/// Sorts `block` into `sorted` and reuses its vectors. `context` is the active motion if the block programs
/// no motion. Throws `InputError` for words that are unknown or not supported, occur twice, exclude each
/// other, or are not used by a code of the block.
void sort_words(const std::string& file, const Dialect& dialect, const Block& block, Context context,
                SortedBlock& sorted);

}  // namespace counterflex
