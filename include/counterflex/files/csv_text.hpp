#pragma once
/// Lines and fields of CSV text, with their places.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"

namespace counterflex::csv {

/// A field without the blanks around it; `column` counts bytes of the line from 1.
struct Field {
  std::string_view text;
  int column = 1;
};

/// `text` without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// The fields between separators. Separators in double quotes do not separate fields. `first_column` is the
/// column of the line's first byte.
std::vector<Field> split(std::string_view line, int first_column = 1, char separator = ',');

/// Removes the next line from `text` and returns it without its LF or CRLF.
std::string_view take_line(std::string_view& text);

/// Throws `InputError` (ErrorKind::machine_or_force).
[[noreturn]] void fail(const Location& where, const std::string& message);

}  // namespace counterflex::csv
