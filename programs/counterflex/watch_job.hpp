#pragma once
/// One program of a watched folder, compensated by a child: what ends the child does not end the watch.
#include <sys/types.h>

#include <optional>
#include <string>

#include "counterflex/files/input_error.hpp"
#include "options.hpp"
#include "workers.hpp"

namespace counterflex::cli {

/// What `compensate` is asked to do for `program` by flags of the watch, environment and project file. Throws
/// `InputError` for what is wrong with these.
Options watch_job(const Options& watch, const std::string& program);

/// The corrected program that `job` is to write.
std::string watch_output(const Options& job);

/// Throws `InputError` (Exit::usage) where outputs of different programs would be one file, or the program
/// itself, whatever programs come.
void refuse_shared_outputs(const Options& watch);

/// What became of it.
struct WatchResult {
  Exit exit = Exit::done;
  std::string error;                          ///< the diagnostic of a failure
  std::optional<double> before_mm, after_mm;  ///< largest deviations; none where nothing was solved
  std::string verdict = "FAILED";             ///< as in the report; FAILED where there is none
  std::string verdict_reason{};
};

/// Does the job, says nothing but warnings, and sends first which process it is in, and at last its result: a
/// worker's task.
void do_watch_job(const Options& job, const SendLine& send);

/// The process of which `sent` tells, or 0 where it is a result.
pid_t process_of_watch_job(const std::string& sent);

/// Removes what the process, which was killed, has left of the outputs of `job`.
void sweep_after(pid_t killed, const Options& job);

/// The result that it has sent; `ending` as `waitpid` gives it, for a worker that has ended before it could.
WatchResult watch_result(const std::optional<std::string>& sent, const Options& job, int ending);

}  // namespace counterflex::cli
