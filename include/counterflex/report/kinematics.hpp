#pragma once
/// Nominal kinematics for people: the tip of given actuator values, and the actuator values of a given tip,
/// in the values and angles that controls show.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/statics/arm_margins.hpp"
#include "counterflex/statics/nominal.hpp"

namespace counterflex {

struct KinematicPlace {
  Status status = Status::not_converged;
  std::string why;  ///< in words where `status` is not `converged`
  Pose X_MT;
  Eigen::VectorXd shown;  ///< values of the actuators as the control shows them (m, rad)
  std::optional<std::array<ArmMargin, 3>> margins;  ///< of a six-axis arm

  /// Whether the machine can be put there, perhaps outside its travel. Else only `why` has a meaning.
  bool is_known() const { return status == Status::converged || status == Status::outside_travel; }
};

/// The place of a nominal configuration. It gives rotary actuators but for full turns: their values are those
/// nearest to `near`, the values of all actuators.
KinematicPlace place_of(const Model& model, const Configuration& nominal, const Eigen::VectorXd& near);

/// The place of shown actuator values, on the branch of home. `shown` has a value for each actuator.
KinematicPlace place_at_values(const Model& model, const Eigen::VectorXd& shown);

/// The place with the tip at `X_MT` in the components that the machine controls, on the branch of home.
KinematicPlace place_at_tip(const Model& model, const Pose& X_MT);

struct KinematicsReport {
  std::string version;  ///< of the tool
  std::string machine;
  std::string tool{};  ///< in the spindle, and its stiffness; empty: [tool]
  std::vector<Travel> travel;
  std::vector<KinematicPlace> places;
  SpindleAxis spindle_axis = SpindleAxis::z;  ///< of the control's tool frame, whose orientation is printed
};

/// "counterflex-kinematics 1" (programs/guide/poses.md), indented by two spaces, one newline at the end.
std::string to_json(const KinematicsReport& report);

/// One block for each place. ASCII and at most 100 columns wide, but for names.
std::string to_text(const KinematicsReport& report);

}  // namespace counterflex
