#include "counterflex/statics/tip_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "statics/model/tolerances.hpp"
#include "statics/solve/judge.hpp"

namespace counterflex {
namespace {

constexpr int most_iterations = 25;
constexpr double smallest_part = 1.0 / 4096;  // of the way between two points
constexpr double bracket = 1e-9;              // of the displacement of a critical state
constexpr double force_unit = 1e6;            // N for a unit step of the force's variable

// An equilibrium with the tip at a displacement, and the step of everything per metre of it.
struct State {
  double displacement = 0, force = 0;
  Configuration configuration;
  WholeStep tangent;
  double stiffness = 0;
};

// The whole system with actuators held and the force as one more unknown, before the platform's variables.
struct Augmented {
  WholeSystem system;
  std::vector<int> kept;  // by variable before the force: its number in the whole system
  int all = 0;            // variables of the whole system
};

Augmented augmented(const WholeSystem& whole, const Vector6& along, const Units& units) {
  Augmented result;
  result.all = static_cast<int>(whole.variables.size());
  std::vector<int> from, to;
  for (int i = 0; i < result.all; ++i) {
    if (whole.variables[i].actuator >= 0) continue;
    to.push_back(static_cast<int>(from.size()) + (i < whole.pose ? 0 : 1));
    from.push_back(i);
    if (i < whole.pose) result.kept.push_back(i);
  }
  const auto force = static_cast<int>(result.kept.size()), n = force + 7;
  WholeSystem& system = result.system;
  system.pose = force + 1;
  system.variables.resize(n);
  system.A.setZero(n, n);
  system.C.setZero(whole.C.rows(), n);
  system.gradient.setZero(n);
  system.gap = whole.gap;
  for (std::size_t i = 0; i < from.size(); ++i) system.variables[to[i]] = whole.variables[from[i]];
  system.A(to, to) = whole.A(from, from);
  system.C(Eigen::all, to) = whole.C(Eigen::all, from);
  system.gradient(to) = whole.gradient(from);
  system.variables[force] = {false, false, 0};  // no stationarity: the displacement is given in its place
  system.A.block<6, 1>(system.pose, force) =
      -along.cwiseProduct(units.of_pose()) * force_unit * units.length / units.energy();
  return result;
}

// A step of the augmented system as one of the whole system, and of the force (N).
std::pair<WholeStep, double> split(const WholeStep& step, const Augmented& of) {
  WholeStep whole{Eigen::VectorXd::Zero(of.all), step.wrenches, step.redundant};
  for (std::size_t i = 0; i < of.kept.size(); ++i) whole.variables[of.kept[i]] = step.variables[static_cast<Eigen::Index>(i)];
  whole.variables.tail<6>() = step.variables.tail<6>();
  return {whole, force_unit * step.variables[of.system.pose - 1]};
}

class Follower {
 public:
  Follower(const Model& model, const CurveRequest& request, const Vector3& p_free, StaticsWork::Impl& work)
      : model_(model), request_(request), p_free_(p_free), work_(work), units_{model.mechanism.length} {}

  // Newton's method from a state near the solution; fills tangent and stiffness.
  bool solve(State& state) const {
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_iterations; ++i) {
      evaluate_all(model_, state.configuration, Stage{}, work_);
      const Vector6 along = direction_at_platform(state.configuration.X_MP);
      Augmented equations = augmented(whole_system(model_, state.configuration, problem(state), work_), along, units_);
      const double missing = state.displacement - displacement_of(state.configuration);
      if (last <= step_tolerance && is_solved(state, missing)) {
        equations.system.gradient.setZero();
        equations.system.gap.setZero();
        std::tie(state.tangent, state.stiffness) = split(solve_whole(equations.system, along_tip(along, 1), units_), equations);
        return true;
      }
      const auto [step, force] = split(solve_whole(equations.system, along_tip(along, missing), units_), equations);
      state.force += force;
      last = apply(model_.mechanism, step, units_, state.configuration);
      if (!std::isfinite(last)) return false;
    }
    return false;
  }

