#pragma once
/// The exception that a reader throws when its input is wrong, with the exit status of the program.
#include <stdexcept>
#include <string>

namespace counterflex {

/// Exit statuses of the command line.
enum class Exit : int {
  done = 0,
  internal = 1,
  usage = 2,
  program_text = 3,
  machine_or_force = 4,
  not_compensated = 5,
  limit = 6,
  transient_io = 75,
  interrupted = 130,  ///< by SIGINT; other signals have 128 and their number
};

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
  InputError(Exit exit, const Location& where, const std::string& message);
  Exit exit() const { return exit_; }
  const Location& where() const { return where_; }

 private:
  Exit exit_;
  Location where_;
};

}  // namespace counterflex
