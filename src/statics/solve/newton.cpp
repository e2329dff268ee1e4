#include <Eigen/Geometry>

#include "statics/solve/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace counterflex {
namespace {

constexpr int most_newton_steps = 40;

struct Step {
  double largest = std::numeric_limits<double>::infinity();
};

// Condenses all chains; false where one of them is singular on its own.
bool condense_all(const Model& model, bool with_actuators, const Units& units, StaticsWork::Impl& work) {
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    if (!condense(model.mechanism.chains[i], units, with_actuators, work.chains[i])) return false;
  return true;
}

//     [ sum K - K_load   sum G ] [ dxi  ]   [ F_applied - sum (F + dF) ]
//     [ C_tip            0     ] [ drho ] = [ -error                   ]        in units of `Units`
struct PlatformSystem {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd rhs;
};

// What acts at the platform from outside, at a state.
struct Outside {
  PlatformTerms terms;
  std::optional<Controlled> tip;  ///< where a target is given
};

Outside outside(const Model& model, const Configuration& configuration, const Problem& problem, const Units& units) {
  Outside result{platform_terms(model, configuration, problem), std::nullopt};
  if (problem.X_MT)
    result.tip = to_controlled(tip_equations(model.mechanism, configuration.X_MP, *problem.X_MT), model.mechanism, units);
  return result;
}

PlatformSystem assemble_platform(const Model& model, const Problem& problem, const Outside& acting, const Units& units,
                                 const StaticsWork::Impl& work) {
  const Mechanism& mechanism = model.mechanism;
  const auto actuators = problem.X_MT ? static_cast<Eigen::Index>(mechanism.travel.size()) : 0;
  PlatformSystem system{Eigen::MatrixXd::Zero(6 + actuators, 6 + actuators), Eigen::VectorXd::Zero(6 + actuators)};
  Matrix6 K = acting.terms.A;
  Vector6 rhs = -acting.terms.gradient;
  const Vector6 pose = units.of_pose();
  for (std::size_t i = 0; i < work.chains.size(); ++i) {
    K += work.chains[i].K;
    rhs -= work.chains[i].dF;
    if (!problem.X_MT) continue;
    for (std::size_t a = 0; a < mechanism.chains[i].actuators.size(); ++a) {
      const int number = mechanism.chains[i].actuators[a];
      const double unit = units.of_column(mechanism.travel[number].kind == JointKind::revolute);
      system.matrix.block<6, 1>(0, 6 + number) +=
          work.chains[i].G.col(a).cwiseProduct(pose) * unit / units.energy();
    }
  }
  system.matrix.topLeftCorner<6, 6>() = pose.asDiagonal() * K * pose.asDiagonal() / units.energy();
  system.rhs.head<6>() = rhs.cwiseProduct(pose) / units.energy();
  if (acting.tip) {
    system.matrix.bottomLeftCorner(actuators, 6) = acting.tip->rows;
    system.rhs.tail(actuators) = acting.tip->rhs;
  }
  return system;
}

// The solution of a regular square system; empty where the matrix may be singular. Pivots of columns, none of which is small
// beside the entries of the matrix, are enough to show most matrices regular, by far; full pivoting decides about the others.
Eigen::VectorXd regular_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  constexpr double surely_regular = 1e-6;
  const Eigen::PartialPivLU<Eigen::MatrixXd> partial(A);
  const double least = partial.matrixLU().diagonal().cwiseAbs().minCoeff();
  const double largest = std::max(A.cwiseAbs().maxCoeff(), partial.matrixLU().cwiseAbs().maxCoeff());
  if (least > surely_regular * largest) return partial.solve(b);
  const Eigen::FullPivLU<Eigen::MatrixXd> full(A);
  return full.rank() < A.cols() ? Eigen::VectorXd() : solved(full, b);
}

bool condensed_step(const Model& model, const Problem& problem, const Outside& acting, const Units& units,
                    StaticsWork::Impl& work, Configuration& configuration, Step& step) {
  const Mechanism& mechanism = model.mechanism;
  if (!condense_all(model, problem.X_MT != nullptr, units, work)) return false;
  const PlatformSystem system = assemble_platform(model, problem, acting, units, work);
  const Eigen::VectorXd x = regular_solution(system.matrix, system.rhs);
  if (x.size() == 0) return false;
  const Vector6 dxi = x.head<6>().cwiseProduct(units.of_pose());
  Eigen::VectorXd drho = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mechanism.travel.size()));
  if (problem.X_MT)
    for (Eigen::Index a = 0; a < drho.size(); ++a)
      drho[a] = x[6 + a] * units.of_column(mechanism.travel[a].kind == JointKind::revolute);
  step.largest = std::max(dxi.head<3>().norm(), dxi.tail<3>().norm() * units.length);
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    step.largest = std::max(step.largest, take_step(mechanism.chains[i], dxi, drho, Vector3::Zero(), units, work.chains[i],
                                                    configuration.chains[i]));
  configuration.X_MP = moved(configuration.X_MP, dxi);
  return true;
}

// Where a chain cannot be condensed, the whole system takes the step.
void whole_step(const Model& model, const Problem& problem, const Outside& acting, const Units& units,
                StaticsWork::Impl& work, Configuration& configuration, Step& step) {
  evaluate_all(model, configuration, problem.stage, work);
  const WholeStep whole = solve_whole(whole_system(model, configuration, problem, work), acting.tip, units);
  step.largest = apply(model.mechanism, whole, units, configuration);
}

