#pragma once
/// One job of a batch, in a process of its own.
#include <optional>
#include <string>
#include <string_view>

#include "batch/jobs.hpp"
#include "counterflex/batch/manifest.hpp"
#include "process/workers.hpp"

namespace counterflex::cli {

/// What a worker does.
struct JobOrder {
  std::string key{};  ///< of the job
  int threads = 1;
  std::string folder{};  ///< of its outputs; empty: their own

  /// For a worker that is started with an order.
  std::string text() const;
};
JobOrder order_of(const std::string& text);

/// Runs the job. Sends its progress and finally its outcome. Does not throw: every failure is an outcome of
/// the job.
void do_job(const BatchJob& job, const JobOrder& order, const SendLine& send);

/// A parsed line that `do_job` has sent.
struct JobNews {
  std::optional<double> done{};         ///< share of the program, 0 to 1
  std::size_t waypoints = 0;            ///< solved since the last line
  std::optional<JobOutcome> outcome{};  ///< the last one
};
JobNews news_of(std::string_view line);

/// The outcome of a job before it has run, with its inputs as they are now.
JobOutcome outcome_for(const BatchJob& job);

/// The outcome of a job whose process ended without sending one. A killed process may succeed in another run,
/// a crashed one will not.
JobOutcome lost_outcome(const BatchJob& job, const WorkerEnd& end);

}  // namespace counterflex::cli
