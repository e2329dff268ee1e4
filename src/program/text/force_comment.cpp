#include "program/text/force_comment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 6> keys{"FX", "FY", "FZ", "MX", "MY", "MZ"};

struct Token {
  std::string_view text;
  std::size_t at;
};

/// The next run of characters without blanks, in `text` from `at` to `end`; empty at the end.
Token next_token(std::string_view text, std::size_t& at, std::size_t end) {
  while (at < end && (text[at] == ' ' || text[at] == '\t')) ++at;
  const std::size_t begin = at;
  while (at < end && text[at] != ' ' && text[at] != '\t') ++at;
  return {text.substr(begin, at - begin), begin};
}

bool same_letters(std::string_view a, std::string_view upper_case) {
  return std::equal(a.begin(), a.end(), upper_case.begin(), upper_case.end(),
                    [](char x, char y) { return (x >= 'a' && x <= 'z' ? x - 'a' + 'A' : x) == y; });
}

std::size_t key_index(std::string_view name) {
  const auto key = std::find_if(keys.begin(), keys.end(), [&](auto k) { return same_letters(name, k); });
  return static_cast<std::size_t>(key - keys.begin());
}

}  // namespace

std::optional<ForceComment> read_force_comment(std::string_view text, const std::string& file,
                                               const Block& block, Span comment) {
  std::size_t at = comment.begin;
  const Token first = next_token(text, at, comment.end);
  if (!same_letters(first.text, "FORCE")) return std::nullopt;
  const auto fail = [&](std::size_t where, const std::string& message) {
    refuse(file, block, where, message, ErrorKind::machine_or_force);
  };

  Vector6 force = Vector6::Zero();
  std::array<bool, keys.size()> given{};
  Token token = next_token(text, at, comment.end);
  if (token.text.empty()) fail(first.at, "FORCE has no value: OFF or FX= FY= FZ= MX= MY= MZ= must follow");
  if (same_letters(token.text, "OFF")) {
    token = next_token(text, at, comment.end);
    if (!token.text.empty()) fail(token.at, fmt::format("'{}' follows FORCE OFF", token.text));
    return ForceComment{};
  }
  for (; !token.text.empty(); token = next_token(text, at, comment.end)) {
    const std::size_t equals = token.text.find('=');
    const std::size_t key = key_index(token.text.substr(0, equals));
    if (equals == std::string_view::npos || key == keys.size())
      fail(token.at,
           fmt::format("'{}' is not a word of FORCE: use OFF or FX= FY= FZ= MX= MY= MZ=", token.text));
    if (given[key]) fail(token.at, fmt::format("{} is given twice", keys[key]));
    const std::string_view number = token.text.substr(equals + 1);
    const auto value = read_number(number);
    if (!value) fail(token.at + equals + 1, fmt::format("'{}' is not a number for {}", number, keys[key]));
    given[key] = true;
    force[static_cast<Eigen::Index>(key)] = *value;
  }
  return ForceComment{force};
}

}  // namespace counterflex
