#pragma once
/// One job of a batch, in a process of its own.
#include <optional>
#include <string_view>

#include "batch/jobs.hpp"
#include "counterflex/batch/manifest.hpp"
#include "process/workers.hpp"

namespace counterflex::cli {

/// Runs the job with `threads` threads. Sends its progress and finally its outcome. Does not throw: every
/// failure is an outcome of the job.
void do_job(const BatchJob& job, int threads, const SendLine& send);

/// A parsed line that `do_job` has sent.
struct JobNews {
  std::optional<double> done{};         ///< share of the program, 0 to 1
  std::size_t waypoints = 0;            ///< solved since the last line the last line
  std::optional<JobOutcome> outcome{};  ///< the last one
};
JobNews news_of(std::string_view line);

/// The outcome of a job before it has run.
JobOutcome outcome_for(const BatchJob& job);

/// The outcome of a job whose process ended without sending one; `status` is from `waitpid`. A killed process
/// may succeed in another run, a crashed one will not.
JobOutcome lost_outcome(const BatchJob& job, int status);

}  // namespace counterflex::cli
