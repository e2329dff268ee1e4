#pragma once
/// Kinds of rows: their names, the columns that they need, and the deviations of rows that give none.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/identify/measurements.hpp"

namespace counterflex::measurement_file {

std::optional<MeasurementKind> kind_named(std::string_view name);

/// Kinds that rows of a table can have: "tracker_point, tracker_pose, ...".
std::string kind_names();

/// The columns that rows of a kind need besides those of the actuators.
std::vector<std::string_view> needed_columns(MeasurementKind kind);

/// Whether rows of a kind need values of all actuators. Else those of home replace missing ones.
bool needs_actuators(MeasurementKind kind);

inline constexpr double default_sigma_angle = 1.7453292519943295e-4;  // rad, 0.01 deg: of an orientation
inline constexpr double default_sigma_axis_angle = 2e-5;              // rad: of the angle of a rotary axis

}  // namespace counterflex::measurement_file
