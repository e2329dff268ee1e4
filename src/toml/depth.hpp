#pragma once
/// Checks the nesting of a TOML text before it is parsed: the parser is recursive, and deep nesting would
/// exhaust the stack.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace counterflex::toml_file {

/// A nesting error and its place (bytes from the start of the text).
struct TooDeep {
  std::size_t offset = 0;
  std::string what;
};

/// The first key of more than 64 parts, or the first bracket inside more than 64 others.
std::optional<TooDeep> find_too_deep(std::string_view text);

}  // namespace counterflex::toml_file
