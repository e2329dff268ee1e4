#pragma once
/// Block numbers (N words) that a program uses, and numbers that are free for inserted pieces.
#include <cstdint>
#include <string_view>
#include <vector>

namespace counterflex {

/// All numbers behind an N in the text of a program, also in comments and jumps. No inserted block may get
/// one of them.
class BlockNumbers {
 public:
  /// Adds the next whole lines of the program.
  void add(std::string_view lines);

  /// Call it once, after the last line.
  void finish();

  /// Whether the program uses none of the `count` numbers that follow `number`. False for a number that
  /// begins several blocks: their pieces would share numbers.
  bool has_room_after(long number, std::size_t count) const;

 private:
  std::vector<std::uint32_t> used_;      ///< sorted, each once
  std::vector<std::uint32_t> repeated_;  ///< sorted; first the numbers at the beginning of each line
};

}  // namespace counterflex
