#pragma once
/// Runs jobs in parallel, each in its own process.
#include <optional>

#include "batch/manifest.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

/// Runs the jobs that have no outcome in `manifest` on `threads` processors, the largest first, and adds
/// their outcomes to it. A job that is large compared with all others gets all processors. A job waits for
/// those before it that have a data list in common with it. Returns the signal
/// that stopped the run, if any: it stops within a second and abandons running jobs. Throws `InputError`
/// (ErrorKind::transient_io) if no process can be started.
///
/// `files` are those of all jobs of the batch, and get the files that a job writes. If two jobs that ran at
/// once have written one file, as a part of a divided program, both fail, and their outputs are removed.
std::optional<int> do_missing(BatchManifest& manifest, int threads, JobFiles& files, Console& console);

}  // namespace counterflex::cli
