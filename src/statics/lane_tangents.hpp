#pragma once
/// The tangents with which lanes iterate near a configuration, and the state with which they begin.
#include <vector>

#include "lane_model.hpp"

namespace counterflex {

class LaneTangents {
 public:
  /// At an equilibrium; `J` (actuators x 3) is the change of the actuators by the commanded position. False where a series or
  /// the platform has no stiffness of its own: lanes cannot do with the place then.
  bool take(const Model& model, const LaneModel& lane_model, const Configuration& reference, const Eigen::MatrixXd& J,
            StaticsWork& work);

  /// Lets a region use them.
  void enter(lanes::Region& region) const;

 private:
  bool take_platform(const Model& model, const Configuration& reference, const Matrix6& K, const Eigen::MatrixXd& G,
                     const Eigen::MatrixXd& J);

  std::vector<double> start_, cosine_, sine_, forward_, target_, kinematic_;
  std::vector<std::vector<double>> matrices_;
  std::vector<const double*> inside_, by_end_, by_actuators_;
};

}  // namespace counterflex
