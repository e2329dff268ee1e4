#pragma once
/// Nesting of a TOML text, looked at before it is parsed: the parser recurses, and deep keys would exhaust the stack.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace counterflex::toml_file {

/// What nests too deeply, and where it begins to (bytes from the start of the text).
struct TooDeep {
  std::size_t offset = 0;
  std::string what;
};

/// The first key of more than 64 parts, or the first bracket inside more than 64 others.
std::optional<TooDeep> find_too_deep(std::string_view text);

}  // namespace counterflex::toml_file
