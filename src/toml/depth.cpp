#include "toml/depth.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace counterflex::toml_file {
namespace {

constexpr int most_parts = 64, most_brackets = 64;

/// The first byte after the string that begins at `i`. An unclosed string ends with its line, or with the
/// text.
std::size_t end_of_string(std::string_view text, std::size_t i) {
  const char quote = text[i];
  const std::string three(3, quote);
  const bool long_string = text.substr(i, 3) == three;
  i += long_string ? 3 : 1;
  while (i < text.size()) {
    if (long_string ? text.substr(i, 3) == three : text[i] == quote) return i + (long_string ? 3 : 1);
    if (!long_string && text[i] == '\n') return i;
    i += quote == '"' && text[i] == '\\' ? 2 : 1;
  }
  return text.size();
}

}  // namespace

std::optional<TooDeep> find_too_deep(std::string_view text) {
  int parts = 1, brackets = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '.' && ++parts > most_parts)
      return TooDeep{
          i, fmt::format("this key has more than {} parts; at most {} are allowed", most_parts, most_parts)};
    if ((c == '[' || c == '{') && ++brackets > most_brackets)
      return TooDeep{i, fmt::format("more than {} arrays and tables are nested; at most {} are allowed",
                                    most_brackets, most_brackets)};
    if ((c == ']' || c == '}') && brackets > 0) --brackets;
    if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) parts = 1;
    ++i;
  }
  return std::nullopt;
}

}  // namespace counterflex::toml_file