Residual residual_of(const Model& model, const Configuration& configuration, const Problem& problem, const Outside& acting,
                     const Units& units, const StaticsWork::Impl& work) {
  Residual residual;
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    add_residual(model.mechanism.chains[i], configuration.chains[i], work.chains[i], units, residual);
  residual.force = std::max(residual.force, wrench_size(acting.terms.gradient, units));
  residual.largest = std::max(residual.largest, wrench_size(problem.load.F, units) * problem.stage.load);
  if (acting.tip) residual.closure = std::max(residual.closure, acting.tip->rhs.cwiseAbs().maxCoeff() * units.length);
  return residual;
}

struct Place {
  Pose X_MP;
  Eigen::VectorXd rho;
};

// How far platform and actuators are from `start`, in units of l.
Eigen::VectorXd travelled(const Mechanism& mechanism, const Place& start, const Configuration& now, const Units& units) {
  const Eigen::VectorXd drho = actuator_values(mechanism, now) - start.rho;
  Eigen::VectorXd way(6 + drho.size());
  way.head<6>() = difference(now.X_MP, start.X_MP).cwiseQuotient(units.of_pose());
  for (Eigen::Index a = 0; a < drho.size(); ++a)
    way[6 + a] = drho[a] / units.of_column(mechanism.travel[a].kind == JointKind::revolute);
  return way;
}

bool is_jump(const Eigen::VectorXd& way, const Eigen::VectorXd& predicted) {
  const double surplus = (way - predicted).norm();
  return surplus > jump_floor && surplus > 0.5 * predicted.norm();
}

Place place_of(const Mechanism& mechanism, const Configuration& configuration) {
  return {configuration.X_MP, actuator_values(mechanism, configuration)};
}

}  // namespace

AppliedWrench applied_wrench(const Mechanism& mechanism, const Pose& X_MP, const Load& load, double factor) {
  AppliedWrench applied{factor * load.F, Matrix6::Zero()};
  const Vector3& arm = load.at_platform ? mechanism.p_EP : mechanism.X_PT.p;
  if (load.at_platform && arm.isZero(0)) return applied;
  const Vector3 r = X_MP.R * arm, f = applied.F.head<3>();
  applied.F = wrench_at(applied.F, r);
  applied.tangent.bottomRightCorner<3, 3>() = skew(f) * skew(r);  // d(r x f) = (w x r) x f = f x (r x w)
  return applied;
}

void evaluate_all(const Model& model, const Configuration& configuration, const Stage& stage, StaticsWork::Impl& work) {
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    evaluate(model.mechanism.chains[i], configuration.chains[i], configuration.X_MP, stage,
             acting_gravity(model.mechanism, stage), Hessians::yes, work.chains[i]);
}

PlatformTerms platform_terms(const Model& model, const Configuration& configuration, const Problem& problem) {
  const AppliedWrench applied =
      applied_wrench(model.mechanism, configuration.X_MP, problem.load, problem.stage.load);
  PlatformTerms terms{-applied.F, -applied.tangent};
  for (const SeriesState& chain : configuration.chains) terms.gradient += chain.F;
  return terms;
}

WholeSystem whole_system(const Model& model, const Configuration& configuration, const Problem& problem,
                         const StaticsWork::Impl& work) {
  const Units units{model.mechanism.length};
  const Outside acting{platform_terms(model, configuration, problem), std::nullopt};
  const Residual residual = residual_of(model, configuration, problem, acting, units, work);
  WholeSystem system = assemble_whole(model.mechanism, work.chains, acting.terms, units);
  const double by_unit = units.length / units.energy();
  system.wrench = std::max(1.0, residual.largest) * by_unit;
  system.force_error =
      std::min(residual.force, force_tolerance(model.mechanism, configuration.X_MP, residual.largest)) * by_unit;
  return system;
}

double force_tolerance(const Mechanism& mechanism, const Pose& X_MP, double largest_wrench) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  return 1e-9 * std::max(1.0, largest_wrench) +
         16 * eps * mechanism.stiffest * (X_MP.p.norm() + mechanism.length);
}

bool ends_elsewhere(const Mechanism& mechanism, const Configuration& from, const Configuration& foreseen,
                    const Configuration& found) {
  const Units units{mechanism.length};
  const Place start = place_of(mechanism, from);
  return is_jump(travelled(mechanism, start, found, units), travelled(mechanism, start, foreseen, units));
}

NewtonResult newton(const Model& model, const Problem& problem, StaticsWork::Impl& work, Configuration& configuration) {
  const Units units{model.mechanism.length};
  const Place start = place_of(model.mechanism, configuration);
  Eigen::VectorXd predicted = Eigen::VectorXd::Zero(6 + static_cast<Eigen::Index>(model.mechanism.travel.size()));
  NewtonResult result;
  Step step;
  for (; result.iterations < most_newton_steps; ++result.iterations) {
    evaluate_all(model, configuration, problem.stage, work);
    const Outside acting = outside(model, configuration, problem, units);
    const Residual residual = residual_of(model, configuration, problem, acting, units, work);
    if (!std::isfinite(residual.closure + residual.force)) return result;
    result.converged = residual.closure <= closure_tolerance && step.largest <= step_tolerance &&
                       residual.force <= force_tolerance(model.mechanism, configuration.X_MP, residual.largest);
    if (result.converged) {
      result.jumped = is_jump(travelled(model.mechanism, start, configuration, units), predicted);
      return result;
    }
    if (!condensed_step(model, problem, acting, units, work, configuration, step))
      whole_step(model, problem, acting, units, work, configuration, step);
    if (result.iterations == 0) predicted = travelled(model.mechanism, start, configuration, units);
  }
  return result;
}

}  // namespace counterflex
