#pragma once
/// Values of JSON documents that were written elsewhere: by JSON pointer, of the kind that is wanted, or
/// none.
#include <optional>
#include <string>

#include "counterflex/files/input_error.hpp"
#include "json_numbers.hpp"

namespace counterflex {

/// A document and the name of its file. The members take the text of a JSON pointer; what is not there, or is
/// null, is none. They throw `InputError` (Exit::usage), naming the pointer and the value, where there is
/// something of another kind.
struct JsonSource {
  const Json& document;
  std::string file;

  const Json* find(const std::string& pointer) const;  ///< of any kind; nullptr: none
  std::optional<double> number(const std::string& pointer) const;
  std::string text(const std::string& pointer) const;  ///< empty: none
  const Json* object(const std::string& pointer) const;
  const Json* list(const std::string& pointer) const;

 private:
  [[noreturn]] void refuse(const std::string& pointer, const Json& value, const char* wanted) const;
};

/// Parses `text`, which begins at byte `offset` of `whole`, the content of `file`. Throws `InputError`
/// (Exit::usage) with line and column in `file` where it is no JSON, has a number that is too large, or is
/// nested absurdly deep.
Json parse_json(std::string_view text, std::string_view whole, std::size_t offset, const std::string& file);

/// The place of a byte of `text`.
Location place_of(std::string_view text, std::size_t offset, const std::string& file);

/// A value as text: strings without their quotes.
std::string plain_text(const Json& value);

}  // namespace counterflex
