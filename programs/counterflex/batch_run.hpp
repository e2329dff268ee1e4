#pragma once
/// Does jobs side by side, each in a process of its own.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch_jobs.hpp"
#include "console.hpp"
#include "counterflex/batch/job_outcome.hpp"
#include "signals.hpp"
#include "workers.hpp"

namespace counterflex::cli {

/// Something that a worker does for a job: the job itself, or a part of it.
struct BatchTask {
  double work = 0;  ///< as that of a job
  std::function<void(int threads, const SendLine&)> run;
  std::function<JobOutcome(int status)> lost;  ///< its outcome where the process has sent none
};

struct BatchListener {
  std::function<void(std::size_t task, JobOutcome)> ended;  ///< and what has become of it
  std::function<void()> now_and_then;                       ///< at least twice a second
};

/// Does all tasks on `threads` processors, the largest first. One that is large beside all others gets all of
/// them for itself. Returns the signal by which it was stopped, if any: within a second, the tasks that were
/// under way given up. Throws `InputError` (Exit::transient_io) where no process can be started.
std::optional<int> run_tasks(const std::vector<BatchTask>& tasks, int threads, const AwaitedSignals& signals,
                             const BatchListener& listener, Console& console);

}  // namespace counterflex::cli
