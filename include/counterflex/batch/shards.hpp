#pragma once
/// Which part of a batch each of several machines does.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// "I/N": shard I of N, from 1.
struct Shard {
  int index = 1;
  int count = 1;
};

inline constexpr int most_shards = 100000;

/// Throws `InputError` (Exit::usage) for anything but two whole numbers of which the first is not larger.
Shard read_shard(std::string_view text);

/// A job, or of a long program one of `parts` parts, from 0.
struct ShardUnit {
  std::size_t job = 0;
  int part = 0;
  int parts = 1;
  bool operator==(const ShardUnit&) const = default;
};

/// The units of each of `shards` shards, by `work` of the jobs (any unit, positive). A job that is more than
/// the share of a shard is cut into as many parts as it has shares, rounded up, but none smaller than
/// `least_part`; then, the largest first, each
/// unit goes to the shard that has least to do. Depends on its arguments alone; units of a shard are in the
/// order of jobs.
std::vector<std::vector<ShardUnit>> plan_shards(const std::vector<double>& work, int shards,
                                                double least_part = 0);

}  // namespace counterflex
