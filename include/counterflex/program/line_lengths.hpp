#pragma once
/// How long the lines of a program are, beside what its control reads.
#include <cstddef>
#include <string_view>

namespace counterflex {

struct LineLengths {
  std::size_t limit = 0;    ///< characters that the dialect's control reads of a line; 0: none known
  std::size_t longest = 0;  ///< characters that count towards it, of the longest line
  int longest_line = 0;
  std::size_t near = 0;  ///< lines with more than 90 % of the limit
  int first_near = 0;
};

/// Measures the lines of `text`, written in the dialect of that name; nothing but zeros for a dialect without
/// a limit. Does not allocate.
LineLengths line_lengths(std::string_view text, std::string_view dialect);

}  // namespace counterflex
