#pragma once
/// Corrections that are asked for in waves: many requests, then all their answers.
#include <vector>

#include "curve.hpp"
#include "waypoint_solver.hpp"

namespace counterflex {

/// Number of an answer.
using Answer = std::size_t;
inline constexpr Answer no_answer = static_cast<Answer>(-1);

class TargetWaves {
 public:
  TargetWaves(const Job& job, WaypointSolver& solver) : job_(job), solver_(solver) {}

  /// Forgets everything that was asked; about so many requests will come.
  void clear(std::size_t requests);

  /// Asks for the correction at a fraction of a segment. What was asked just before at the same place and
  /// with the same force, as the end of the segment that this one joins, is not asked again.
  Answer ask(std::size_t segment, double u, Side side = Side::after);

  /// Asks for the correction at the end of a segment under the force there.
  Answer ask_end(std::size_t segment, const Vector6& F);

  /// Asks for the correction inside a line.
  Answer ask_inside(std::size_t segment, double u);

  /// Asks for the correction at the end of a segment under a force that need not act. It may fail.
  Answer ask_apart(std::size_t segment, const Vector6& F);

  /// Solves what has been asked since the last time. False where something that must not fail did: not
  /// converged, or larger than the limit of corrections.
  bool solve();

  Status status(Answer a) const { return solutions_[a].status; }
  Vector3 correction(Answer a) const { return solutions_[a].target - requests_[a].p_MT; }  ///< M (m)
  Vector3 target(Answer a) const { return solutions_[a].target; }                          ///< M (m)
  const Vector6& force(Answer a) const { return requests_[a].load.F; }
  CurveNode node(double u, Answer a) const { return {u, correction(a)}; }

  /// The force at a fraction of a segment.
  Vector6 force_at(std::size_t segment, double u, Side side = Side::after) {
    return job_.forces.at(segment, u, side, cursor_);
  }
  void breaks(std::size_t segment, std::vector<double>& fractions) {
    job_.forces.breaks(segment, cursor_, fractions);
  }

  const std::optional<Failure>& failure() const { return failure_; }
  WaypointSolver& solver() { return solver_; }

 private:
  Answer add(std::size_t segment, const Vector3& p_MT, const Vector6& F);
  bool check(Answer a);

  const Job& job_;
  WaypointSolver& solver_;
  ForceCursor cursor_;
  std::vector<TargetRequest> requests_;
  std::vector<TargetSolution> solutions_;
  std::vector<std::size_t> segments_;        // of the requests; no_segment for what may fail
  Answer last_ = no_answer;                  // of what was asked in the order of the path
  std::optional<Failure> failure_;
};

}  // namespace counterflex
