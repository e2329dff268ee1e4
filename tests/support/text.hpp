#pragma once
/// Text functions for tests.
#include <string>
#include <string_view>
#include <vector>

namespace counterflex::test {

inline bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// The lines of `text`, without line ends.
inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size(); begin += lines.back().size() + 1)
    lines.push_back(text.substr(begin, text.find('\n', begin) - begin));
  return lines;
}

}  // namespace counterflex::test
