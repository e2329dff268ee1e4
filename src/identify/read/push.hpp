#pragma once
/// Rows of gauges: which force acts, where it acts, and what the gauge reads.
#include "identify/read/axis_motion.hpp"
#include "identify/read/table.hpp"

namespace counterflex::measurement_file {

/// The direction of the gauge of the current row, a unit vector in M. Throws `InputError`.
Vector3 gauge_direction(const Table& table);

/// Fills the force and the gauge of a push or of a hung weight whose first state has actuator values: the
/// second state is that without the force. `hung_g`: of hung masses, in M (m/s2); they are read along it
/// unless the row has a direction. Throws `InputError`.
void read_push(const Table& table, const Axes& axes, const Vector3& hung_g, MeasurementKind kind,
               Session& session, Measurement& row);

}  // namespace counterflex::measurement_file
