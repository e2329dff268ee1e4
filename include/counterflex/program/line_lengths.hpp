#pragma once
/// Lengths of the lines of a program, compared with the limit of the control.
#include <cstddef>
#include <string_view>

namespace counterflex {

struct LineLengths {
  std::size_t limit = 0;    ///< characters of a line that the control reads; 0: no limit is known
  std::size_t longest = 0;  ///< length of the longest line, counted as the control counts it
  int longest_line = 0;
  std::size_t near = 0;  ///< number of lines longer than 90 % of the limit
  int first_near = 0;
  int lines = 0;  ///< number of lines measured so far
};

/// Measures the next lines of a text in `dialect`. Counts nothing for a dialect without a limit. `text` is
/// whole lines; only the last line of the program may lack a line end. Does not allocate.
void add_lines(LineLengths& lengths, std::string_view text, std::string_view dialect);

/// Measures a whole text.
LineLengths line_lengths(std::string_view text, std::string_view dialect);

}  // namespace counterflex
