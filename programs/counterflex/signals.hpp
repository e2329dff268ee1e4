#pragma once
/// Interrupts. A run that is interrupted leaves nothing half-written.
#include <csignal>

namespace counterflex::cli {

/// The exit status of a program that `signal` has ended, as a shell has it: 130 for SIGINT, 143 for SIGTERM.
int status_of(int signal);

/// From here on SIGINT, SIGTERM and SIGHUP end the program with their status, unless they were ignored
/// before; a pipe that nobody reads any more makes writing fail.
void end_on_signals();

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
