#include "interval_waves.hpp"

#include <algorithm>
#include <tuple>

namespace counterflex {
namespace {

constexpr double smallest_interval = 1e-5;

}  // namespace

void IntervalWaves::clear() {
  open_.clear();
  done_.clear();
}

Answer IntervalWaves::open(std::size_t segment, IntervalEnd a, IntervalEnd b, bool may_wave) {
  const double m = (a.u + b.u) / 2;
  SampledInterval i{
      .segment = segment, .u = {a.u, (a.u + m) / 2, m, (m + b.u) / 2, b.u}, .by_quarters = may_wave};
  i.at[0] = a.at;
  if (may_wave) i.at[1] = waves_.ask(segment, i.u[1]);
  i.at[2] = waves_.ask(segment, i.u[2]);
  if (may_wave) i.at[3] = waves_.ask(segment, i.u[3]);
  const auto ask_b = [&] {
    return b.u == 1 ? waves_.ask_end(segment, waves_.force_at(segment, 1, Side::before))
                    : waves_.ask(segment, b.u, Side::before);
  };
  i.at[4] = b.at == no_answer ? ask_b() : b.at;
  open_.push_back(i);
  return i.at[4];
}

// A second difference far below the accuracy: the line is the curve.
bool IntervalWaves::is_line(const SampledInterval& i) const {
  const Vector3 chord = (waves_.correction(i.at[0]) + waves_.correction(i.at[4])) / 2;
  return (waves_.correction(i.at[2]) - chord).norm() < accuracy_ / 4;
}

// The five nodes together are better than the parabola by about an order: 8 times is asked of it.
bool IntervalWaves::is_predicted(const SampledInterval& i) const {
  if (i.u[4] - i.u[0] < smallest_interval) return true;
  std::vector<CurveNode> parabola;
  for (const std::size_t k : {0u, 2u, 4u}) parabola.push_back(waves_.node(i.u[k], i.at[k]));
  const auto miss = [&](std::size_t k) {
    return (polynomial_at(parabola, i.u[k]) - waves_.correction(i.at[k])).norm();
  };
  return std::max(miss(1), miss(3)) < 8 * accuracy_;
}

void IntervalWaves::ask_quarters() {
  next_.clear();
  for (SampledInterval& i : open_) {
    if (!i.by_quarters && is_line(i)) {
      done_.push_back(i);
      continue;
    }
    for (const std::size_t k : {1u, 3u})
      if (i.at[k] == no_answer) i.at[k] = waves_.ask(i.segment, i.u[k]);
    next_.push_back(i);
  }
  open_.swap(next_);
}

void IntervalWaves::halve(const SampledInterval& i) {
  for (const std::size_t k : {0u, 2u}) {
    const double a = i.u[k], m = i.u[k + 1], b = i.u[k + 2];
    next_.push_back({.segment = i.segment,
                     .u = {a, (a + m) / 2, m, (m + b) / 2, b},
                     .at = {i.at[k], no_answer, i.at[k + 1], no_answer, i.at[k + 2]},
                     .by_quarters = true});
  }
}

bool IntervalWaves::run() {
  while (!open_.empty()) {
    ask_quarters();
    if (!waves_.solve()) return false;
    next_.clear();
    for (const SampledInterval& i : open_)
      if (is_predicted(i))
        done_.push_back(i);
      else
        halve(i);
    open_.swap(next_);
  }
  std::sort(done_.begin(), done_.end(), [](const SampledInterval& i, const SampledInterval& j) {
    return std::tie(i.segment, i.u[0]) < std::tie(j.segment, j.u[0]);
  });
  return true;
}

CurveInterval IntervalWaves::curve(const SampledInterval& interval) const {
  CurveInterval result;
  for (std::size_t k = 0; k < 5; ++k)
    if (interval.at[k] != no_answer) result.nodes.push_back(waves_.node(interval.u[k], interval.at[k]));
  return result;
}

}  // namespace counterflex
