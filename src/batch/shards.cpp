#include "counterflex/batch/shards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "counterflex/files/input_error.hpp"

namespace counterflex {
namespace {

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

struct SizedUnit {
  ShardUnit unit;
  double work = 0;
};

std::vector<SizedUnit> units_of(const std::vector<double>& work, double share, int shards,
                                double least_part) {
  std::vector<SizedUnit> units;
  for (std::size_t job = 0; job < work.size(); ++job) {
    const double wanted = std::min(std::ceil(work[job] / share), std::floor(work[job] / least_part));
    const int parts = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(shards)));
    for (int part = 0; part < parts; ++part) units.push_back({{job, part, parts}, work[job] / parts});
  }
  return units;
}

}  // namespace

Shard read_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto index = whole_number(text.substr(0, slash));
  const auto count = slash == std::string_view::npos ? std::nullopt : whole_number(text.substr(slash + 1));
  if (!index || !count || *index < 1 || *count < *index || *count > most_shards)
    throw InputError(
        Exit::usage, {},
        fmt::format("a shard is '{}', must be I/N with I from 1 to N, and N at most {}", text, most_shards));
  return {*index, *count};
}

std::vector<std::vector<ShardUnit>> plan_shards(const std::vector<double>& work, int shards,
                                                double least_part) {
  const double share = std::accumulate(work.begin(), work.end(), 0.0) / shards;
  std::vector<SizedUnit> units = units_of(work, share, shards, least_part);
  std::stable_sort(units.begin(), units.end(),
                   [](const SizedUnit& a, const SizedUnit& b) { return a.work > b.work; });
  using Load = std::pair<double, int>;  // and the shard that has it
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (int shard = 0; shard < shards; ++shard) loads.push({0, shard});
  std::vector<std::vector<ShardUnit>> plan(static_cast<std::size_t>(shards));
  for (const SizedUnit& sized : units) {
    auto [load, shard] = loads.top();
    loads.pop();
    plan[static_cast<std::size_t>(shard)].push_back(sized.unit);
    loads.push({load + sized.work, shard});
  }
  for (auto& of_shard : plan)
    std::sort(of_shard.begin(), of_shard.end(), [](const ShardUnit& a, const ShardUnit& b) {
      return std::tie(a.job, a.part) < std::tie(b.job, b.part);
    });
  return plan;
}

}  // namespace counterflex
