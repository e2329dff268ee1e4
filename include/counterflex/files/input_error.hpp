#pragma once
/// The exception that a reader throws when its input is wrong, and the kinds of errors.
#include <array>
#include <stdexcept>
#include <string>

namespace counterflex {

/// What an error is about. A program that uses the library gives each kind an exit status.
enum class ErrorKind {
  internal,          ///< a defect of the program itself
  usage,             ///< options, and files that cannot be read or written under their names
  program_text,      ///< the machining program
  machine_or_force,  ///< a machine, force, project or jobs file, or a manifest
  not_compensated,   ///< not solved, or outside of the tolerance
  limit,             ///< of travel or of the correction
  transient_io,      ///< input or output that may succeed if it is tried again
};
inline constexpr std::array error_kinds{
    ErrorKind::internal,        ErrorKind::usage, ErrorKind::program_text, ErrorKind::machine_or_force,
    ErrorKind::not_compensated, ErrorKind::limit, ErrorKind::transient_io};

/// A place in a file; line and column count from 1, columns in bytes; 0: not known.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Bad input: `what()` is `file:line:column: error: message`, the message with the value seen and what is
/// allowed.
class InputError : public std::runtime_error {
 public:
  InputError(ErrorKind kind, const Location& where, const std::string& message);
  ErrorKind kind() const { return kind_; }
  const Location& where() const { return where_; }

 private:
  ErrorKind kind_;
  Location where_;
};

}  // namespace counterflex
