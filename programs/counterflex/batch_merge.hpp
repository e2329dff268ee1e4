#pragma once
/// Puts together what the shards of a batch have done.
#include <optional>

#include "batch_folder.hpp"
#include "batch_jobs.hpp"
#include "batch_manifest.hpp"
#include "console.hpp"

namespace counterflex::cli {

/// Looks whether all shards of the state have done what is theirs, and whether it is still as they left it;
/// then writes the programs that were split, and fills `manifest`, which is of all jobs. The signal by which
/// it was stopped, if any: what the shards have done stays as it is. Where they were merged before, and
/// nothing is left of them, nothing is done again. Throws `InputError`: Exit::transient_io where a shard is
/// missing or its work has been changed, Exit::machine_or_force where its manifest cannot be trusted; nothing
/// is written then.
std::optional<int> merge_shards(const Batch& batch, const BatchFolder& folder, int threads,
                                BatchManifest& manifest, Console& console);

/// Whether shards have left anything to merge.
bool has_shards(const BatchFolder& folder);

/// Removes what the shards have left in the state.
void remove_shards(const BatchFolder& folder);

/// The manifest of shard `index` of `count`.
std::string shard_manifest(const BatchFolder& folder, int index, int count);

}  // namespace counterflex::cli
