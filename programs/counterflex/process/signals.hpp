#pragma once
/// Interrupts. A run that is interrupted leaves nothing half-written.
#include <csignal>
#include <optional>

namespace counterflex::cli {

/// The exit status of a program that `signal` has ended, as a shell has it: 130 for SIGINT, 143 for SIGTERM.
int status_of(int signal);

/// From here on SIGINT, SIGTERM, SIGHUP and SIGQUIT end the program with their status, unless they were
/// ignored before; a pipe that nobody reads any more, and a file that would be larger than is allowed, make
/// writing fail.
void end_on_signals();

/// Ends the program as `signal` does, one of those that have been waited for.
[[noreturn]] void end_by(int signal);

/// Signals that wait for a process which looks for them when it can: from here on they no longer end it.
class AwaitedSignals {
 public:
  /// Throws `InputError` (Exit::transient_io) where the system has no more descriptors.
  AwaitedSignals();
  ~AwaitedSignals();
  AwaitedSignals(const AwaitedSignals&) = delete;
  AwaitedSignals& operator=(const AwaitedSignals&) = delete;

  int descriptor() const { return descriptor_; }  ///< can be read when one has come

  /// The signal that has come within the time, if any.
  std::optional<int> take(int timeout_ms = 0) const;

 private:
  int descriptor_;
};

/// In a child process: signals end it again.
void hear_signals_again();

/// While it lives, these signals wait: for the writing of files that belong together.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace counterflex::cli
