#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex {
namespace {

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Shard read_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto index = whole_number(text.substr(0, slash));
  const auto count = slash == std::string_view::npos ? std::nullopt : whole_number(text.substr(slash + 1));
  if (!index || !count || *index < 1 || *count < *index || *count > most_shards)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("a shard is '{}', must be I/N with I from 1 to N, and N at most {}", text, most_shards));
  return {*index, *count};
}

std::vector<std::vector<std::size_t>> plan_shards(const std::vector<double>& work, int shards) {
  std::vector<std::size_t> largest_first(work.size());
  std::iota(largest_first.begin(), largest_first.end(), std::size_t{0});
  std::ranges::stable_sort(largest_first, std::greater<>(), [&](std::size_t job) { return work[job]; });
  using Load = std::pair<double, int>;  // and its shard
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (int shard = 0; shard < shards; ++shard) loads.push({0, shard});
  std::vector<std::vector<std::size_t>> plan(static_cast<std::size_t>(shards));
  for (const std::size_t job : largest_first) {
    const auto [load, shard] = loads.top();
    loads.pop();
    plan[static_cast<std::size_t>(shard)].push_back(job);
    loads.push({load + work[job], shard});
  }
  for (auto& jobs : plan) std::ranges::sort(jobs);
  return plan;
}

}  // namespace counterflex
