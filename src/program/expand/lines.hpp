#pragma once
/// A text composed of lines of a file, and the origin of these lines.
#include <string>
#include <string_view>
#include <vector>

#include "program/text/lex.hpp"

namespace counterflex {

struct ExpandedLines {
  std::string text;
  std::string line_end;  ///< appended to a line without a line end, if another line follows
  int count = 0;
  std::vector<LineRun> runs{};

  /// A line with its end, or the rest of the file.
  void append(std::string_view line, int line_of_file, int called_from);
};

/// A position in the composed text, to which it can be reset.
struct LinesMark {
  std::size_t text, runs;
  int count;
};
LinesMark mark_of(const ExpandedLines& lines);
void truncate_to(const LinesMark& mark, ExpandedLines& lines);

/// The lines of `text` from `at` to the line that begins at `end`, unchanged.
void append_lines(std::string_view text, std::size_t at, int line, std::size_t end, ExpandedLines& lines);

/// The lines of a file, of which the last one may have no line end.
int count_lines(std::string_view text);

/// The block with its line end.
std::string_view whole_line(std::string_view text, const Block& block);

/// "\r\n" if the first line ends with it, else "\n".
std::string line_end_of(std::string_view text);

/// The block without these bytes and the blanks behind them, with its line end; empty if only blanks remain.
std::string line_without(std::string_view text, const Dialect& dialect, const Block& block,
                         std::vector<Span> dropped);

}  // namespace counterflex
