#include "identify/read/push.hpp"

#include <fmt/format.h>

#include "counterflex/files/text.hpp"

namespace counterflex::measurement_file {
namespace {

Vector3 vector(const Table& table, std::string_view x, std::string_view y, std::string_view z) {
  return {table.value_or(x, 0), table.value_or(y, 0), table.value_or(z, 0)};
}

/// 1 while the force fell, -1 while it grew, 0 where it is not known: by this share of the hysteresis the
/// gauge reads more along the force.
double phase_of(const Table& table, Session& session) {
  const csv::Field* field = table.text("phase");
  if (field == nullptr || field->text.empty()) return 0;
  const bool is_loading = field->text == "loading";
  if (!is_loading && field->text != "unloading")
    table.fail("phase", fmt::format("phase is \"{}\"; it must be loading or unloading",
                                    without_controls(field->text)));
  (is_loading ? session.has_loading : session.has_unloading) = true;
  return is_loading ? -1 : 1;
}

}  // namespace

Vector3 gauge_direction(const Table& table) {
  const Vector3 direction = vector(table, "gx", "gy", "gz");
  if (!(direction.norm() > 1e-6))
    table.fail("", "gx, gy, gz are zero; they must be the direction of the gauge");
  return direction.normalized();
}

void read_push(const Table& table, const Axes& axes, const Vector3& hung_g, MeasurementKind kind,
               Session& session, Measurement& row) {
  row.states.push_back(row.states[0]);
  Vector6& F = row.states[0].F;
  if (kind == MeasurementKind::static_push)
    F << vector(table, "fx", "fy", "fz"), vector(table, "mx", "my", "mz");
  else
    F.head<3>() = table.value("mass") * hung_g;
  if (F.isZero(0)) table.fail("", "the force is zero");
  const bool has_direction = table.is_filled("gx") || table.is_filled("gy") || table.is_filled("gz");
  row.direction =
      kind == MeasurementKind::hung_weight && !has_direction ? hung_g.normalized() : gauge_direction(table);
  row.value = table.value("reading");
  row.gauge = vector(table, "gauge_x", "gauge_y", "gauge_z");
  const Vector3 force = F.head<3>(), arm = vector(table, "force_x", "force_y", "force_z");
  row.offset_share = phase_of(table, session) * (force.dot(row.direction) < 0 ? -1 : 1);
  if (arm.isZero(0)) return;
  const std::optional<Pose> X_MT = axes.tip_at(row.states[0].shown);
  if (!X_MT) table.fail("", "the machine cannot be at the values of its actuators");
  F.tail<3>() += (X_MT->R * arm).cross(force);
}

}  // namespace counterflex::measurement_file
