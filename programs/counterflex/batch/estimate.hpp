#pragma once
/// How long a batch would take.
#include "batch/jobs.hpp"

namespace counterflex::cli {

/// Seconds of one processor for all jobs, found by trying: of each kind of job (machine, method, with causes
/// or without) the largest one is begun for a few seconds and given up. Nothing is written under a final
/// name; a signal that ends the program leaves nothing behind. Throws `InputError` (Exit::transient_io) where
/// no process or temporary folder can be made.
double estimated_seconds(const Batch& batch);

}  // namespace counterflex::cli
