#include <Eigen/Geometry>

#include "counterflex/statics/theory.hpp"
#include "statics/model/part.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/theory/manipulator.hpp"

namespace counterflex {
namespace {

constexpr Stage errors_alone{.errors = 1, .load = 0, .preload = 0, .gravity = 0};

// eps of a series by its own errors: each error's (p, Log R), carried to the end by the nominal frames. What
// the controller's zero holds against the weights moves the end likewise.
Vector6 own_eps(const Series& series, const SeriesState& nominal, const Stage& stage,
                const SeriesWork& work) {
  Vector6 eps = Vector6::Zero();
  const auto add = [&](double factor, const Vector3& v, const Vector3& w, const Vector3& p) {
    eps.head<3>() += factor * (v + w.cross(work.end.p - p));
    eps.tail<3>() += factor * w;
  };
  Pose X;
  for (const Part& part : series.parts) {
    const Pose X_after = X * part_pose(part, nominal, nominal_stage);
    if (part.kind == PartKind::error) add(stage.errors, X.R * part.X.p, X.R * part.log_R, X.p);
    if (!part.errors.empty()) {
      const Vector6 e = difference(X * part_pose(part, nominal, errors_alone), X_after);
      add(stage.errors, e.head<3>(), e.tail<3>(), X_after.p);
    }
    if (part.kind == PartKind::actuator)
      add(stage.gravity * part.offset, work.v.col(part.column), work.w.col(part.column), work.end.p);
    X = X_after;
  }
  return eps;
}

// A perfect chain closes at the nominal pose; a chain with errors ends eps beside it.
void open_gaps(const Series& series, const SeriesState& nominal, const Stage& stage, SeriesWork& work) {
  work.gap -= own_eps(series, nominal, stage, work);
  for (std::size_t g = 0; g < series.groups.size(); ++g)
    for (std::size_t b = 0; b < series.groups[g].branches.size(); ++b)
      open_gaps(series.groups[g].branches[b], nominal.groups[g].branches[b], stage, work.groups[g][b]);
}

void evaluate_linear(const Model& model, const Configuration& nominal, const Stage& stage,
                     StaticsWork::Impl& work) {
  const Stage in_place{0, stage.load, stage.preload, 0};  // errors and offsets enter as gaps
  const Vector3 g = acting_gravity(model.mechanism, stage);
  for (std::size_t i = 0; i < nominal.chains.size(); ++i) {
    evaluate(model.mechanism.chains[i], nominal.chains[i], nominal.X_MP, in_place, g, Hessians::no,
             work.chains[i]);
    open_gaps(model.mechanism.chains[i], nominal.chains[i], stage, work.chains[i]);
  }
}

bool condensed(const Model& model, const Vector6& F, const Units& units, StaticsWork::Impl& work,
               LinearResult& result) {
  const Mechanism& mechanism = model.mechanism;
  const auto sum = aggregate(mechanism.chains, units, work.chains);
  const auto compliance = sum ? inverse_in_units(sum->K, units.of_pose()) : std::nullopt;
  if (!compliance) return false;
  result.dt_P = *compliance * (F - sum->dF);
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    take_step(mechanism.chains[i], result.dt_P, Vector3::Zero(), units, work.chains[i],
              result.configuration.chains[i]);
  result.configuration.X_MP = moved(result.configuration.X_MP, result.dt_P);
  return true;
}

// Where a chain has no stiffness of its own: the same linear equations, uncondensed.
bool uncondensed(const Model& model, const Configuration& nominal, const Vector6& F, const Stage& stage,
                 const Units& units, StaticsWork::Impl& work, LinearResult& result) {
  evaluate_linear(model, nominal, stage, work);
  const WholeSystem system = assemble_whole(model.mechanism, work.chains, {-F, Matrix6::Zero()}, units);
  if (!(condition(system, units).value < largest_condition)) return false;
  const WholeStep step = solve_whole(system, std::nullopt, units);
  result.dt_P = step.variables.tail<6>();
  result.configuration = nominal;
  apply(model.mechanism, step, units, result.configuration);
  return true;
}

//     x = (sum K_b)^-1 sum K_b eps_b: where branches that end eps_b apart meet without a load
std::optional<Vector6> group_eps(const std::vector<Series>& branches, const Units& units,
                                 std::vector<SeriesWork>& works);

// A group's own part of eps is added to the branches' gaps, innermost groups first.
std::optional<Vector6> series_eps(const Series& series, const SeriesState& nominal, const Stage& stage,
                                  const Units& units, SeriesWork& work) {
  Vector6 eps = own_eps(series, nominal, stage, work);
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const auto x = group_eps(series.groups[part.group].branches, units, work.groups[part.group]);
    if (!x) return std::nullopt;
    eps.head<3>() += work.v.middleCols<6>(part.column) * *x;
    eps.tail<3>() += work.w.middleCols<6>(part.column) * *x;
  }
  return eps;
}

std::optional<Vector6> group_eps(const std::vector<Series>& branches, const Units& units,
                                 std::vector<SeriesWork>& works) {
  const auto sum = aggregate(branches, units, works);
  if (!sum) return std::nullopt;
  const Vector6 pose = units.of_pose();
  const Eigen::VectorXd x =
      solved(decomposed(pose.asDiagonal() * sum->K * pose.asDiagonal() / units.energy()),
             Eigen::VectorXd(-pose.cwiseProduct(sum->dF) / units.energy()));
  return pose.cwiseProduct(Vector6(x));
}

}  // namespace

std::vector<std::optional<Vector6>> chain_eps(const Model& model, const Configuration& nominal,
                                              StaticsWork& work) {
  evaluate_linear(model, nominal, errors_alone, work.impl());
  std::vector<std::optional<Vector6>> all;
  for (std::size_t i = 0; i < nominal.chains.size(); ++i)
    all.push_back(series_eps(model.mechanism.chains[i], nominal.chains[i], errors_alone,
                             {model.mechanism.length}, work.impl().chains[i]));
  return all;
}

LinearResult linear_deviation(const Model& model, const Configuration& nominal, const Load& load,
                              const Stage& stage, StaticsWork& work) {
  const Units units{model.mechanism.length};
  const Vector6 F = applied_wrench(model.mechanism, nominal.X_MP, load, stage.load).F;
  LinearResult result;
  result.configuration = nominal;
  evaluate_linear(model, nominal, stage, work.impl());
  result.status = condensed(model, F, units, work.impl(), result) ||
                          uncondensed(model, nominal, F, stage, units, work.impl(), result)
                      ? Status::converged
                      : Status::singular;
  result.dt_T = tip_from_platform(model.mechanism, nominal.X_MP) * result.dt_P;
  return result;
}

Pose linear_target(const Model& model, const Pose& X_MT, const LinearResult& linear) {
  return moved(X_MT, -fixed_part(model.mechanism, linear.dt_T));
}

}  // namespace counterflex
