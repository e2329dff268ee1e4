#pragma once
/// The tangents with which lanes iterate near a configuration, and the state with which they begin.
#include <array>
#include <vector>

#include "lane_model.hpp"

namespace counterflex {

class LaneTangents {
 public:
  /// At an equilibrium; `J` (actuators x 3) is the change of the actuators by the commanded position. False where a series or
  /// the platform has no stiffness of its own: lanes cannot do with the place then.
  bool take(const Model& model, const LaneModel& lane_model, const Configuration& reference, const Eigen::MatrixXd& J,
            StaticsWork& work);

  /// For targets: how `J` changes by the commanded position, d J / d p_i.
  void bend(const std::array<Eigen::MatrixXd, 3>& J_by_position);

  /// Lets a region use them, which were taken at `place` (M, m).
  void enter(lanes::Region& region, const Vector3& place) const;

 private:
  bool take_platform(const Model& model, const Configuration& reference, const Matrix6& K, const Eigen::MatrixXd& G,
                     const Eigen::MatrixXd& J);

  Eigen::MatrixXd G_;  ///< change of the chains' wrench by the actuators
  std::vector<double> bend_, straighten_, start_, cosine_, sine_, forward_, target_, kinematic_;
  std::vector<std::vector<double>> matrices_;
  std::vector<const double*> inside_, by_end_, by_actuators_;
};

}  // namespace counterflex
