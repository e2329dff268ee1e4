#include "counterflex/report/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/spectrum.hpp"
#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/mechanism.hpp"
#include "counterflex/statics/theory.hpp"
#include "counterflex/statics/tip_stiffness.hpp"

namespace counterflex {

namespace {

constexpr Stage everything{};

// The solution at one pose, by any method.
struct Solved {
  Status status;
  Vector6 deviation;
  Configuration configuration;  // of the loads
  Configuration stiff;          // of the stiffness
  Stage stiff_stage;
  Vector6 weakest;
  bool indeterminate = false;
};

Status with_travel(const Mechanism& mechanism, const Eigen::VectorXd& rho, Status status) {
  if (status == Status::converged && !within_travel(mechanism, rho)) return Status::outside_travel;
  return status;
}

std::string words(Status status, bool nominal) {
  switch (status) {
    case Status::converged:
      return "";
    case Status::not_converged:
      return "the iteration did not converge";
    case Status::unreachable:
      return "the perfect machine cannot reach the pose from home";
    case Status::singular:
      return nominal ? "the perfect machine is singular here or on the way from home"
                     : "the static system is singular";
    case Status::unstable:
      return "the equilibrium is unstable, here or as the load grows";
    case Status::outside_travel:
      return "an actuator leaves its range";
  }
  return "";
}

Solved solve_linear(const Model& model, const Configuration& nominal, const Load& load, StaticsWork& work) {
  const LinearResult linear = linear_deviation(model, nominal, load, everything, work);
  return {linear.status, linear.dt_T, linear.configuration, nominal, nominal_stage, Vector6::Zero()};
}

Solved solve_finite(const Model& model, const Configuration& nominal, const Pose& X_MT, const Load& load,
                    StaticsWork& work) {
  Equilibrium loaded = solve_forward(model, nominal, load, everything, work);
  if (loaded.status == Status::converged && !load.F.isZero(0) &&
      !is_reached_by_load_alone(model, nominal, load, everything, loaded, work))
    loaded.status = Status::unstable;
  const Vector6 d = deviation(tip(model.mechanism, loaded.configuration), X_MT);
  return {loaded.status,       d, loaded.configuration, loaded.configuration, everything, loaded.weakest,
          loaded.indeterminate};
}

bool is_preloaded(const Model& model, const Configuration& nominal) {
  constexpr double rounding = 1e-15;  // J: 1e-12 rad or m of the stiffest springs of passive joints
  for (std::size_t i = 0; i < nominal.chains.size(); ++i)
    if (elastic_energy(model.mechanism.chains[i], nominal.chains[i], everything) > rounding) return true;
  return false;
}

CorrectedTarget corrected_linearly(const Model& model, const Configuration& nominal, const Pose& X_MT,
                                   const Load& load, StaticsWork& work) {
  CorrectedTarget result;
  const LinearResult linear = linear_deviation(model, nominal, load, everything, work);
  result.status = linear.status;
  if (linear.status != Status::converged) return result;
  result.X_MT = linear_target(model, X_MT, linear);
  const NominalResult commanded = follow(model, nominal, result.X_MT);
  result.status = commanded.status;
  if (commanded.status == Status::converged)
    result.rho = actuator_values(model.mechanism, commanded.configuration);
  return result;
}

CorrectedTarget corrected_finitely(const Model& model, const Configuration& nominal, const Pose& X_MT,
                                   const Load& load, Method method, StaticsWork& work) {
  const auto solve = method == Method::nested ? solve_target_nested : solve_target;
  const Equilibrium solved = solve(model, nominal, X_MT, load, everything, work);
  CorrectedTarget result;
  result.status = solved.status;
  if (solved.status != Status::converged) return result;
  result.rho = actuator_values(model.mechanism, solved.configuration);
  const NominalResult commanded = nominal_forward(model, nominal, result.rho);
  result.status = commanded.status;
  if (commanded.status == Status::converged) result.X_MT = tip(model.mechanism, commanded.configuration);
  return result;
}

CorrectedTarget corrected_target(const Model& model, const Configuration& nominal, const Pose& X_MT,
                                 const Load& load, Method method, StaticsWork& work) {
  CorrectedTarget result = method == Method::linear
                               ? corrected_linearly(model, nominal, X_MT, load, work)
                               : corrected_finitely(model, nominal, X_MT, load, method, work);
  result.status = with_travel(model.mechanism, result.rho, result.status);
  return result;
}

// The unit twist (lengths in units of `length`) of least energy, and its stiffness in N/m.
void find_weakest(const Matrix6& K, double length, PoseAnalysis& result) {
  Vector6 units = Vector6::Ones();
  units.tail<3>().setConstant(1 / length);
  const Matrix6 scaled = units.asDiagonal() * K * units.asDiagonal();
  const Spectrum stiffnesses = spectrum((scaled + scaled.transpose()) / 2);
  result.weakest = stiffnesses.vectors.col(0);
  result.weakest_stiffness = stiffnesses.values[0];
  Eigen::Index largest = 0;
  result.weakest.cwiseAbs().maxCoeff(&largest);
  if (result.weakest[largest] < 0) result.weakest = -result.weakest;  // the sign of an eigenvector is free
}

void describe(const Mechanism& machine, const Model& model, const Solved& solved, const Load& load,
              StaticsWork& work, PoseAnalysis& result) {
  result.deviation = solved.deviation;
  result.chains = loads(machine, model, solved.configuration);
  const ManipulatorStiffness sum = stiffness(model, solved.stiff, solved.stiff_stage, work);
  result.K = sum.K;
  result.stiffness_available = sum.available;
  if (sum.available) find_weakest(sum.K, model.mechanism.length, result);
  const Load acting = result.method == Method::linear ? Load{} : load;
  result.tip_compliance = compliance_at_tip(model, solved.stiff, acting, solved.stiff_stage, work);
  if (result.tip_compliance) {
    if (const SoftestDirection softest = softest_direction(*result.tip_compliance);
        std::isfinite(softest.stiffness)) {
      result.softest = softest.direction;
      result.softest_stiffness = softest.stiffness;
    }
    result.tip_stiffness = inverse_compliance(*result.tip_compliance, model.mechanism.length);
  }
  result.condition = static_condition(model, solved.stiff, acting, solved.stiff_stage, work);
  result.stability = stability(model, solved.stiff, acting, solved.stiff_stage, work);
}

HeldPose hold(const Model& model, const Configuration& nominal, const Pose& X_MT, StaticsWork& work) {
  HeldPose result{X_MT};
  const HeldPlatform held =
      hold_platform(model, nominal, X_MT * inverse(model.mechanism.X_PT), everything, work);
  result.status = held.status;
  if (held.status != Status::converged) {
    result.why =
        fmt::format("chain {}: {}", model.mechanism.chains[held.chain].name,
                    held.status == Status::singular
                        ? "it has no stiffness in some direction, so its end cannot be held at every pose"
                        : "its equilibrium was not found; choose a pose nearer to the wanted one");
    return result;
  }
  result.chains =
      chain_details(model, nominal, held.configuration, difference(held.configuration.X_MP, nominal.X_MP),
                    {held.configuration, everything}, work);
  result.at_platform = holding_wrench(held.configuration);
  result.at_tip = holding_wrench_at_tip(model.mechanism, held.configuration);
  return result;
}

void add_extras(const Model& model, const Configuration& nominal, const Load& load,
                const AnalysisExtras& extras, StaticsWork& work, PoseAnalysis& result) {
  if (extras.hold) result.held = hold(model, nominal, *extras.hold, work);
  if (!extras.curve) return;
  CurveRequest request = *extras.curve;
  request.load = load;
  result.curve = force_curve(model, nominal, request, work);
}

}  // namespace

PoseAnalysis analyze_pose(const Model& model, const Pose& X_MT, const Load& load, Method method,
                          const AnalysisExtras& extras) {
  StaticsWork work(model.mechanism);
  PoseAnalysis result;
  result.X_MT = X_MT;
  result.method = method;
  const NominalResult nominal = follow(model, model.home, X_MT);
  result.status = nominal.status;
  result.why = words(nominal.status, true);
  if (nominal.status != Status::converged) return result;
  result.X_MT = tip(model.mechanism, nominal.configuration);
  result.rho = actuator_values(model.mechanism, nominal.configuration);
  result.preloaded = is_preloaded(model, nominal.configuration);
  const Solved solved = method == Method::linear
                            ? solve_linear(model, nominal.configuration, load, work)
                            : solve_finite(model, nominal.configuration, result.X_MT, load, work);
  result.status = with_travel(model.mechanism, result.rho, solved.status);
  result.why = words(result.status, false);
  if (result.status == Status::outside_travel)
    if (const auto axis = tightest_axis(model.mechanism, result.rho))
      result.why = outside_travel_words(model.mechanism.travel[axis->actuator], axis->value);
  if (has_values(result.status)) {
    describe(extras.machine ? *extras.machine : model.mechanism, model, solved, load, work, result);
    if (extras.full)
      result.details = chain_details(model, nominal.configuration, solved.configuration,
                                     difference(solved.configuration.X_MP, nominal.configuration.X_MP),
                                     {solved.stiff, solved.stiff_stage}, work);
  } else {
    result.weakest = solved.weakest;
  }
  add_extras(model, nominal.configuration, load, extras, work, result);
  result.indeterminate = solved.indeterminate;
  if (solved.status == Status::singular && !solved.weakest.isZero(0))
    result.why += fmt::format(
        "; its weakest direction is ({:.3f}, {:.3f}, {:.3f}; {:.3f}, {:.3f}, {:.3f}), lengths in units "
        "of {:.4g} m",
        solved.weakest[0] / model.mechanism.length, solved.weakest[1] / model.mechanism.length,
        solved.weakest[2] / model.mechanism.length, solved.weakest[3], solved.weakest[4], solved.weakest[5],
        model.mechanism.length);
  if (!model.mechanism.controlled.empty())
    result.corrected = corrected_target(model, nominal.configuration, result.X_MT, load, method, work);
  return result;
}

AnalysisReport analyze(const Model& model, const std::vector<Pose>& poses, const Load& load, Method method,
                       const std::string& version, const AnalysisExtras& extras) {
  AnalysisReport report{version, model.mechanism.name, load, model.mechanism.travel, model.mechanism.shown,
                        {}};
  report.weighs = has_weight(model.mechanism);
  report.curve = extras.curve;
  for (const Pose& X_MT : poses) report.poses.push_back(analyze_pose(model, X_MT, load, method, extras));
  report.preloaded = std::ranges::any_of(report.poses, &PoseAnalysis::preloaded);
  return report;
}

}  // namespace counterflex
