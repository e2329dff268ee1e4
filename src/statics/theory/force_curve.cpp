#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/statics/tip_stiffness.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/solve/by_parts.hpp"
#include "statics/solve/newton.hpp"

namespace counterflex {
namespace {

// How many states of the longer side are judged at least.
constexpr int judged_parts = 64;

// An equilibrium with the tip at a displacement, and the step of everything per metre of it.
struct State {
  double displacement = 0, force = 0;
  Configuration configuration;
  WholeStep tangent;
  double stiffness = 0;
};

class Follower {
 public:
  Follower(const Model& model, const CurveRequest& request, const Vector3& p_free, StaticsWork::Impl& work)
      : model_(model), request_(request), p_free_(p_free), work_(work), units_{model.mechanism.length} {}

  // Newton's method from a state near the solution; fills tangent and stiffness.
  bool solve(State& state) const {
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_newton_steps; ++i) {
      evaluate_all(model_, state.configuration, Stage{}, work_);
      WholeSystem system = whole_system(model_, state.configuration, problem(state), work_);
      const double missing = state.displacement - displacement_of(state.configuration);
      if (last <= step_tolerance && is_solved(state, missing)) {
        system.gradient.setZero();
        system.gap.setZero();
        state.tangent = solve_whole(system, along_tip(state.configuration.X_MP, 1), units_);
        state.stiffness = state.tangent.forces[0];
        return true;
      }
      const WholeStep step = solve_whole(system, along_tip(state.configuration.X_MP, missing), units_);
      state.force += step.forces[0];
      last = apply(model_.mechanism, step, units_, state.configuration);
      if (!std::isfinite(last)) return false;
    }
    return false;
  }

  // From a state along its tangent to another displacement; nothing where that ends on another branch.
  std::optional<State> advanced(const State& from, double displacement) const {
    const double way = displacement - from.displacement;
    State next{displacement, from.force + from.stiffness * way, from.configuration, {}, 0};
    WholeStep step = from.tangent;
    step.variables *= way;
    step.wrenches *= way;
    const double size = apply(model_.mechanism, step, units_, next.configuration);
    const Configuration foreseen = next.configuration;
    if (!std::isfinite(size) || !solve(next) ||
        ends_elsewhere(model_.mechanism, from.configuration, foreseen, next.configuration))
      return std::nullopt;
    return next;
  }

  bool is_stable(const State& state) const {
    return judge_stability(model_, state.configuration, problem(state), work_).stable;
  }

  CurvePoint point(const State& state) const {
    return {state.displacement, state.force, state.stiffness, is_stable(state),
            tip(model_.mechanism, state.configuration)};
  }

 private:
  Problem problem(const State& state) const {
    Load load = request_.load;
    load.F.head<3>() += state.force * request_.direction;
    return {load, Stage{}, nullptr};
  }

  // d'T dxi = missing, met by a force along d at the tip: its wrench at the reference point is T'd.
  Controlled along_tip(const Pose& X_MP, double missing) const {
    const Vector6 along =
        tip_from_platform(model_.mechanism, X_MP).topRows<3>().transpose() * request_.direction;
    Controlled controlled{.by_forces = true};
    controlled.rows = along.cwiseProduct(units_.of_pose()).transpose() / units_.length;
    controlled.rhs.setConstant(1, missing / units_.length);
    return controlled;
  }

  double displacement_of(const Configuration& configuration) const {
    return request_.direction.dot(tip(model_.mechanism, configuration).p - p_free_);
  }

  bool is_solved(const State& state, double missing) const {
    return std::abs(missing) <= closure_tolerance &&
           counterflex::is_solved(model_.mechanism, state.configuration.X_MP,
                                  residual_of(model_, state.configuration, problem(state), work_));
  }

  const Model& model_;
  const CurveRequest& request_;
  Vector3 p_free_;
  StaticsWork::Impl& work_;
  Units units_;
};

// The next state, in smaller parts of the way where it is not found at once.
std::optional<State> followed(const Follower& follower, State now, double displacement) {
  const double start = now.displacement;
  const bool arrived = by_parts(1, smallest_part, [&](double, double to) {
    auto next = follower.advanced(now, to < 1 ? start + to * (displacement - start) : displacement);
    if (next) now = std::move(*next);
    return next.has_value();
  });
  return arrived ? std::optional(std::move(now)) : std::nullopt;
}

// Halves the way from a stable to an unstable state.
State critical_between(const Follower& follower, State stable, State unstable) {
  const double size = std::max(std::abs(stable.displacement), std::abs(unstable.displacement));
  while (std::abs(unstable.displacement - stable.displacement) > bracket * size) {
    const auto middle = followed(follower, stable, (stable.displacement + unstable.displacement) / 2);
    if (!middle) break;
    (follower.is_stable(*middle) ? stable : unstable) = *middle;
  }
  return stable;
}

// From the state without the force to one side, through those of `displacements`, which grow in size. Whether
// all were found. Between them states are judged that are at most a part of the side apart: a truss snaps
// through between two states that are stable.
bool follow_side(const Follower& follower, const State& free, double side,
                 const std::vector<double>& displacements, ForceCurve& curve) {
  State now = free;
  bool stable = true;
  for (const double displacement : displacements) {
    if (!(side * displacement > 0)) continue;
    const double start = now.displacement, way = displacement - start;
    const int parts = static_cast<int>(std::ceil(judged_parts * std::abs(way / displacements.back())));
    for (int k = 1; k <= parts; ++k) {
      auto next = followed(follower, now, k == parts ? displacement : start + way * k / parts);
      if (!next) return false;
      if (stable && !follower.is_stable(*next)) {
        curve.critical.push_back(follower.point(critical_between(follower, now, *next)));
        stable = false;
      }
      now = std::move(*next);
    }
    curve.points.push_back(follower.point(now));
  }
  return true;
}

}  // namespace

ForceCurve force_curve(const Model& model, const Configuration& nominal, const CurveRequest& request,
                       StaticsWork& work) {
  ForceCurve curve;
  const Equilibrium loaded = solve_forward(model, nominal, request.load, Stage{}, work);
  curve.status = loaded.status;
  if (loaded.status != Status::converged) return curve;
  const Follower follower(model, request, tip(model.mechanism, loaded.configuration).p, work.impl());
  const auto compliance = compliance_at_tip(model, loaded.configuration, request.load, Stage{}, work);
  State free{0, 0, loaded.configuration, {}, 0};
  if (compliance) free.stiffness = stiffness_along(*compliance, request.direction);
  curve.rigid = std::isinf(free.stiffness);
  if (!curve.rigid && !follower.solve(free)) {
    curve.status = Status::not_converged;
    return curve;
  }
  std::vector<double> displacements;
  for (int i = 0; i < request.steps; ++i)
    displacements.push_back(request.from + i * (request.to - request.from) / request.steps);
  displacements.push_back(request.to);
  std::ranges::sort(displacements, {}, [](double d) { return std::abs(d); });
  if (displacements.front() == 0) curve.points.push_back(follower.point(free));
  if (curve.rigid) {
    if (displacements.back() != 0) curve.status = Status::singular;
    return curve;
  }
  for (const double side : {-1.0, 1.0})
    if (!follow_side(follower, free, side, displacements, curve)) curve.status = Status::not_converged;
  std::ranges::sort(curve.points, {}, &CurvePoint::displacement);
  return curve;
}

}  // namespace counterflex
