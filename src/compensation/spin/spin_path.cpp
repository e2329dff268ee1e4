#include "compensation/spin/spin_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>

namespace counterflex {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using Costs = std::array<double, spin_count>;

// The way to a stop: its largest deviation, and the sum of deviation times way.
struct WayCost {
  double largest = 0, sum = 0;
};

class TurnChoice {
 public:
  explicit TurnChoice(const SpinGraph& graph) : graph_(graph) {}

  // The least largest deviation.
  double least_largest() const {
    const auto cost = [&](const Way& way, double before) { return std::max(before, cost_of(way).largest); };
    const Costs costs = walk(cost, nullptr);
    return *std::ranges::min_element(costs);
  }

  // The least sum whose largest deviation is at most `limit`. `programmed`: the largest without turns.
  std::vector<int> least_sum(double limit, double programmed) const {
    const double price = least_spin_gain * programmed;
    const auto cost = [&](const Way& way, double before) {
      const WayCost of_way = cost_of(way);
      if (of_way.largest > limit) return infinite;
      const int changed = way.linked ? std::abs(way.to - way.from) : 0;
      return before + of_way.sum +
             price *
                 ((length_of(way.stop) + between_stops) * std::abs(way.to - spin_zero) +
                  between_stops * changed) /
                 spin_zero;
    };
    std::vector<std::uint8_t> from(graph_.stops.size() * spin_count);
    const Costs costs = walk(cost, &from);
    std::vector<int> turns(graph_.stops.size());
    auto turn = static_cast<int>(std::ranges::min_element(costs) - costs.begin());
    for (std::size_t i = turns.size(); i-- > 0;) {
      turns[i] = turn;
      turn = from[i * spin_count + static_cast<std::size_t>(turn)];
    }
    return turns;
  }

  double largest_of(const std::vector<int>& turns) const {
    double largest = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const bool linked = graph_.stops[i].linked;
      largest = std::max(largest, cost_of({i, linked, linked ? turns[i - 1] : turns[i], turns[i]}).largest);
    }
    return largest;
  }

 private:
  struct Way {
    std::size_t stop = 0;
    bool linked = false;
    int from = spin_zero, to = spin_zero;
  };

  std::span<const SpinPlace> places_to(std::size_t stop) const {
    const std::size_t first = stop == 0 ? 0 : graph_.stops[stop - 1].places_end;
    return std::span(graph_.places).subspan(first, graph_.stops[stop].places_end - first);
  }

  double length_of(std::size_t stop) const {
    double length = 0;
    for (const SpinPlace& place : places_to(stop)) length += place.weight;
    return length;
  }

  // Between two turns of the grid the deviation changes evenly.
  double deviation(const SpinPlace& place, const Way& way) const {
    const std::size_t row = static_cast<std::size_t>(&place - graph_.places.data()) * spin_count;
    const double turn = way.from + (way.to - way.from) * place.fraction;
    const auto lower = static_cast<std::size_t>(turn);
    const double share = turn - static_cast<double>(lower);
    constexpr double nothing = 1e-9;
    if (share < nothing) return graph_.deviations[row + lower];
    if (share > 1 - nothing) return graph_.deviations[row + lower + 1];
    return (1 - share) * graph_.deviations[row + lower] + share * graph_.deviations[row + lower + 1];
  }

  WayCost cost_of(const Way& way) const {
    WayCost cost;
    for (const SpinPlace& place : places_to(way.stop)) {
      const double deviation = this->deviation(place, way);
      if (deviation == infinite) return {infinite, infinite};
      if (place.weight == 0) continue;
      cost.largest = std::max(cost.largest, deviation);
      cost.sum += place.weight * deviation;
    }
    return cost;
  }

  // From stop to stop, the least cost of each turn; `from`: by stop and turn, the turn before.
  template <typename Cost>
  Costs walk(const Cost& cost, std::vector<std::uint8_t>* from) const {
    Costs before{};
    for (std::size_t i = 0; i < graph_.stops.size(); ++i) {
      const SpinStop& stop = graph_.stops[i];
      const auto cheapest = static_cast<int>(std::ranges::min_element(before) - before.begin());
      Costs costs;
      costs.fill(infinite);
      for (int to = 0; to < spin_count; ++to) {
        if (!stop.is_free && to != spin_zero) continue;
        const auto take = [&](int last) {
          const double base = before[last];
          if (base == infinite) return;
          const Way way{i, stop.linked, stop.linked ? last : to, to};
          const double value = cost(way, base);
          double& best = costs[to];
          if (value >= best) return;
          best = value;
          if (from != nullptr)
            (*from)[i * spin_count + static_cast<std::size_t>(to)] = static_cast<std::uint8_t>(last);
        };
        if (!stop.linked) {
          take(cheapest);
          continue;
        }
        const int first = std::max(0, to - stop.most_steps),
                  last = std::min(spin_count - 1, to + stop.most_steps);
        for (int turn = first; turn <= last; ++turn) take(turn);
      }
      before = costs;
    }
    return before;
  }

  const SpinGraph& graph_;
};

}  // namespace

double largest_deviation(const SpinGraph& graph, const std::vector<int>& turns) {
  return TurnChoice(graph).largest_of(turns);
}

std::vector<int> best_turns(const SpinGraph& graph) {
  const TurnChoice choice(graph);
  const std::vector<int> none(graph.stops.size(), spin_zero);
  const double programmed = choice.largest_of(none);
  if (programmed == 0) return none;
  const double least = choice.least_largest(), gain = least_spin_gain * programmed;
  if (least > programmed - gain) return none;
  return choice.least_sum(std::min(least + gain, programmed - gain), programmed);
}

}  // namespace counterflex
