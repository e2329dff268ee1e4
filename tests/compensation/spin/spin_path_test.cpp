// The turns of least deviation along stops, against all ways of turning.
#include "compensation/spin/spin_path.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>

using namespace counterflex;

namespace {

constexpr float forbidden = std::numeric_limits<float>::infinity();

/// Stops whose deviation is a different wave of the turn at each place; some turns are forbidden.
SpinGraph random_graph(std::mt19937& random, std::size_t stops) {
  std::uniform_real_distribution<double> share(0, 1);
  SpinGraph graph;
  for (std::size_t i = 0; i < stops; ++i) {
    const std::size_t places = i == 0 ? 1 : 1 + random() % 3;
    for (std::size_t k = 1; k <= places; ++k) {
      graph.places.push_back({static_cast<double>(k) / static_cast<double>(places), i == 0 ? 0 : 0.004});
      const double height = 1 + share(random), phase = 6 * share(random);
      for (int turn = 0; turn < spin_count; ++turn) {
        const bool free = turn == spin_zero || share(random) > 0.1;
        graph.deviations.push_back(free ? static_cast<float>(height + std::sin(0.2 * turn + phase)) * 1e-3F
                                        : forbidden);
      }
    }
    graph.stops.push_back({.linked = i > 0,
                           .is_free = share(random) > 0.2,
                           .most_steps = static_cast<int>(random() % 3),
                           .places_end = graph.places.size()});
  }
  return graph;
}

/// The least largest deviation of all ways of turning.
double least_of_all(const SpinGraph& graph) {
  std::vector<int> turns(graph.stops.size(), spin_zero);
  double least = HUGE_VAL;
  const std::function<void(std::size_t)> walk = [&](std::size_t i) {
    if (i == turns.size()) {
      least = std::min(least, largest_deviation(graph, turns));
      return;
    }
    const SpinStop& stop = graph.stops[i];
    for (int turn = 0; turn < spin_count; ++turn) {
      if (!stop.is_free && turn != spin_zero) continue;
      if (stop.linked && std::abs(turn - turns[i - 1]) > stop.most_steps) continue;
      turns[i] = turn;
      walk(i + 1);
    }
  };
  walk(0);
  return least;
}

}  // namespace

TEST_CASE("no way of turning has a smaller largest deviation, and none is worse than the program") {
  std::mt19937 random(5);
  int turned = 0;
  for (int trial = 0; trial < 40; ++trial) {
    CAPTURE(trial);
    const SpinGraph graph = random_graph(random, 5);
    const double programmed = largest_deviation(graph, std::vector<int>(5, spin_zero));
    const std::vector<int> turns = best_turns(graph);
    const double largest = largest_deviation(graph, turns);
    CHECK(largest <= programmed);
    CHECK(largest <= least_of_all(graph) + least_spin_gain * programmed + 1e-12);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (!graph.stops[i].is_free) CHECK(turns[i] == spin_zero);
      if (i > 0) CHECK(std::abs(turns[i] - turns[i - 1]) <= graph.stops[i].most_steps);
      turned += turns[i] != spin_zero;
    }
  }
  CHECK(turned > 40);
}

TEST_CASE("a deviation that does not depend on the turn leaves the program as it is") {
  SpinGraph graph;
  for (int i = 0; i < 4; ++i) {
    graph.places.push_back({1, i == 0 ? 0 : 0.01});
    graph.deviations.insert(graph.deviations.end(), spin_count, 1e-3F);
    graph.stops.push_back(
        {.linked = i > 0, .is_free = true, .most_steps = 2, .places_end = graph.places.size()});
  }
  CHECK(best_turns(graph) == std::vector<int>(4, spin_zero));
  graph.deviations.assign(graph.deviations.size(), 0);
  CHECK(best_turns(graph) == std::vector<int>(4, spin_zero));
}

TEST_CASE(
    "turns that gain less than a hundredth of the largest deviation are not taken, also for a smaller mean") {
  const auto turns_for = [](float share) {
    SpinGraph graph;
    for (std::size_t i = 0; i < 3; ++i) {
      graph.places.push_back({1, i == 0 ? 0 : 0.1});
      for (int turn = 0; turn < spin_count; ++turn) {
        const float mean = i == 1 ? 0.2F : 1;  // of the turned tool
        graph.deviations.push_back(1e-3F * (turn == spin_zero ? 1 : mean * share));
      }
      graph.stops.push_back(
          {.linked = i > 0, .is_free = true, .most_steps = spin_count, .places_end = graph.places.size()});
    }
    return best_turns(graph);
  };
  CHECK(turns_for(0.995F) == std::vector<int>(3, spin_zero));
  CHECK(turns_for(0.98F) != std::vector<int>(3, spin_zero));
}
