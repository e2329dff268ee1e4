#pragma once
/// Names of outputs that are made of the name of the program: `{name}_CF{ext}`.
#include <optional>
#include <string>
#include <string_view>

namespace counterflex {

/// What stands for the words in braces, as far as it is known.
struct NameParts {
  std::optional<std::string> name;    ///< {name}: the program's file name without its extension
  std::optional<std::string> ext;     ///< {ext}: the extension with its dot, empty where there is none
  std::optional<std::string> output;  ///< {output}: the path of the output without its extension
};

/// Whether `text` holds a word of letters in braces, known or not; other braces are parts of names.
bool is_pattern(std::string_view text);

/// The text that `fill` makes `path` of: "{{}" stands for a brace that begins a word.
std::string as_pattern(std::string_view path);

/// The first word in braces that `allowed` does not have; empty: none.
std::string unknown_placeholder(std::string_view pattern, const NameParts& allowed);

/// The word that an unknown one was probably meant to be; empty: none.
std::string nearest_placeholder(std::string_view word);

/// `pattern` with the parts in their places; unknown words stay as they are.
std::string fill(std::string_view pattern, const NameParts& parts);

}  // namespace counterflex
