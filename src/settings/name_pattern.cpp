#include <algorithm>
#include <cstddef>

#include "counterflex/files/text.hpp"
#include "counterflex/settings/jobs_file.hpp"

namespace counterflex {
namespace {

/// A literal opening brace: "{{}name}".
constexpr std::string_view brace = "{";

/// The next word in braces of a pattern; it may be `brace`.
struct Placeholder {
  std::size_t begin = std::string_view::npos, end = 0;  ///< its braces included
  std::string_view word;
};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_letter(char c) {
  return lower(c) >= 'a' && lower(c) <= 'z';
}

Placeholder next_placeholder(std::string_view text, std::size_t from) {
  for (std::size_t open = text.find('{', from); open != std::string_view::npos;
       open = text.find('{', open + 1)) {
    const std::size_t close = text.find('}', open);
    if (close == std::string_view::npos) break;
    const std::string_view word = text.substr(open + 1, close - open - 1);
    const bool letters = !word.empty() && std::all_of(word.begin(), word.end(), is_letter);
    if (letters || word == brace) return {open, close + 1, word};
  }
  return {};
}

std::optional<std::string> part_named(std::string_view word, const NameParts& parts) {
  if (word == brace) return std::string(brace);
  if (word == "name") return parts.name;
  if (word == "ext") return parts.ext;
  if (word == "output") return parts.output;
  return std::nullopt;
}

}  // namespace

bool is_pattern(std::string_view text) {
  Placeholder next = next_placeholder(text, 0);
  while (next.word == brace) next = next_placeholder(text, next.end);
  return !next.word.empty();
}

std::string as_pattern(std::string_view path) {
  std::string text;
  std::size_t done = 0;
  for (Placeholder next = next_placeholder(path, 0); !next.word.empty();
       next = next_placeholder(path, next.begin + 1)) {
    text.append(path.substr(done, next.begin - done)).append("{{}");
    done = next.begin + 1;
  }
  return text.append(path.substr(done));
}

std::string unknown_placeholder(std::string_view pattern, const NameParts& allowed) {
  for (Placeholder next = next_placeholder(pattern, 0); !next.word.empty();
       next = next_placeholder(pattern, next.end))
    if (!part_named(next.word, allowed)) return std::string(next.word);
  return "";
}

std::string nearest_placeholder(std::string_view word) {
  std::string small(word);
  std::transform(small.begin(), small.end(), small.begin(), lower);
  return std::string(nearest(small, {"name", "ext", "output"}));
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
