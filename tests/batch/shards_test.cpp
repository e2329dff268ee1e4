#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex {
namespace {

double work_of(const std::vector<std::size_t>& jobs, const std::vector<double>& work) {
  return std::accumulate(jobs.begin(), jobs.end(), 0.0,
                         [&](double sum, std::size_t job) { return sum + work[job]; });
}

/// Jobs of very different sizes.
std::vector<double> random_work(std::size_t jobs, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> work(jobs);
  for (double& w : work) w = std::exp(std::uniform_real_distribution<>(0, 8)(random));
  return work;
}

}  // namespace

TEST_CASE("every job is in one shard, in the order of jobs") {
  for (int shards = 1; shards <= 9; ++shards) {
    CAPTURE(shards);
    std::set<std::size_t> found;
    for (const auto& jobs : plan_shards(random_work(50, 7), shards)) {
      CHECK(std::ranges::is_sorted(jobs));
      for (const std::size_t job : jobs) CHECK(found.insert(job).second);
    }
    CHECK(found.size() == 50);
  }
}

TEST_CASE("no shard has more than its share plus one job, for jobs of any size") {
  for (int shards = 1; shards <= 9; ++shards) {
    CAPTURE(shards);
    const std::vector<double> work = random_work(40, 11);
    const double share = std::accumulate(work.begin(), work.end(), 0.0) / shards;
    const double largest = *std::ranges::max_element(work);
    for (const auto& jobs : plan_shards(work, shards)) CHECK(work_of(jobs, work) <= share + largest);
  }
  const std::vector<double> equal(1000, 3.0);
  for (const auto& jobs : plan_shards(equal, 4)) CHECK(jobs.size() == 250);
}

TEST_CASE("more shards than jobs leave some without work") {
  const auto plan = plan_shards({1, 1}, 3);
  CHECK(plan[0].size() + plan[1].size() + plan[2].size() == 2);
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
