#include "identify/read/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 15> all_names = {
    "tracker_point", "tracker_pose",   "static_push",   "hung_weight", "plane_contact",
    "length_bar",    "squareness",     "axis_position", "axis_table",  "reversal",
    "scale",         "clamped_torque", "ballbar",       "repeat",      "cmm_feature"};

// A laser tracker, a dial gauge, a touch or a bar, a ball bar.
constexpr double sigma_tracker = 0.05 * mm, sigma_gauge = 5 * um, sigma_touch = 0.02 * mm, sigma_slope = 5e-6,
                 sigma_reversal = 1 * um;

}  // namespace

std::string_view name_of(MeasurementKind kind) {
  return all_names[static_cast<std::size_t>(kind)];
}

double default_sigma(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::tracker_point:
    case MeasurementKind::tracker_pose:
      return sigma_tracker;
    case MeasurementKind::plane_contact:
    case MeasurementKind::length_bar:
      return sigma_touch;
    case MeasurementKind::squareness:
    case MeasurementKind::scale:
      return sigma_slope;
    case MeasurementKind::clamped_torque:
      return measurement_file::default_sigma_axis_angle;
    case MeasurementKind::reversal:
      return sigma_reversal;
    default:
      return sigma_gauge;
  }
}

namespace measurement_file {

std::optional<MeasurementKind> kind_named(std::string_view name) {
  const auto found = std::find(all_names.begin(), all_names.end(), name);
  if (found == all_names.end()) return {};
  return static_cast<MeasurementKind>(found - all_names.begin());
}

std::string kind_names() {
  static_assert(all_names.back() == "cmm_feature");
  return fmt::format("{}", fmt::join(all_names.begin(), all_names.end() - 1, ", "));
}

std::vector<std::string_view> needed_columns(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::tracker_point:
      return {"x", "y", "z"};
    case MeasurementKind::tracker_pose:
      return {"x", "y", "z", "rx", "ry", "rz"};
    case MeasurementKind::static_push:
    case MeasurementKind::axis_position:
      return {"reading", "gx", "gy", "gz"};
    case MeasurementKind::hung_weight:
      return {"reading", "mass"};
    case MeasurementKind::plane_contact:
    case MeasurementKind::cmm_feature:
      return {};
    case MeasurementKind::length_bar:
      return {"bar", "length"};
    case MeasurementKind::squareness:
      return {"axes", "squareness"};
    case MeasurementKind::axis_table:
      return {"axis", "position", "deviation", "direction"};
    case MeasurementKind::reversal:
      return {"axis", "reversal"};
    case MeasurementKind::scale:
      return {"axis", "scale"};
    case MeasurementKind::clamped_torque:
      return {"axis", "torque"};
    case MeasurementKind::ballbar:
      return {"axes"};
    case MeasurementKind::repeat:
      return {"place"};
  }
  return {};
}

bool needs_actuators(MeasurementKind kind) {
  switch (kind) {
    case MeasurementKind::squareness:
    case MeasurementKind::axis_table:
    case MeasurementKind::reversal:
    case MeasurementKind::scale:
    case MeasurementKind::ballbar:
    case MeasurementKind::repeat:
      return false;
    default:
      return true;
  }
}

}  // namespace measurement_file
}  // namespace counterflex
