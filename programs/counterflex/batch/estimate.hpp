#pragma once
/// Estimates the duration of a batch.
#include "batch/jobs.hpp"

namespace counterflex::cli {

/// Seconds of one processor for all jobs. Runs the largest job of each kind (machine, method, with or without
/// causes) for a few seconds and extrapolates. Writes no output files, and leaves no temporary files if a
/// signal ends it. Throws `InputError` (ErrorKind::transient_io) if no process or temporary folder can be
/// made.
double estimated_seconds(const Batch& batch);

}  // namespace counterflex::cli