  // From a state along its tangent to another displacement.
  std::optional<State> advanced(const State& from, double displacement) const {
    const double way = displacement - from.displacement;
    State next{displacement, from.force + from.stiffness * way, from.configuration, {}, 0};
    WholeStep step = from.tangent;
    step.variables *= way;
    step.wrenches *= way;
    const double foreseen = apply(model_.mechanism, step, units_, next.configuration);
    const Pose X_foreseen = next.configuration.X_MP;
    if (!std::isfinite(foreseen) || !solve(next)) return std::nullopt;
    const Vector6 surplus = difference(next.configuration.X_MP, X_foreseen).cwiseQuotient(units_.of_pose());
    if (surplus.norm() > jump_floor && surplus.norm() * units_.length > 0.5 * foreseen) return std::nullopt;  // another branch
    return next;
  }

  bool is_stable(const State& state) const {
    return judge_stability(model_, state.configuration, problem(state), work_).stable;
  }

  CurvePoint point(const State& state) const {
    return {state.displacement, state.force, state.stiffness, is_stable(state), tip(model_.mechanism, state.configuration)};
  }

 private:
  Problem problem(const State& state) const {
    Load load = request_.load;
    load.F.head<3>() += state.force * request_.direction;
    return {load, Stage{}, nullptr};
  }

  // The unit force at the tip as a wrench at the reference point; also d(displacement) per twist of that point.
  Vector6 direction_at_platform(const Pose& X_MP) const {
    Vector6 along = Vector6::Zero();
    along.head<3>() = request_.direction;
    return wrench_at(along, X_MP.R * model_.mechanism.X_PT.p);
  }

  Controlled along_tip(const Vector6& along, double missing) const {
    Controlled controlled{ControlledRows(1, 6), ControlledValues(1)};
    controlled.rows.row(0) = along.cwiseProduct(units_.of_pose()).transpose() / units_.length;
    controlled.rhs[0] = missing / units_.length;
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
  const double way = displacement - now.displacement;
  double part = 1;
  while (now.displacement != displacement) {
    const double left = displacement - now.displacement;
    const bool last = std::abs(part * way) >= std::abs(left);
    if (auto next = follower.advanced(now, last ? displacement : now.displacement + part * way))
      now = std::move(*next);
    else if ((part /= 2) < smallest_part)
      return std::nullopt;
  }
  return now;
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

// From the state without the force through `displacements`, which grow in size. Whether all were found.
bool follow_side(const Follower& follower, const State& free, const std::vector<double>& displacements, ForceCurve& curve) {
  State now = free;
  bool stable = true;
  for (const double displacement : displacements) {
    auto next = followed(follower, now, displacement);
    if (!next) return false;
    curve.points.push_back(follower.point(*next));
    if (stable && !curve.points.back().stable) {
      curve.critical.push_back(follower.point(critical_between(follower, now, *next)));
      stable = false;
    }
    now = std::move(*next);
  }
  return true;
}

}  // namespace

ForceCurve force_curve(const Model& model, const Configuration& nominal, const CurveRequest& request, StaticsWork& work) {
  ForceCurve curve;
  const Equilibrium loaded = solve_forward(model, nominal, request.load, Stage{}, work);
  curve.status = loaded.status;
  if (loaded.status != Status::converged) return curve;
  const Follower follower(model, request, tip(model.mechanism, loaded.configuration).p, work.impl());
  State free{0, 0, loaded.configuration, {}, 0};
  if (!follower.solve(free)) {
    curve.status = Status::not_converged;
    return curve;
  }
  std::vector<double> below, above;
  bool with_free = false;
  for (int i = 0; i <= request.steps; ++i) {
    const double d = i == request.steps ? request.to : request.from + i * (request.to - request.from) / request.steps;
    if (d == 0) with_free = true;
    else (d < 0 ? below : above).push_back(d);
  }
  for (auto* side : {&below, &above})
    std::sort(side->begin(), side->end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (with_free) curve.points.push_back(follower.point(free));
  for (const auto* side : {&below, &above})
    if (!follow_side(follower, free, *side, curve)) curve.status = Status::not_converged;
  std::sort(curve.points.begin(), curve.points.end(),
            [](const CurvePoint& a, const CurvePoint& b) { return a.displacement < b.displacement; });
  return curve;
}

}  // namespace counterflex
