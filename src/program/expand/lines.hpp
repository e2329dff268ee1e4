#pragma once
/// A text that is put together of lines of a file, and where they come from.
#include <string>
#include <string_view>
#include <vector>

#include "program/text/lex.hpp"

namespace counterflex {

struct ExpandedLines {
  std::string text;
  std::string line_end;  ///< for lines that have none, as soon as another follows
  int count = 0;
  std::vector<LineRun> runs{};

  /// A line with its end, or the rest of the file.
  void append(std::string_view line, int line_of_file, int called_from);
};

/// How far the lines had come.
struct LinesMark {
  std::size_t text, runs;
  int count;
};
LinesMark mark_of(const ExpandedLines& lines);
void take_back(const LinesMark& mark, ExpandedLines& lines);

/// The lines of `text` from `at` on, up to the line that begins at `end`, as they are.
void append_lines(std::string_view text, std::size_t at, int line, std::size_t end, ExpandedLines& lines);

/// "\r\n" where the first line ends so, else "\n".
std::string line_end_of(std::string_view text);

/// The block without these bytes and the blanks behind them, with its line end; empty where nothing is left.
std::string line_without(std::string_view text, const Dialect& dialect, const Block& block,
                         std::vector<Span> dropped);

}  // namespace counterflex
