#pragma once
/// The exit statuses of the program: the table of guide/safety.md.
#include <optional>

#include "counterflex/files/input_error.hpp"
#include "process/signals.hpp"

namespace counterflex::cli {

/// The number of a kind of error. Reports and manifests hold the same numbers.
constexpr int exit_number(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::internal:
      return 1;
    case ErrorKind::usage:
      return 2;
    case ErrorKind::program_text:
      return 3;
    case ErrorKind::machine_or_force:
      return 4;
    case ErrorKind::not_compensated:
      return 5;
    case ErrorKind::limit:
      return 6;
    case ErrorKind::transient_io:
      return 75;
  }
  return 1;
}

/// 0 without an error.
constexpr int exit_number(const std::optional<ErrorKind>& error) {
  return error ? exit_number(*error) : 0;
}

/// How a process ends: without an error, by an error, or by a signal.
class ExitStatus {
 public:
  ExitStatus(const std::optional<ErrorKind>& error) : number_(exit_number(error)) {}
  static ExitStatus of_signal(int signal) { return ExitStatus(status_of(signal)); }
  int number() const { return number_; }

 private:
  explicit ExitStatus(int number) : number_(number) {}

  int number_;
};

}  // namespace counterflex::cli
