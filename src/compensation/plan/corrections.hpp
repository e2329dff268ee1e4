#pragma once
/// Corrections along segments of a path, sampled as closely as they need. They are solved in rounds: many
/// requests, then all their answers.
#include <array>
#include <vector>

#include "compensation/plan/plan.hpp"
#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// Number of a request, and of its answer.
using Answer = std::size_t;
inline constexpr Answer no_answer = static_cast<Answer>(-1);

/// Requests in the order of the path, and the first failure along it: not converged, or a correction above
/// the limit.
class Corrections {
 public:
  Corrections(const Job& job, PlaceSolver& solver) : job_(job), lever_(lever(job.options)), solver_(solver) {}

  /// Requests the correction at a fraction of a segment. A request is shared with the last one if that has
  /// the same place, force and directions.
  Answer ask(std::size_t segment, double u, Side side) {
    return ask(segment, u, force_at(segment, u, side), side);
  }
  Answer ask(std::size_t segment, double u, const Vector6& F, Side side);

  /// The force at a fraction of a segment.
  Vector6 force_at(std::size_t segment, double u, Side side) {
    return job_.forces.at(segment, u, side, cursor_);
  }

  /// Solves what was requested since the last time.
  void solve();

  Correction correction(Answer a) const {
    Correction c;
    c << answers_[a].target - requests_[a].p_MT, lever_ * answers_[a].turn;
    return c;
  }
  const Vector6& force(Answer a) const { return requests_[a].F; }
  CurveNode node(double u, Answer a) const { return {u, correction(a)}; }

  /// Segments from this one on have no valid answers: it fails. `no_segment`: none fails.
  std::size_t end() const { return end_; }
  const std::optional<Failure>& failure() const { return failure_; }

  ForceCursor& cursor() { return cursor_; }
  PlaceSolver& solver() { return solver_; }

 private:
  std::optional<Failure> failure_of(Answer a) const;

  const Job& job_;
  const double lever_;
  PlaceSolver& solver_;
  ForceCursor cursor_;
  std::vector<TargetRequest> requests_;
  std::vector<TargetAnswer> answers_;
  std::vector<std::size_t> segments_;  // of the requests
  std::size_t end_ = no_segment;
  std::optional<Failure> failure_;
};

/// A stretch of a segment without corners inside: its ends a and b, its middle m and its quarters q and r, in
/// the order a q m r b.
struct Interval {
  std::size_t segment = 0;
  std::array<double, 5> u{};
  std::array<Answer, 5> at{no_answer, no_answer, no_answer, no_answer, no_answer};
  bool by_quarters = false;  ///< its middle does not show whether it is a line
};

/// Between two fractions of a segment. Requests what is inside, and its end under the force `F`; `a`: the
/// answer at its start. Where the correction may wave, as around an arc, its quarters are needed too.
Interval open_interval(Corrections& corrections, std::size_t segment, double u0, Answer a, double u1,
                       const Vector6& F, bool may_wave);

/// Halves the intervals until the polynomials through their nodes predict further ones within `accuracy` (m).
/// Sorted by segment and fraction. Those of segments that fail, or are behind one that fails, are left out.
std::vector<Interval> refine(Corrections& corrections, std::vector<Interval> open, double accuracy);

CurveInterval nodes_of(const Corrections& corrections, const Interval& interval);

}  // namespace counterflex
