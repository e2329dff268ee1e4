#include "identify/noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace counterflex {
namespace {

constexpr int fewest_freedoms = 3;     // of a noise that is worth stating
constexpr double one_percent = 2.326;  // quantile of the normal distribution
// m. A smaller scatter means equal readings: their noise is below the resolution of the gauge, and unknown.
constexpr double least_noise = 1e-9;
// Controls show values with noise of their own: states that differ by less are repeats.
constexpr double same_length = 1e-5, same_angle = 1e-4;  // m, rad

bool is_tracker(MeasurementKind kind) {
  return kind == MeasurementKind::tracker_point || kind == MeasurementKind::tracker_pose;
}

/// Whether readings show the noise of a session. Sessions of single axes have the axis behind their name.
bool is_of(const RepeatedReading& reading, const Session& session) {
  const bool is_named = session.name == reading.session || session.name.starts_with(reading.session + " ");
  const bool has_readings =
      session.kind != MeasurementKind::cmm_feature && session.kind != MeasurementKind::squareness &&
      session.kind != MeasurementKind::scale && session.kind != MeasurementKind::clamped_torque;
  return is_named &&
         (reading.is_position ? is_tracker(session.kind) : has_readings && !is_tracker(session.kind));
}

/// Readings at one place; of rows their residuals, which do not have the small differences of the states.
using Place = std::vector<Vector3>;

Vector3 mean_of(const std::vector<Vector3>& all) {
  Vector3 sum = Vector3::Zero();
  for (const Vector3& one : all) sum += one;
  return sum / static_cast<double>(all.size());
}

/// Squares about the means of places, and readings less places.
struct Scatter {
  double squares = 0;
  int freedoms = 0;

  void add(const Place& place) {
    if (place.size() < 2) return;
    const Vector3 mean = mean_of(place);
    for (const Vector3& reading : place) squares += (reading - mean).squaredNorm();
    freedoms += static_cast<int>(place.size()) - 1;
  }
};

/// What makes rows of a session repeats: tools, actuator values, forces, directions, the place of the gauge
/// and the phase.
std::vector<long> key_of(const Measurement& row, const std::vector<Actuator>& actuators) {
  std::vector<long> key;
  for (const CommandedState& at : row.states) {
    for (Eigen::Index i = 0; i < at.shown.size(); ++i) {
      const bool turns = actuators[static_cast<std::size_t>(i)].joint.kind == JointKind::revolute;
      key.push_back(std::lround(at.shown[i] / (turns ? same_angle : same_length)));
    }
    for (const double value : at.F) key.push_back(std::lround(value * 1e3));
    key.push_back(static_cast<long>(at.directions.forward));
    key.push_back(static_cast<long>(at.directions.backward));
    key.push_back(at.tool);
  }
  for (const double value : row.direction) key.push_back(std::lround(value * 1e4));
  for (const double value : row.gauge) key.push_back(std::lround(value / same_length));
  key.push_back(std::lround(row.offset_share));
  return key;
}

std::vector<Place> places_of(const FitProblem& problem, const Fit& fit, std::size_t session) {
  const std::vector<Actuator> all = actuators(problem.machine);
  std::map<std::vector<long>, Place> places;
  for (std::size_t i = 0; i < fit.rows.size(); ++i) {
    const Measurement& row = problem.measurements.rows[i];
    const RowResidual& at = fit.rows[i].at;
    if (row.session != session || !row.is_length || !at.is_found || fit.rows[i].weight == 0) continue;
    Vector3 residual = Vector3::Zero();
    residual.head(at.distances) = at.r.head(at.distances) * row.sigma;
    places[key_of(row, all)].push_back(residual);
  }
  std::vector<Place> list;
  for (auto& [key, place] : places) list.push_back(std::move(place));
  return list;
}

Scatter scatter_of_repeats(const Measurements& measurements, const Session& session) {
  std::map<std::string, Place> places;
  for (const RepeatedReading& reading : measurements.repeats)
    if (is_of(reading, session)) places[reading.place].push_back(reading.value);
  Scatter scatter;
  for (const auto& [name, place] : places) scatter.add(place);
  return scatter;
}

/// Whether a ratio of variances is above its 99 % quantile. Source: E. Paulson, "An approximate normalization
/// of the analysis of variance distribution", Ann. Math. Stat. 13 (1942).
bool is_above_chance(double ratio, double f1, double f2) {
  const double root = std::cbrt(ratio), a = 2 / (9 * f1), b = 2 / (9 * f2);
  return (1 - b) * root - (1 - a) > one_percent * std::sqrt(a + b * root * root);
}

}  // namespace

void check_repeats(const Measurements& measurements) {
  std::map<std::pair<std::string, std::string>, std::vector<const RepeatedReading*>> places;
  for (const RepeatedReading& reading : measurements.repeats) {
    if (std::none_of(measurements.sessions.begin(), measurements.sessions.end(),
                     [&](const Session& session) { return is_of(reading, session); }))
      throw InputError(
          ErrorKind::machine_or_force, reading.at,
          fmt::format("no session \"{}\" has rows of a {}; give repeats the session of the rows whose noise "
                      "they show",
                      reading.session, reading.is_position ? "tracker" : "gauge"));
    places[{reading.session, reading.place}].push_back(&reading);
  }
  for (const auto& [name, readings] : places)
    if (readings.size() < 2)
      throw InputError(ErrorKind::machine_or_force, readings[0]->at,
                       fmt::format("place \"{}\" has one reading; repeats need two or more at the same place",
                                   name.second));
}

void fill_noise(const FitProblem& problem, const Fit& fit, Identification& result) {
  Scatter all;
  for (std::size_t s = 0; s < problem.measurements.sessions.size(); ++s) {
    const Session& session = problem.measurements.sessions[s];
    if (session.kind == MeasurementKind::cmm_feature) continue;
    const std::vector<Place> places = places_of(problem, fit, s);
    Scatter scatter = scatter_of_repeats(problem.measurements, session);
    double misfit = 0, share = 0;
    for (const Place& place : places) {
      scatter.add(place);
      misfit += mean_of(place).squaredNorm();
      share += 1 / static_cast<double>(place.size());
    }
    const double noise = scatter.freedoms > 0 ? scatter.squares / scatter.freedoms : 0;
    if (noise < least_noise * least_noise) continue;
    all.squares += scatter.squares, all.freedoms += scatter.freedoms;
    if (scatter.freedoms < fewest_freedoms || places.empty()) continue;
    const auto count = static_cast<double>(places.size());
    misfit /= count, share /= count;
    SessionNoise entry{session.name, session.kind, std::sqrt(noise), scatter.freedoms, std::sqrt(misfit)};
    entry.noise_of_means = std::sqrt(noise * share);
    entry.lack_of_fit = std::sqrt(std::max(0.0, misfit - noise * share));
    const double components = is_tracker(session.kind) ? 3 : 1;
    entry.is_lacking =
        is_above_chance(misfit / (noise * share), components * count, components * scatter.freedoms);
    result.noise.push_back(entry);
  }
  if (all.freedoms >= fewest_freedoms) result.repeatability = std::sqrt(all.squares / all.freedoms);
}

}  // namespace counterflex
