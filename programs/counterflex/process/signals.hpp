#pragma once
/// Interrupts. An interrupted run leaves no unfinished files.
#include <csignal>
#include <memory>
#include <optional>

namespace counterflex::cli {

/// The exit status of a program ended by `signal`, as in a shell: 130 for SIGINT, 143 for SIGTERM.
int status_of(int signal);

/// Installs handlers: SIGINT, SIGTERM, SIGHUP and SIGQUIT end the program with their status, unless they were
/// ignored before. Writing to a closed pipe, or beyond the allowed file size, fails with an error instead of
/// a signal.
void end_on_signals();

/// Ends the program as `signal` does, after it was received by `AwaitedSignals`.
[[noreturn]] void end_by(int signal);

/// Blocks signals, so that they do not end the process. The process polls for them.
class AwaitedSignals {
 public:
  /// Throws `InputError` (ErrorKind::transient_io) if the system has no more descriptors.
  AwaitedSignals();
  ~AwaitedSignals();
  AwaitedSignals(const AwaitedSignals&) = delete;
  AwaitedSignals& operator=(const AwaitedSignals&) = delete;

  int descriptor() const { return descriptor_; }  ///< Linux: readable when a signal has arrived

  /// The signal that arrived within the time, if any.
  std::optional<int> take(int timeout_ms = 0) const;

 private:
  int descriptor_;
};

/// In a child process: unblocks the signals, so that they end it.
void unblock_signals();

/// Blocks these signals until it is destroyed, while files that belong together are written.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  struct State;
  std::unique_ptr<State> before_;
};

}  // namespace counterflex::cli
