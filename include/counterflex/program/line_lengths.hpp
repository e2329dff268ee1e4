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
  int lines = 0;  ///< measured so far
};

/// Measures the next lines of a text, written in the dialect of that name; counts nothing for a dialect
/// without a limit. `text` is whole lines: only the last of all may lack a line end. Does not allocate.
void add_lines(LineLengths& lengths, std::string_view text, std::string_view dialect);

/// Of the whole text.
LineLengths line_lengths(std::string_view text, std::string_view dialect);

}  // namespace counterflex
