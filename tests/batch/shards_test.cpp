#include "counterflex/batch/shards.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "counterflex/files/input_error.hpp"

namespace counterflex {
namespace {

double work_of(const std::vector<ShardUnit>& units, const std::vector<double>& work) {
  return std::accumulate(units.begin(), units.end(), 0.0, [&](double sum, const ShardUnit& unit) {
    return sum + work[unit.job] / unit.parts;
  });
}

}  // namespace

TEST_CASE("every job, and every part of a job, is in one shard") {
  std::mt19937 random(7);
  for (int shards = 1; shards <= 9; ++shards) {
    CAPTURE(shards);
    std::vector<double> work(50);
    for (double& w : work) w = std::exp(std::uniform_real_distribution<>(0, 8)(random));
    std::map<std::size_t, std::set<int>> parts;
    for (const auto& units : plan_shards(work, shards))
      for (const ShardUnit& unit : units) {
        CHECK(unit.part < unit.parts);
        CHECK(parts[unit.job].insert(unit.part).second);
        CHECK(unit.parts <= shards);
      }
    CHECK(parts.size() == work.size());
    for (const auto& units : plan_shards(work, shards))
      for (const ShardUnit& unit : units)
        CHECK(parts[unit.job].size() == static_cast<std::size_t>(unit.parts));
  }
}

TEST_CASE("no shard has more than its share and one unit, whatever the sizes of the jobs") {
  std::mt19937 random(11);
  for (int shards = 1; shards <= 9; ++shards) {
    CAPTURE(shards);
    std::vector<double> work(40);
    for (double& w : work) w = std::exp(std::uniform_real_distribution<>(0, 8)(random));
    const double share = std::accumulate(work.begin(), work.end(), 0.0) / shards;
    for (const auto& units : plan_shards(work, shards)) CHECK(work_of(units, work) <= 2 * share);
  }
  const std::vector<double> equal(1000, 3.0);
  for (const auto& units : plan_shards(equal, 4)) CHECK(units.size() == 250);
}

TEST_CASE("one huge job is cut so that each shard has a part") {
  const auto plan = plan_shards({1000}, 4);
  for (int shard = 0; shard < 4; ++shard)
    CHECK(plan[static_cast<std::size_t>(shard)] == std::vector<ShardUnit>{{0, shard, 4}});
  CHECK(plan_shards({1000, 1, 1}, 1)[0] == std::vector<ShardUnit>{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}});
}

TEST_CASE("no part is smaller than asked for") {
  const auto parts = [](double least) {
    std::size_t count = 0;
    for (const auto& units : plan_shards({1000, 30}, 4, least)) count += units.size();
    return count - 1;
  };
  CHECK(parts(0) == 4);
  CHECK(parts(300) == 3);
  CHECK(parts(501) == 1);
  CHECK(parts(5000) == 1);
}

TEST_CASE("more shards than jobs leave some without work") {
  const auto plan = plan_shards({1, 1}, 2);
  CHECK(plan[0].size() + plan[1].size() == 2);
  CHECK(plan_shards({}, 3).size() == 3);
}

TEST_CASE("a shard is I/N") {
  CHECK(read_shard("3/8").index == 3);
  CHECK(read_shard("3/8").count == 8);
  CHECK(read_shard("1/1").count == 1);
  for (const char* text :
       {"", "3", "/", "3/", "/8", "0/8", "9/8", "-1/8", "1/8x", "1 /8", "1/200000", "1.0/2"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(read_shard(text), InputError);
  }
}

}  // namespace counterflex
