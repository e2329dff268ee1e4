#include "identify/fit/clamped.hpp"

#include <Eigen/QR>

#include "counterflex/statics/tip_stiffness.hpp"

namespace counterflex {
namespace {

constexpr double small_turn = 1e-4;  // rad: of central differences, exact to 1e-8
constexpr double threshold = 1e-9;   // of the largest pivot: smaller ones are rigid directions
constexpr double outside =
    1e-3;  // of J: more of it outside of the range of C is not a motion of elastic joints

/// Twist of the tip by an actuator, loads held.
std::optional<Vector6> twist_by(const Model& model, const Configuration& free, std::size_t actuator,
                                StaticsWork& work) {
  std::array<Pose, 2> X;
  for (const int side : {0, 1}) {
    Configuration moved = free;
    Eigen::VectorXd rho = actuator_values(model.mechanism, free);
    rho[static_cast<Eigen::Index>(actuator)] += (2 * side - 1) * small_turn;
    set_actuator_values(model.mechanism, rho, moved);
    const Equilibrium found = refine_forward(model, moved, Load{}, Stage{}, work);
    if (found.status != Status::converged) return {};
    X[static_cast<std::size_t>(side)] = tip(model.mechanism, found.configuration);
  }
  return difference(X[1], X[0]) / (2 * small_turn);
}

}  // namespace

void fill_clamped(const Model& model, const Configuration& free, const ClampedTorque& clamped,
                  const VariedTangents& tangents, StaticsWork& work, StaticsWork& tangent_work,
                  Response& at) {
  at.turn = 0;
  at.turn_tangents = Eigen::RowVectorXd::Zero(at.tangents.cols());
  const std::optional<Matrix6> C = compliance_at_tip(model, free, Load{}, Stage{}, work);
  const std::optional<Vector6> J = twist_by(model, free, clamped.actuator, work);
  if (!C || !J) {
    at.status = Status::not_converged;
    return;
  }
  Vector6 unit;  // lengths in units of l
  unit << Vector3::Constant(1 / model.mechanism.length), Vector3::Ones();
  const Matrix6 scaled = unit.asDiagonal() * *C * unit.asDiagonal();
  const Vector6 J_scaled = unit.cwiseProduct(*J);
  Eigen::CompleteOrthogonalDecomposition<Matrix6> decomposition;
  decomposition.setThreshold(threshold);
  decomposition.compute(scaled);
  const Vector6 y_scaled = decomposition.solve(J_scaled);
  if (!((scaled * y_scaled - J_scaled).norm() < outside * J_scaled.norm())) return;
  const Vector6 y = unit.cwiseProduct(y_scaled);
  if (clamped.torque == 0) return;
  const double stiffness = J->dot(y);
  const Load load{-y * (clamped.torque / stiffness), false};
  const Equilibrium loaded = refine_forward(model, free, load, Stage{}, work);
  if (loaded.status != Status::converged) {
    at.status = loaded.status;
    return;
  }
  // The free tip moves by -J turn under the clamp's force; also where a joint is not linear.
  at.turn = -y.dot(difference(tip(model.mechanism, loaded.configuration), at.X_MT)) / stiffness;
  const Eigen::RowVectorXd change =
      -y.transpose() * (tangents.of.of_tip(loaded.configuration, load, tangent_work) - at.tangents) /
      stiffness;
  for (Eigen::Index k = 0; k < change.size(); ++k)
    if (tangents.is_compliance[static_cast<std::size_t>(k)]) at.turn_tangents[k] = change[k];
}

}  // namespace counterflex
