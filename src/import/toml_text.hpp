#pragma once
/// Lines of an imported machine file.
#include <string>
#include <string_view>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::import {

/// Throws `InputError` (ErrorKind::machine_or_force).
[[noreturn]] void fail(const Location& where, const std::string& message);

/// The whole of `text` as a number of at most 1e9 in size: what a length in m or an angle may be, written in
/// mm or degrees. Throws at `at`; `what` names the number.
double read_usable(std::string_view text, const Location& at, const std::string& what);

/// `value` with the fewest of at most 12 decimals: 612, -57.2957795131. Rounding moves a length in mm by less
/// than 1e-15 m, an angle in deg by less than 1e-14 rad.
std::string number(double value);

/// In mm or degrees, of m or rad: "[0, 0, 127.3]".
std::string list_mm(const Vector3& p);
std::string list_deg(const Vector3& angles);

/// A basic string of TOML.
std::string toml_string(std::string_view text);

/// The table [program]; empty `units` are left out.
std::string program_text(const std::string& dialect, const std::string& units);

/// Text of an input on one line, for a comment.
std::string comment_text(std::string_view text);

/// The name of a file without its folders, for a comment; and without its extension, as the name of a
/// machine.
std::string file_name(const std::string& file);
std::string file_stem(const std::string& file);

/// `text` as a name of elements: letters, digits, _ and -; other bytes become _.
std::string identifier(std::string_view text);

}  // namespace counterflex::import
