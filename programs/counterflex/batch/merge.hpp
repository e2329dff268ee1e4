#pragma once
/// Sums up the results of the shards of a batch.
#include "batch/folder.hpp"
#include "batch/jobs.hpp"
#include "batch/manifest.hpp"

namespace counterflex::cli {

/// Fills `manifest`, which has all jobs, with the results of the shards. If the shards were merged before and
/// none are left, takes the results of that merge. Throws `InputError`, and then nothing is changed:
/// Exit::transient_io where a shard is missing or its inputs or outputs have changed, Exit::machine_or_force
/// where its manifest is damaged.
void merge_shards(const Batch& batch, const BatchFolder& folder, BatchManifest& manifest);

/// Whether shards have left anything to merge.
bool has_shards(const BatchFolder& folder);

/// Removes what the shards have left in the state.
void remove_shards(const BatchFolder& folder);

/// The manifest of shard `index` of `count`.
std::string shard_manifest(const BatchFolder& folder, int index, int count);

}  // namespace counterflex::cli
