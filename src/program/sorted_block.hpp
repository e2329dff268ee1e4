#pragma once
/// The words of one block by what they are, checked against each other.
#include <array>
#include <vector>

#include "program/codes.hpp"
#include "program/lex.hpp"

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

/// Points into the `Block` it was sorted from.
struct SortedBlock {
  std::array<const Word*, 26> letters{};  ///< all but G and M
  std::vector<FoundG> g;
  std::vector<FoundM> m;

  const Word* word(char letter) const { return letters[static_cast<std::size_t>(letter - 'A')]; }
  const FoundG* find(Action action) const;
  bool has(Action action) const { return find(action) != nullptr; }
  bool has(MAction action) const;
};

/// Sorts `block` into `sorted`, whose vectors are reused. Throws `InputError` for words that are not known or
/// not read yet, that stand twice, exclude each other, or that nothing in the block uses.
void sort_words(const std::string& file, const Dialect& dialect, const Block& block, SortedBlock& sorted);

}  // namespace counterflex
