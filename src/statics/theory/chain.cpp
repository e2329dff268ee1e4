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

bool is_found(const Mechanism& mechanism, const Pose& X_MP, const Residual& residual, double step) {
  return residual.closure <= closure_tolerance && step <= step_tolerance &&
         residual.force <= force_tolerance(mechanism, X_MP, residual.largest);
}

// A chain and its branches, uncondensed: a group whose branches are rigid in some directions has no six
// springs, but its chain may have a stiffness of its own. EQUATIONS.md, section 6.
class WholeChain {
 public:
  WholeChain(const Model& model, std::size_t i, const Stage& stage)
      : stage_(stage), units_{model.mechanism.length}, gravity_(acting_gravity(model.mechanism, stage)) {
    chain_.chains = {model.mechanism.chains[i]};
    works_.push_back(make_work(series()));
  }

  WholeSystem evaluated(const SeriesState& state, const Pose& X_MP, Hessians hessians) {
    evaluate(series(), state, X_MP, stage_, gravity_, hessians, works_[0]);
    return assemble_whole(chain_, works_, {}, units_);
  }

  // `system` with a step of the end (m, rad).
  WholeStep step(const WholeSystem& system, const Vector6& dxi) const {
    return solve_whole(
        system, Controlled{Matrix6::Identity(), dxi.cwiseQuotient(units_.of_pose()), /*by_forces=*/true},
        units_);
  }

  Residual residual(const SeriesState& state) const {
    Residual result;
    add_residual(series(), state, works_[0], units_, result);
    return result;
  }

  // Returns the largest entry.
  double take(const WholeStep& step, const Pose& X_MP, SeriesState& state) const {
    Configuration configuration{X_MP, {std::move(state)}};
    const double largest = apply(chain_, step, units_, configuration);
    state = std::move(configuration.chains[0]);
    return largest;
  }

 private:
  const Series& series() const { return chain_.chains[0]; }

  Mechanism chain_;
  std::vector<SeriesWork> works_;
  Stage stage_;
  Units units_;
  Vector3 gravity_;
};

ChainEquilibrium solve_whole_chain(const Model& model, std::size_t i, const Pose& X_MP, const Stage& stage,
                                   Hessians hessians, SeriesState& state) {
  WholeChain chain(model, i, stage);
  ChainEquilibrium result;
  double step = std::numeric_limits<double>::infinity();
  for (; result.iterations < most_linear_steps; ++result.iterations) {
    const WholeSystem system = chain.evaluated(state, X_MP, hessians);
    const Residual residual = chain.residual(state);
    if (!std::isfinite(residual.closure + residual.force)) return result;
    if (!determines_end(system)) {
      result.status = Status::singular;
      return result;
    }
    if (is_found(model.mechanism, X_MP, residual, step)) {
      result.status = Status::converged;
      return result;
    }
    step = chain.take(chain.step(system, Vector6::Zero()), X_MP, state);
  }
  return result;
}

// Sorts the rows of a chain's columns, each of which `row` gives.
template <class Row>
void fill_rows(const Series& series, const Row& row, ChainStiffness& result) {
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::actuator || part.kind == PartKind::group) continue;
    for (int k = 0; k < columns_of(part); ++k) {
      auto& rows = part.kind == PartKind::passive ? result.K_Cq : result.K_Ctheta;
      rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
      rows.bottomRows<1>() = row(part.column + k);
    }
  }
}

ChainStiffness whole_chain_stiffness(const Model& model, std::size_t i, const SeriesState& state,
                                     const Stage& stage) {
  WholeChain chain(model, i, stage);
  WholeSystem system = chain.evaluated(state, {}, Hessians::yes);
  ChainStiffness result;
  result.available = determines_end(system);
  if (!result.available) return result;
  system.gradient.setZero();
  system.gap.setZero();
  Eigen::Matrix<double, Eigen::Dynamic, 6> steps(system.gradient.size(), 6);
  for (int k = 0; k < 6; ++k) {
    const WholeStep step = chain.step(system, Vector6::Unit(k));
    result.K_C.col(k) = step.wrenches.head<6>();
    steps.col(k) = step.variables;
  }
  fill_rows(
      model.mechanism.chains[i], [&](int column) { return steps.row(column); }, result);
  return result;
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
    if (is_found(model.mechanism, X_MP, residual, step)) {
      result.status = Status::converged;
      return result;
    }
    if (!condense(series, units, chain)) return solve_whole_chain(model, i, X_MP, stage, hessians, state);
    step = take_step(series, Vector6::Zero(), Vector3::Zero(), units, chain, state);
  }
  return result;
}

ChainStiffness chain_stiffness(const Model& model, std::size_t i, const SeriesState& state,
                               const Stage& stage, StaticsWork& work) {
  const Series& series = model.mechanism.chains[i];
  const Units units{model.mechanism.length};
  SeriesWork& chain = evaluated(model, i, state, {}, stage, Hessians::yes, work);
  if (!condense(series, units, chain)) return whole_chain_stiffness(model, i, state, stage);
  ChainStiffness result;
  result.K_C = chain.K;
  std::vector<Eigen::Index> place(static_cast<std::size_t>(series.columns));
  for (std::size_t k = 0; k < series.free.size(); ++k)  // of the solution: below the wrench's
    place[static_cast<std::size_t>(series.free[k])] = 6 + static_cast<Eigen::Index>(k);
  fill_rows(
      series,
      [&](int column) {
        return units.of_column(series.angular[column]) *
               chain.solution.block<1, 6>(place[static_cast<std::size_t>(column)], 1);
      },
      result);
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
