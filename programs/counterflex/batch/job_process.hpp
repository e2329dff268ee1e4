#pragma once
/// One job of a batch, in a process of its own.
#include <optional>
#include <string_view>

#include "batch/jobs.hpp"
#include "counterflex/batch/manifest.hpp"
#include "process/workers.hpp"

namespace counterflex::cli {

/// Does the job with `threads` threads and sends what has become of it, and before that how far it has come.
/// Throws nothing: whatever goes wrong is the outcome of this job.
void do_job(const BatchJob& job, int threads, const SendLine& send);

/// What a line says that `do_job` has sent.
struct JobNews {
  std::optional<double> done{};         ///< share of the program, 0 to 1
  std::size_t waypoints = 0;            ///< solved since
  std::optional<JobOutcome> outcome{};  ///< the last one
};
JobNews news_of(std::string_view line);

/// The outcome of a job about which nothing is known yet.
JobOutcome outcome_for(const BatchJob& job);

/// The outcome of a job whose process ended without one; `status` as `waitpid` gives it. One that was killed
/// may succeed another time, one that broke down will not.
JobOutcome lost_outcome(const BatchJob& job, int status);

}  // namespace counterflex::cli
