#include "counterflex/statics/chain.hpp"

#include <cmath>
#include <limits>

#include "statics/model/part.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/theory/manipulator.hpp"

namespace counterflex {
namespace {

double part_energy(const Part& part, const SeriesState& state, const Stage& stage) {
  if (part.kind == PartKind::spring) {
    const Vector6 theta = spring_deflection(part, state, stage);
    return 0.5 * theta.dot(part.K * theta);
  }
  if (part.kind != PartKind::passive && part.kind != PartKind::compliance) return 0;
  const double q = joint_deflection(part, state, stage);
  return joint_energy(part.k, part.k_change, part.knee, q);
}

// A chain at a state; its gap is to `X_MP`.
SeriesWork& evaluated(const Model& model, std::size_t i, const SeriesState& state, const Pose& X_MP,
                      const Stage& stage, Hessians hessians, StaticsWork& work) {
  SeriesWork& chain = work.impl().chains[i];
  evaluate(model.mechanism.chains[i], state, X_MP, stage, acting_gravity(model.mechanism, stage), hessians,
           chain);
  return chain;
}

}  // namespace

ChainEquilibrium solve_chain(const Model& model, std::size_t i, const Pose& X_MP, const Stage& stage,
                             ChainMethod method, SeriesState& state, StaticsWork& work) {
  const Series& series = model.mechanism.chains[i];
  const Units units{model.mechanism.length};
  const Hessians hessians = method == ChainMethod::newton ? Hessians::yes : Hessians::no;
  ChainEquilibrium result;
  double step = std::numeric_limits<double>::infinity();
  for (; result.iterations < most_linear_steps; ++result.iterations) {
    SeriesWork& chain = evaluated(model, i, state, X_MP, stage, hessians, work);
    Residual residual;
    add_residual(series, state, chain, units, residual);
    if (!std::isfinite(residual.closure + residual.force)) return result;
    if (residual.closure <= closure_tolerance && step <= step_tolerance &&
        residual.force <= force_tolerance(model.mechanism, X_MP, residual.largest)) {
      result.status = Status::converged;
      return result;
    }
    if (!condense(series, units, chain)) {
      result.status = Status::singular;
      return result;
    }
    step = take_step(series, Vector6::Zero(), Vector3::Zero(), units, chain, state);
  }
  return result;
}

ChainStiffness chain_stiffness(const Model& model, std::size_t i, const SeriesState& state,
                               const Stage& stage, StaticsWork& work) {
  const Series& series = model.mechanism.chains[i];
  const Units units{model.mechanism.length};
  SeriesWork& chain = evaluated(model, i, state, {}, stage, Hessians::yes, work);
  ChainStiffness result;
  result.available = condense(series, units, chain);
  if (!result.available) return result;
  result.K_C = chain.K;
  Eigen::Index row = 6;  // of the solution: below the wrench's, one for each free column
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::actuator) continue;
    for (int k = 0; k < columns_of(part); ++k, ++row) {
      if (part.kind == PartKind::group) continue;
      auto& rows = part.kind == PartKind::passive ? result.K_Cq : result.K_Ctheta;
      rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
      rows.bottomRows<1>() =
          units.of_column(series.angular[part.column + k]) * chain.solution.block<1, 6>(row, 1);
    }
  }
  return result;
}

double elastic_energy(const Series& series, const SeriesState& state, const Stage& stage) {
  double energy = 0;
  for (const Part& part : series.parts) energy += part_energy(part, state, stage);
  for (std::size_t g = 0; g < series.groups.size(); ++g)
    for (std::size_t b = 0; b < series.groups[g].branches.size(); ++b)
      energy += elastic_energy(series.groups[g].branches[b], state.groups[g].branches[b], stage);
  return energy;
}

Eigen::MatrixXd chain_jacobian(const Model& model, std::size_t i, const SeriesState& state,
                               const Stage& stage, StaticsWork& work) {
  const SeriesWork& chain = evaluated(model, i, state, {}, stage, Hessians::no, work);
  Eigen::MatrixXd J(6, chain.v.cols());
  J << chain.v, chain.w;
  return J;
}

Eigen::MatrixXd chain_hessian(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage,
                              StaticsWork& work) {
  const Eigen::MatrixXd K = evaluated(model, i, state, {}, stage, Hessians::no, work).A;
  return K - evaluated(model, i, state, {}, stage, Hessians::yes, work).A;
}

Pose chain_end(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage,
               StaticsWork& work) {
  return evaluated(model, i, state, {}, stage, Hessians::no, work).end;
}

}  // namespace counterflex
