#pragma once
/// The tangents with which lanes iterate near a configuration, and the state with which they begin.
#include <vector>

#include "lane_model.hpp"

namespace counterflex {

/// A state from which turns and displacements of lanes count.
class LaneStart {
 public:
  LaneStart() = default;
  explicit LaneStart(std::vector<double> state);

  const std::vector<double>& state() const { return state_; }
  void enter(lanes::Region& region) const;

 private:
  std::vector<double> state_, cosine_, sine_;
};

struct LaneTangents {
  std::vector<double> numbers;    ///< as Region::tangents
  std::vector<double> kinematic;  ///< as Region::kinematic; empty where nominal kinematics is singular
  std::vector<double> straighten;  ///< as Region::straighten

  /// At an equilibrium; `J` (actuators x 3) is the change of the actuators by the commanded position. False where a series or
  /// the platform has no stiffness of its own: lanes cannot do with the place then.
  bool take(const Model& model, const LaneModel& lane_model, const Configuration& reference, const Eigen::MatrixXd& J,
            StaticsWork& work);

 private:
  bool take_platform(const Model& model, const lanes::Program& program, const Configuration& reference, const Matrix6& K,
                     const Eigen::MatrixXd& G, const Eigen::MatrixXd& J);
};

}  // namespace counterflex
