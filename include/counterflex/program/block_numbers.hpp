#pragma once
/// Numbers of blocks (N words) that a program uses, and those that are free for inserted pieces.
#include <cstdint>
#include <string_view>
#include <vector>

namespace counterflex {

/// All numbers behind an N in the text of a program, in comments and jumps too: none of them may name a new
/// block.
class BlockNumbers {
 public:
  /// Adds the next whole lines of the program.
  void add(std::string_view lines);

  /// Call it once, after the last line.
  void finish();

  /// Whether `count` consecutive numbers follow `number` that the program does not use. False for a number
  /// that begins several blocks: their pieces would share numbers.
  bool has_room_after(long number, std::size_t count) const;

 private:
  std::vector<std::uint32_t> used_;     ///< sorted, each once
  std::vector<std::uint32_t> repeated_; ///< sorted; first the numbers at the beginning of each line
};

}  // namespace counterflex
