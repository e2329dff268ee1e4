#pragma once
/// Does jobs side by side, each in a process of its own.
#include <optional>

#include "batch/manifest.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

/// Does the jobs of `manifest` that have no outcome in it, on `threads` processors, the largest first, and
/// keeps it up to date. A job that is large compared with all others gets all processors. Returns the signal
/// by which the run was stopped, if any: it stops within a second and gives up the jobs under way. Throws
/// `InputError` (Exit::transient_io) where no process can be started.
std::optional<int> do_missing(BatchManifest& manifest, int threads, Console& console);

}  // namespace counterflex::cli
