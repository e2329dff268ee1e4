#pragma once
/// Which jobs of a batch each of several machines does.
#include <cstddef>
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

/// The jobs of each of `shards` shards, by `work` of the jobs (any unit, positive): the largest first, each
/// job goes to the shard that has least to do. The result depends on the arguments only. Jobs of a shard are
/// in ascending order.
std::vector<std::vector<std::size_t>> plan_shards(const std::vector<double>& work, int shards);

}  // namespace counterflex
