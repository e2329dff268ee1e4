#include "counterflex/report/path_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/statistics.hpp"
#include "counterflex/statics/tip_uncertainty.hpp"
#include "report/tally/causes.hpp"

namespace counterflex {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

using Values = std::array<float, quantity_count>;

constexpr std::array<std::string_view, quantity_count> quantity_names = {"before_x_mm",
                                                                         "before_y_mm",
                                                                         "before_z_mm",
                                                                         "before_mm",
                                                                         "before_along_mm",
                                                                         "before_across_mm",
                                                                         "before_tool_axis_mm",
                                                                         "before_rotation_deg",
                                                                         "after_x_mm",
                                                                         "after_y_mm",
                                                                         "after_z_mm",
                                                                         "after_mm",
                                                                         "after_along_mm",
                                                                         "after_across_mm",
                                                                         "after_tool_axis_mm",
                                                                         "after_rotation_deg",
                                                                         "geometry_x_mm",
                                                                         "geometry_y_mm",
                                                                         "geometry_z_mm",
                                                                         "geometry_mm",
                                                                         "load_x_mm",
                                                                         "load_y_mm",
                                                                         "load_z_mm",
                                                                         "load_mm",
                                                                         "fixture_x_mm",
                                                                         "fixture_y_mm",
                                                                         "fixture_z_mm",
                                                                         "fixture_mm",
                                                                         "gravity_x_mm",
                                                                         "gravity_y_mm",
                                                                         "gravity_z_mm",
                                                                         "gravity_mm",
                                                                         "preloads_x_mm",
                                                                         "preloads_y_mm",
                                                                         "preloads_z_mm",
                                                                         "preloads_mm",
                                                                         "superposition_x_mm",
                                                                         "superposition_y_mm",
                                                                         "superposition_z_mm",
                                                                         "superposition_mm",
                                                                         "discrepancy_x_mm",
                                                                         "discrepancy_y_mm",
                                                                         "discrepancy_z_mm",
                                                                         "discrepancy_mm",
                                                                         "air_mm",
                                                                         "correction_x_mm",
                                                                         "correction_y_mm",
                                                                         "correction_z_mm",
                                                                         "correction_mm",
                                                                         "force_x_N",
                                                                         "force_y_N",
                                                                         "force_z_N",
                                                                         "force_N",
                                                                         "before_band_mm",
                                                                         "after_band_mm"};

float& at(Values& values, Quantity first, int offset = 0) {
  return values[static_cast<std::size_t>(first) + static_cast<std::size_t>(offset)];
}

/// Three components from `first` on, then their norm.
void set_vector(Values& values, Quantity first, const Vector3& v) {
  for (int i = 0; i < 3; ++i) at(values, first, i) = static_cast<float>(v[i]);
  at(values, first, 3) = static_cast<float>(v.norm());
}

void set_position(Values& values, Quantity first, const Vector6& deviation) {
  set_vector(values, first, deviation.head<3>() / mm);
}

/// Position, its split and the rotation: the eight quantities of before and after.
void set_deviation(Values& values, Quantity first, const Waypoint& w, const Vector6& deviation) {
  set_position(values, first, deviation);
  const DeviationSplit split = split_deviation(deviation.head<3>() / mm, w.direction, w.tool_axis);
  at(values, first, 4) = static_cast<float>(split.along);
  at(values, first, 5) = static_cast<float>(split.across);
  at(values, first, 6) = static_cast<float>(split.tool_axis);
  at(values, first, 7) = static_cast<float>(deviation.tail<3>().norm() / deg);
}

/// Whether the machine has what a cause is of. Preloads have a curve where they move the tip.
bool acts(const Cause& cause, const Causes& causes, PathCurves::Known known) {
  if (cause.curve == Quantity::fixture_x) return known.fixture;
  if (cause.curve == Quantity::gravity_x) return known.weights;
  return cause.curve != Quantity::preloads_x || !cause.of(causes).isZero(0);
}

void set_causes(Values& values, const Waypoint& w, const Causes& causes, PathCurves::Known known) {
  if (w.place) {
    for (const Cause& cause : all_causes)
      if (acts(cause, causes, known)) set_position(values, cause.curve, cause.of(causes));
    set_position(values, Quantity::superposition_x, causes.superposition);
    set_position(values, Quantity::discrepancy_x, w.before - causes.superposition);
  }
  if (known.corrected) at(values, Quantity::air) = static_cast<float>(causes.air.head<3>().norm() / mm);
}

void set_bands(Values& values, const Waypoint& w, PathCurves::Known known) {
  const auto set = [&](Quantity quantity, const Vector6& deviation) {
    at(values, quantity) =
        static_cast<float>(band(deviation.head<3>(), w.covariance->topLeftCorner<3, 3>()) / mm);
  };
  if (w.place) set(Quantity::before_band, w.before);
  if (known.corrected) set(Quantity::after_band, w.after);
}

Values values_of(const Waypoint& w, PathCurves::Known known) {
  Values values;
  values.fill(unknown);
  set_vector(values, Quantity::force_x, w.wrench.head<3>());
  if (known.corrected) set_deviation(values, Quantity::after_x, w, w.after);
  if (w.place) set_deviation(values, Quantity::before_x, w, w.before);
  if (w.covariance) set_bands(values, w, known);
  if (w.causes && knows_before(w)) set_causes(values, w, *w.causes, known);
  if (w.between) return values;
  if (known.corrected) set_position(values, Quantity::correction_x, w.correction);
  return values;
}

std::array<float, 3> floats(const Vector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Stretch stretch_of(const Waypoint& w, PathCurves::Known known) {
  Stretch stretch;
  stretch.s_mm = w.s / mm;
  stretch.first_line = stretch.last_line = w.line;
  stretch.place = floats(w.p_MT / mm);
  stretch.direction = floats(w.direction);
  stretch.before.fill(unknown);
  stretch.after.fill(unknown);
  if (w.place) stretch.before = floats(w.before.head<3>() / mm);
  if (known.corrected) stretch.after = floats(w.after.head<3>() / mm);
  stretch.least = stretch.largest = values_of(w, known);
  return stretch;
}

/// Ignores an unknown (NaN) value.
float lesser(float a, float b) {
  return b < a || std::isnan(a) ? b : a;
}

float greater(float a, float b) {
  return b > a || std::isnan(a) ? b : a;
}

/// Whether the place drawn for two merged stretches is that of the second one.
bool shows_more(const Stretch& b, const Stretch& a, Quantity by) {
  const auto i = static_cast<std::size_t>(by);
  return b.largest[i] > a.largest[i] || std::isnan(a.largest[i]);
}

void append(Stretch& a, const Stretch& b, Quantity picture) {
  if (shows_more(b, a, picture)) {
    a.place = b.place;
    a.before = b.before;
    a.after = b.after;
  }
  a.s_mm = b.s_mm;
  a.last_line = b.last_line;
  if (a.operation < 0) a.operation = b.operation;
  a.begins_after_rapid = a.begins_after_rapid || b.begins_after_rapid;
  for (std::size_t i = 0; i < quantity_count; ++i) {
    a.least[i] = lesser(a.least[i], b.least[i]);
    a.largest[i] = greater(a.largest[i], b.largest[i]);
  }
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  return quantity_names[static_cast<std::size_t>(quantity)];
}

void PathMarks::add(double s) {
  if (count++ % stride_ != 0) return;
  if (s_mm.size() == most) {
    for (std::size_t i = 0; 2 * i < most; ++i) s_mm[i] = s_mm[2 * i];
    s_mm.resize(most / 2);
    stride_ *= 2;
  }
  s_mm.push_back(s);
}

PathCurves::PathCurves(bool corrected, bool weighs, bool has_fixture)
    : known_{corrected, weighs, has_fixture} {}

void PathCurves::add(const Waypoint& w, std::int32_t operation) {
  if (w.status != Status::converged) return;
  if (!w.cutting) {
    after_rapid_ = true;
    return;
  }
  if (after_rapid_) rapids_.add(s_mm_);
  Stretch stretch = stretch_of(w, known_);
  stretch.operation = operation;
  stretch.begins_after_rapid = std::exchange(after_rapid_, false);
  push(stretch);
}

void PathCurves::push(const Stretch& stretch) {
  s_mm_ = stretch.s_mm;
  ++waypoints_;
  if (!stretches_.empty() && in_last_ < per_stretch_) {
    ++in_last_;
    return append(stretches_.back(), stretch, picture());
  }
  if (stretches_.size() == most_stretches) merge_neighbours();
  if (stretches_.capacity() < most_stretches && stretches_.size() >= 1024) stretches_.reserve(most_stretches);
  stretches_.push_back(stretch);
  in_last_ = 1;
}

void PathCurves::merge_neighbours() {
  const std::size_t pairs = stretches_.size() / 2;
  for (std::size_t i = 0; i < pairs; ++i) {
    stretches_[i] = stretches_[2 * i];
    append(stretches_[i], stretches_[2 * i + 1], picture());
  }
  stretches_.resize(pairs);
  per_stretch_ *= 2;
}

Quantity PathCurves::picture() const {
  return known_.corrected ? Quantity::after : Quantity::before;
}

void PathCurves::add_force_step(double s_mm) {
  force_steps_.add(s_mm);
}

}  // namespace counterflex
