#pragma once
/// Divides a program that has been read into windows, as from reading a file in parts.
#include <algorithm>
#include <vector>

#include "counterflex/program/program.hpp"

namespace counterflex::test {

/// Ends of the lines of `text`: after each line end, and the end of the text.
inline std::vector<std::size_t> line_ends_of(const std::string& text) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n' || i + 1 == text.size()) ends.push_back(i + 1);
  return ends;
}

/// Windows of at most `lines_each` lines.
inline std::vector<Program> windows_of(const Program& whole, int lines_each) {
  const std::vector<std::size_t> ends = line_ends_of(whole.text);
  const int lines = static_cast<int>(ends.size());
  std::vector<Program> windows;
  for (int first = 0; first < lines; first += lines_each) {
    const int last = std::min(first + lines_each, lines);
    const auto elsewhere = [&](const auto& item) { return item.line <= first || item.line > last; };
    Program& window = windows.emplace_back(whole);
    const std::size_t begin = first == 0 ? 0 : ends[static_cast<std::size_t>(first) - 1];
    window.text = whole.text.substr(begin, ends[static_cast<std::size_t>(last) - 1] - begin);
    std::erase_if(window.moves, elsewhere);
    std::erase_if(window.left_alone, elsewhere);
    std::erase_if(window.remarks, [&](const Remark& remark) { return remark.line > last; });
    std::erase_if(window.path_tolerances, [&](const PathTolerance& t) { return t.line > last; });
    if (last < lines && !window.moves.empty()) window.block_count = window.moves.back().block_index + 1;
  }
  return windows;
}

}  // namespace counterflex::test
