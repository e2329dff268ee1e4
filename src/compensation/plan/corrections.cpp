#include "compensation/plan/corrections.hpp"

#include <algorithm>
#include <tuple>

#include "compensation/solve/failures.hpp"

namespace counterflex {

Answer Corrections::ask(std::size_t segment, double u, const Vector6& F, Side side) {
  const Segment& on = job_.path.segments[segment];
  const TargetRequest request{&model_of(job_, on), point_at(on.wanted, u), F, orientation_at(on, u),
                              directions_at(job_, on.move, u, side)};
  if (!requests_.empty() && requests_.back() == request) return requests_.size() - 1;
  requests_.push_back(request);
  segments_.push_back(segment);
  return requests_.size() - 1;
}

std::optional<Failure> Corrections::failure_of(Answer a) const {
  const Segment& segment = job_.path.segments[segments_[a]];
  const TargetAnswer& answer = answers_[a];
  if (answer.status != Status::converged) return status_failure(job_, answer.status, segment, answer.target);
  if (auto failure = turn_limit_failure(job_, answer.turn, segment.line)) return failure;
  const Vector3 shift = shift_of(correction(a)) + job_.path.frames[segment.frame].datum_shift;
  return limit_failure(job_, shift, segment.line);
}

void Corrections::solve() {
  const std::size_t first = answers_.size();
  answers_.resize(requests_.size());
  solver_.targets(std::span(requests_).subspan(first), std::span(answers_).subspan(first));
  for (Answer a = first; a < answers_.size(); ++a) {
    if (segments_[a] >= end_) continue;
    auto failure = failure_of(a);
    if (!failure) continue;
    failure_ = std::move(failure);
    end_ = segments_[a];
  }
}

namespace {

constexpr double smallest_interval =
    1e-5;  // a fraction: a step that is not known as one is not searched further

// A second difference below the accuracy: the line is the curve.
bool is_line(const Corrections& corrections, const Interval& i, double accuracy) {
  const Correction chord = (corrections.correction(i.at[0]) + corrections.correction(i.at[4])) / 2;
  return (corrections.correction(i.at[2]) - chord).norm() < accuracy;
}

// The parabola through three of the nodes has the accuracy at the other two: all five together are better.
bool is_predicted(const Corrections& corrections, const Interval& i, double accuracy) {
  if (i.u[4] - i.u[0] < smallest_interval) return true;
  CurveInterval parabola;
  for (const std::size_t k : {0u, 2u, 4u}) parabola.push_back(corrections.node(i.u[k], i.at[k]));
  const auto miss = [&](std::size_t k) {
    return (polynomial_at(parabola, i.u[k]) - corrections.correction(i.at[k])).norm();
  };
  return std::max(miss(1), miss(3)) < accuracy;
}

Interval part_of(const Interval& i, std::size_t k) {
  const double a = i.u[k], m = i.u[k + 1], b = i.u[k + 2];
  return {.segment = i.segment,
          .u = {a, (a + m) / 2, m, (m + b) / 2, b},
          .at = {i.at[k], no_answer, i.at[k + 1], no_answer, i.at[k + 2]},
          .by_quarters = true};
}

}  // namespace

Interval open_interval(Corrections& corrections, std::size_t segment, double u0, Answer a, double u1,
                       const Vector6& F, bool may_wave) {
  const double m = (u0 + u1) / 2;
  Interval i{.segment = segment, .u = {u0, (u0 + m) / 2, m, (m + u1) / 2, u1}, .by_quarters = may_wave};
  i.at[0] = a;
  for (const std::size_t k : {1u, 2u, 3u})
    if (may_wave || k == 2) i.at[k] = corrections.ask(segment, i.u[k], Side::after);
  i.at[4] = corrections.ask(segment, u1, F, Side::before);
  return i;
}

std::vector<Interval> refine(Corrections& corrections, std::vector<Interval> open, double accuracy) {
  std::vector<Interval> done;
  corrections.solve();
  while (!open.empty()) {
    std::vector<Interval> bent;
    for (Interval& i : open) {
      if (i.segment >= corrections.end()) continue;
      if (!i.by_quarters && is_line(corrections, i, accuracy)) {
        done.push_back(i);
        continue;
      }
      for (const std::size_t k : {1u, 3u})
        if (i.at[k] == no_answer) i.at[k] = corrections.ask(i.segment, i.u[k], Side::after);
      bent.push_back(i);
    }
    corrections.solve();
    open.clear();
    for (const Interval& i : bent) {
      if (i.segment >= corrections.end()) continue;
      if (is_predicted(corrections, i, accuracy)) {
        done.push_back(i);
        continue;
      }
      for (const std::size_t k : {0u, 2u}) open.push_back(part_of(i, k));
    }
  }
  std::sort(done.begin(), done.end(), [](const Interval& i, const Interval& j) {
    return std::tie(i.segment, i.u[0]) < std::tie(j.segment, j.u[0]);
  });
  return done;
}

CurveInterval nodes_of(const Corrections& corrections, const Interval& interval) {
  CurveInterval result;
  for (std::size_t k = 0; k < 5; ++k)
    if (interval.at[k] != no_answer) result.push_back(corrections.node(interval.u[k], interval.at[k]));
  return result;
}

}  // namespace counterflex
