#pragma once
/// Merges the results of the shards of a batch.
#include "batch/folder.hpp"
#include "batch/jobs.hpp"
#include "batch/manifest.hpp"

namespace counterflex::cli {

/// Fills `manifest`, which has all jobs, with the results of the shards. If the shards were merged and
/// removed before, takes over the results of that merge. Throws `InputError` and changes nothing if a shard
/// is missing or its inputs or outputs have changed (ErrorKind::transient_io), or if its manifest is damaged
/// (ErrorKind::machine_or_force).
void merge_shards(const Batch& batch, const BatchFolder& folder, BatchManifest& manifest);

/// Whether there are results of shards to merge.
bool has_shards(const BatchFolder& folder);

/// Removes the results of shards from the state folder.
void remove_shards(const BatchFolder& folder);

/// The manifest of shard `index` of `count`.
std::string shard_manifest(const BatchFolder& folder, int index, int count);

}  // namespace counterflex::cli
