#include "identify/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "counterflex/geometry/types.hpp"
#include "identify/fit/residuals.hpp"

namespace counterflex {
namespace {

constexpr double most_spread = 5;  // ratio of measured to commanded motion that a probe's lever explains

/// Median distance from the median place (m).
double spread_of(const std::vector<Vector3>& places) {
  const auto median = [](std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  Vector3 centre;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Vector3& p : places) values.push_back(p[k]);
    centre[k] = median(values);
  }
  std::vector<double> distances;
  for (const Vector3& p : places) distances.push_back((p - centre).norm());
  return median(distances);
}

/// Whether a row depends on the frame of its session.
bool depends_on_frame(const Measurement& row) {
  Vector3 sum = Vector3::Zero();
  for (const FeaturePlace& place : row.places) sum += place.weight;
  return row.places.empty() || sum.norm() > 1e-6;
}

/// A stable machine deflects along a force: most readings of gauges along forces have the signs of these.
void check_signs(const Measurements& measurements, std::size_t s) {
  constexpr double along = 0.7;  // cosine of the angle between gauge and force
  std::size_t count = 0, against = 0;
  const Measurement* first = nullptr;
  for (const Measurement& row : measurements.rows) {
    if (row.session != s || !row.gauge.isZero(0)) continue;
    const Vector3 F = row.states[0].F.head<3>();
    const double force = F.dot(row.direction);
    if (std::abs(force) <= along * F.norm()) continue;
    ++count;
    if (force * row.value >= 0) continue;
    ++against;
    if (first == nullptr) first = &row;
  }
  if (2 * against <= count) return;
  throw InputError(
      ErrorKind::machine_or_force, first->at,
      fmt::format("session \"{}\": {} of {} readings are against their forces, first here: {:.4g} um under "
                  "{:.4g} N along the gauge; a reading is positive in the direction of gx, gy, gz, and the "
                  "force is that on the tool",
                  measurements.sessions[s].name, against, count, first->value / um,
                  first->states[0].F.head<3>().dot(first->direction)));
}

/// Readings of a tracker that are equal in every digit, for a third of the rows of a session: the rows were
/// copied. A few equal ones may be repeats.
void check_copies(const Measurements& measurements, std::size_t s) {
  std::map<std::vector<double>, const Measurement*> seen;
  std::size_t count = 0, copies = 0;
  const Measurement *copy = nullptr, *original = nullptr;
  for (const Measurement& row : measurements.rows) {
    if (row.session != s) continue;
    ++count;
    const CommandedState& state = row.states[0];
    std::vector<double> numbers(state.shown.begin(), state.shown.end());
    numbers.insert(numbers.end(), state.F.begin(), state.F.end());
    numbers.insert(numbers.end(), row.X.p.begin(), row.X.p.end());
    for (int i = 0; i < 9; ++i) numbers.push_back(row.X.R(i / 3, i % 3));
    const auto [found, is_new] = seen.try_emplace(std::move(numbers), &row);
    if (is_new) continue;
    ++copies;
    if (copy == nullptr) copy = &row, original = found->second;
  }
  if (3 * copies < count || copies < 3) return;
  throw InputError(
      ErrorKind::machine_or_force, copy->at,
      fmt::format("session \"{}\": {} of {} rows are copies, the first of {}:{}; a copy shows no "
                  "noise: give each row once",
                  measurements.sessions[s].name, copies, count, original->at.file, original->at.line));
}

}  // namespace

void check_sessions(const Measurements& measurements) {
  if (measurements.rows.empty())
    throw InputError(ErrorKind::machine_or_force, {}, "there are no measurements");
  for (std::size_t s = 0; s < measurements.sessions.size(); ++s) {
    const Session& session = measurements.sessions[s];
    std::size_t numbers = 0;
    double spread = 0;
    bool has_frame = false;
    const Measurement* first = nullptr;
    for (const Measurement& row : measurements.rows) {
      if (row.session != s) continue;
      numbers += session.kind == MeasurementKind::tracker_pose    ? 6
                 : session.kind == MeasurementKind::tracker_point ? 3
                                                                  : 1;
      if (first == nullptr) first = &row;
      has_frame = has_frame || depends_on_frame(row);
      spread = std::max(spread, (row.states[0].shown - first->states[0].shown).cwiseAbs().maxCoeff());
    }
    // Sizes of a coupon leave the radius of the tool unknown, not the frame.
    const std::size_t unknowns = session.has_known_frame ? 0 : has_frame ? unknowns_of(session).size() : 1;
    if (first == nullptr) continue;
    if (session.kind == MeasurementKind::static_push || session.kind == MeasurementKind::hung_weight)
      check_signs(measurements, s);
    if (session.has_loading != session.has_unloading)
      throw InputError(
          ErrorKind::machine_or_force, first->at,
          fmt::format("session \"{}\" has rows of phase {} alone; friction shows in the difference: add rows "
                      "of phase {}, or leave the column out",
                      session.name, session.has_loading ? "loading" : "unloading",
                      session.has_loading ? "unloading" : "loading"));
    if (numbers <= unknowns)
      throw InputError(
          ErrorKind::machine_or_force, first->at,
          fmt::format("session \"{}\" has {} measured numbers; its frames alone have {} freedoms: measure "
                      "more states",
                      session.name, numbers, unknowns));
    const bool needs_motion = unknowns > 0 && session.kind != MeasurementKind::static_push &&
                              session.kind != MeasurementKind::hung_weight;
    if (needs_motion && spread < 1e-6)
      throw InputError(ErrorKind::machine_or_force, first->at,
                       fmt::format("all rows of session \"{}\" have the same actuator values; no fit can "
                                   "separate its frames from the machine's parameters: measure other states",
                                   session.name));
    if (session.kind == MeasurementKind::tracker_point || session.kind == MeasurementKind::tracker_pose)
      check_copies(measurements, s);
  }
}

void check_units(const Session& session, const std::vector<const Measurement*>& rows,
                 const std::vector<Pose>& X_MT) {
  const bool is_tracker =
      session.kind == MeasurementKind::tracker_point || session.kind == MeasurementKind::tracker_pose;
  if (!is_tracker || rows.size() < 5) return;
  std::vector<Vector3> measured, tips;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    measured.push_back(rows[i]->X.p);
    tips.push_back(X_MT[i].p);
  }
  const double spread = spread_of(measured), moved = spread_of(tips);
  if (spread < most_spread * moved && moved < most_spread * spread) return;
  throw InputError(
      ErrorKind::machine_or_force, rows[0]->at,
      fmt::format(
          "session \"{}\": the measured positions spread {:.3g} mm about their middle, the tip at the "
          "actuator values {:.3g} mm; check the units of x, y, z and of the actuators (mm or inch, deg "
          "or rad)",
          session.name, spread / mm, moved / mm));
}

}  // namespace counterflex
