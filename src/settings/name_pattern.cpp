#include "counterflex/settings/name_pattern.hpp"

#include <algorithm>
#include <cstddef>

namespace counterflex {
namespace {

/// A pattern's next word in braces.
struct Placeholder {
  std::size_t begin = std::string_view::npos, end = 0;  ///< its braces included
  std::string_view word;
};

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

Placeholder next_placeholder(std::string_view text, std::size_t from) {
  for (std::size_t open = text.find('{', from); open != std::string_view::npos;
       open = text.find('{', open + 1)) {
    const std::size_t close = text.find('}', open);
    if (close == std::string_view::npos) break;
    const std::string_view word = text.substr(open + 1, close - open - 1);
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_lower)) return {open, close + 1, word};
  }
  return {};
}

std::optional<std::string> part_named(std::string_view word, const NameParts& parts) {
  if (word == "name") return parts.name;
  if (word == "ext") return parts.ext;
  if (word == "output") return parts.output;
  return std::nullopt;
}

}  // namespace

bool is_pattern(std::string_view text) {
  return !next_placeholder(text, 0).word.empty();
}

std::string unknown_placeholder(std::string_view pattern, const NameParts& allowed) {
  for (Placeholder next = next_placeholder(pattern, 0); !next.word.empty();
       next = next_placeholder(pattern, next.end))
    if (!part_named(next.word, allowed)) return std::string(next.word);
  return "";
}

std::string fill(std::string_view pattern, const NameParts& parts) {
  std::string text;
  std::size_t done = 0;
  for (Placeholder next = next_placeholder(pattern, 0); !next.word.empty();
       next = next_placeholder(pattern, next.end)) {
    text += pattern.substr(done, next.begin - done);
    text +=
        part_named(next.word, parts).value_or(std::string(pattern.substr(next.begin, next.end - next.begin)));
    done = next.end;
  }
  return text.append(pattern.substr(done));
}

}  // namespace counterflex
