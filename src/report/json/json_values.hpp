#pragma once
/// Reads values of given types from JSON documents, by JSON pointer. Missing values are empty.
#include <optional>
#include <string>

#include "counterflex/files/input_error.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {

/// A document and the name of its file. The members take the text of a JSON pointer. Missing values and null
/// give an empty result. They throw `InputError` (ErrorKind::usage) with the pointer and the value if it has
/// another type.
struct JsonSource {
  const Json& document;
  std::string file;
  ErrorKind kind = ErrorKind::usage;  ///< of a value of the wrong type

  const Json* find(const std::string& pointer) const;  ///< of any type; nullptr if missing
  std::optional<double> number(const std::string& pointer) const;
  std::string text(const std::string& pointer) const;  ///< empty if missing
  const Json* object(const std::string& pointer) const;
  const Json* list(const std::string& pointer) const;

 private:
  [[noreturn]] void refuse(const std::string& pointer, const Json& value, const char* wanted) const;
};

/// Parses `text`, which begins at byte `offset` of `whole`, the content of `file`. Throws `InputError`
/// (of that kind) with line and column in `file` if it is not JSON, has a number that is too large, or is
/// nested too deep.
Json parse_json(std::string_view text, std::string_view whole, std::size_t offset, const std::string& file,
                ErrorKind kind = ErrorKind::usage);

/// The place of a byte of `text`.
Location place_of(std::string_view text, std::size_t offset, const std::string& file);

/// A value as text: strings without their quotes.
std::string plain_text(const Json& value);

}  // namespace counterflex
