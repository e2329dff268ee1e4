#include "identify/read/axis_motion.hpp"

#include <fmt/format.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/shown.hpp"
#include "identify/read/columns.hpp"

namespace counterflex::measurement_file {
namespace {

constexpr double least_motion = 1e-9;                           // m, rad: less is rounding
constexpr double probe_length = 1 * mm, probe_angle = 1 * deg;  // of the axis whose direction is looked for
constexpr double same_motion = 1e-6;                            // of the tip and the axis, as a share

}  // namespace

Axes::Axes(const Machine& machine)
    : actuators_(actuators(machine)), names_(actuator_names(machine)), model_(prepare(machine)) {}

std::optional<std::size_t> Axes::find(std::string_view text) const {
  for (std::size_t i = 0; i < names_.size(); ++i)
    if (!text.empty() && (text == letter_of(names_[i]) || text == fmt::format("q{}", i + 1))) return i;
  return {};
}

Directions Axes::directions_of(const Eigen::VectorXd& signs) const {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(signs.size());
  return directions_between(zero, signs, {});
}

Directions Axes::directions_between(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                    const Directions& before) const {
  const ShownActuators& shown = model_.mechanism.shown;
  const Eigen::VectorXd moved = joint_values(shown, to) - joint_values(shown, from);
  Directions result = before;
  for (Eigen::Index i = 0; i < moved.size(); ++i)
    if (std::abs(moved[i]) > least_motion) result.set(static_cast<std::size_t>(i), moved[i] > 0 ? 1 : -1);
  return result;
}

std::optional<Pose> Axes::tip_at(const Eigen::VectorXd& shown) const {
  const NominalResult found =
      nominal_forward(model_, model_.home, joint_values(model_.mechanism.shown, shown));
  if (found.status != Status::converged) return {};
  return tip(model_.mechanism, found.configuration);
}

std::optional<Vector3> Axes::direction_of(std::size_t axis, const Eigen::VectorXd& shown) const {
  const double moved = turns(axis) ? probe_angle : probe_length;
  std::array<Pose, 2> X;
  for (const int side : {0, 1}) {
    Eigen::VectorXd at = shown;
    at[static_cast<Eigen::Index>(axis)] += (side - 0.5) * moved;
    const std::optional<Pose> there = tip_at(at);
    if (!there) return {};
    X[static_cast<std::size_t>(side)] = *there;
  }
  const Vector3 turned = log_so3(X[1].R * X[0].R.transpose()),
                motion = turns(axis) ? turned : Vector3(X[1].p - X[0].p);
  const bool is_pure = turns(axis) || turned.norm() < same_motion * probe_angle;
  if (!is_pure || std::abs(motion.norm() / moved - 1) > same_motion) return {};
  return motion.normalized();
}

}  // namespace counterflex::measurement_file
