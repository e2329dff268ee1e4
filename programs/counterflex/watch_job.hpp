#pragma once
/// One program of a watched folder, compensated by a child: what ends the child does not end the watch.
#include <sys/types.h>

#include <csignal>
#include <string>

#include "console.hpp"
#include "counterflex/files/input_error.hpp"
#include "options.hpp"

namespace counterflex::cli {

/// What `compensate` is asked to do for `program` by the options of the watch: --output, --report and --plot
/// name folders in which files have the program's name.
Options watch_job(const Options& watch, const std::string& program);

/// The corrected program that `job` is to write.
std::string watch_output(const Options& job);

/// A child at work. Its standard output goes nowhere; it dies with its parent.
class WatchChild {
 public:
  /// `signals` is the mask that the child begins with. Throws `InputError` (Exit::transient_io) where there
  /// can be no child. Only for programs with one thread.
  WatchChild(Options job, Console& console, const sigset_t& signals);

  const Options& job() const { return job_; }

  /// Whether it has ended; its exit status then, Exit::internal with a diagnostic where a signal ended it.
  bool has_ended(Console& console, Exit& exit);

  /// Ends it, and waits until its temporary files are removed.
  void interrupt();

 private:
  Options job_;
  pid_t pid_ = -1;
};

}  // namespace counterflex::cli
