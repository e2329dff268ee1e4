#include "compensation/solve/failures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {
namespace {

// The last digit of so many behind the point. It is needed for every move, and much faster than std::pow.
double last_digit(int decimals) {
  double power = 1;
  for (int i = 0; i < std::abs(decimals); ++i) power *= 10;
  return decimals < 0 ? power : 1 / power;
}

double rounding_of(LengthUnit unit, int decimals) {
  return 0.5 * (mm_per(unit) * mm) * last_digit(decimals) * std::sqrt(3.0);
}

int fewest_decimals(const Move& move, const WriteOptions& options) {
  const Decimals decimals = decimals_of(move, options);
  return std::min({decimals.end[0], decimals.end[1], decimals.end[2], decimals.inserted});
}

// To four digits: what exceeds a limit is also shown as larger.
double rounded_up(double value) {
  return std::ceil(value * 1e4) / 1e4;
}

double controlled_position(const Mechanism& mechanism, const Vector6& deviation) {
  return deviation.head<3>().cwiseProduct(controlled_axes(mechanism)).norm();
}

// By how much a rotation vector tilts `axis`. Of a large turn about the axis its components are another
// angle.
double tilt_angle(const Vector3& turn, const Vector3& axis) {
  const Vector3 turned = exp_so3(turn) * axis;
  return std::atan2(turned.cross(axis).norm(), turned.dot(axis));
}

// The tilt and the spin of a waypoint whose orientation the program gives.
std::optional<Failure> turn_failure(const Job& job, const Waypoint& w) {
  if (!w.R_MT) return std::nullopt;
  const Vector3 turn = w.after.tail<3>(), axis = w.R_MT->col(2);
  const double tilted = tilt_angle(turn, axis), spun = std::abs(turn.dot(axis));
  const auto fail = [&](const char* what, double angle, double tolerance) {
    return Failure{
        ErrorKind::not_compensated, w.line,
        fmt::format("verification failed: the tool is {} by {} deg at {:.1f} % of this move, the "
                    "tolerance is {:.6g} deg",
                    what, format_beside(angle / deg, tolerance / deg, 4), 100 * w.fraction, tolerance / deg),
        w.corrected_line};
  };
  if (tilted > job.options.tilt_tolerance) return fail("tilted", tilted, job.options.tilt_tolerance);
  const auto& most_spin = job.options.spin_tolerance;
  if (most_spin && spun > *most_spin) return fail("turned about its axis", spun, *most_spin);
  return std::nullopt;
}

std::string with_sign(double length, std::string_view what, bool first) {
  const double shown = rounded(length / mm, 1);
  return fmt::format("{}{} {:.7g}", first ? "" : " + ", what, shown);
}

/// What the value of a linear axis consists of; empty where it is not the sum of offset, program and tool,
/// and where the control shows another value.
std::string parts_of(const Travel& axis, const CommandedPlace& at, double value, double home) {
  constexpr double same = 1e-6;  // m
  const std::size_t c = std::string_view("XYZ").find(axis.name.back());
  if (at.model.mechanism.shown.differ()) return "";
  if (!axis.name.starts_with("axis ") || axis.name.size() != 6 || c > 2) return "";
  const Mechanism& mechanism = at.model.mechanism;
  const Pose X_MT_home = tip(mechanism, at.model.home);
  const bool follows = std::abs(value - home - (at.target - X_MT_home.p)[c]) < same;
  if (!follows || !at.frame.X_MW.R.isIdentity(same)) return "";
  const double offset = at.frame.X_MW.p[c], tool = (at.model.home.X_MP.p - X_MT_home.p)[c];
  const double rest = value - at.target[c] - tool;
  const char letter = "XYZ"[c];
  std::string text =
      at.frame.name.empty() ? "" : with_sign(offset, fmt::format("{} {}", at.frame.name, letter), true);
  text += with_sign(at.target[c] - offset, fmt::format("program {}", letter), text.empty());
  if (std::abs(tool) > same)
    text += with_sign(tool, at.tool > 0 ? fmt::format("tool T{}", at.tool) : "[tool]", false);
  if (std::abs(rest) > same) text += with_sign(rest, "machine", false);
  return text + " mm";
}

}  // namespace

double rounding_allowance(const Move& move, const WriteOptions& options) {
  return rounding_of(move.unit, fewest_decimals(move, options));
}

double rounding_as_read(const Move& move) {
  const Decimals decimals = decimals_of(move, {});
  int least = std::numeric_limits<int>::max();
  for (std::size_t axis = 0; axis < 3; ++axis)
    least = std::min(least, move.words[axis] ? decimals.end[axis] : decimals.inserted);
  return rounding_of(move.unit, least);
}

Failure few_decimals_failure(const Move& move, const CompensationOptions& options) {
  int enough = 0;
  while (rounding_of(move.unit, enough) > options.tolerance / 2) ++enough;
  return {
      ErrorKind::usage, move.line,
      fmt::format("words are rounded by up to {:.3g} mm here, which leaves too little of the tolerance of "
                  "{:.3g} mm; it needs --decimals {}",
                  rounding_allowance(move, options.write) / mm, options.tolerance / mm, enough)};
}

std::optional<Failure> decimals_failure(const Program& program, const Toolpath& path,
                                        const CompensationOptions& options) {
  std::optional<std::pair<LengthUnit, int>> last;  // digits that have been found to be enough
  for (const Segment& segment : path.segments) {
    const Move& move = program.moves[segment.move];
    const std::pair digits{move.unit, fewest_decimals(move, options.write)};
    if (last == digits) continue;
    if (rounding_allowance(move, options.write) >= options.tolerance)
      return few_decimals_failure(move, options);
    last = digits;
  }
  return std::nullopt;
}

Failure status_failure(const Job& job, Status status, const CommandedPlace& at, int line) {
  if (status == Status::outside_travel) {
    if (const auto word = ambiguous_integer_word(job.program, line))
      return {ErrorKind::program_text, word->line, word->what};
    return {ErrorKind::limit, line, outside_travel_words(job.model.mechanism, at), 0, status};
  }
  return {ErrorKind::not_compensated, line,
          fmt::format("the machine's equilibrium is not solved here: {}", to_string(status)), 0, status};
}

Failure status_failure(const Job& job, Status status, const Segment& segment, const Vector3& target) {
  const Move& move = job.program.moves[segment.move];
  return status_failure(
      job, status,
      {model_of(job, segment), job.path.frames[move.frame], move.tool, target, orientation_at(segment, 1)},
      segment.line);
}

std::optional<Failure> limit_failure(const Job& job, const Vector3& correction, int line) {
  const double size = correction.norm();
  if (size <= job.options.max_correction) return std::nullopt;
  if (const auto word = ambiguous_integer_word(job.program, line))
    return Failure{ErrorKind::program_text, word->line, word->what};
  return Failure{ErrorKind::limit, line,
                 fmt::format("the correction would be {:.4f} mm, more than the limit of {:.6g} mm",
                             rounded_up(size / mm), job.options.max_correction / mm)};
}

std::optional<Failure> turn_limit_failure(const Job& job, const Vector3& turn, int line) {
  const double size = turn.norm();
  if (size <= job.options.max_turn) return std::nullopt;
  return Failure{
      ErrorKind::limit, line,
      fmt::format("the correction would turn the tool by {:.4f} deg, more than the limit of {:.6g} deg",
                  rounded_up(size / deg), job.options.max_turn / deg)};
}

Vector3 controlled_axes(const Mechanism& mechanism) {
  Vector3 axes = Vector3::Zero();
  for (const Component c : mechanism.controlled)
    if (c <= Component::z) axes[static_cast<int>(c)] = 1;
  return axes;
}

double position_miss(const Job& job, const Waypoint& w) {
  return controlled_position(job.model.mechanism, w.after);
}

bool is_within_tolerance(const CompensationOptions& options, double miss) {
  constexpr double noise = 1e-6;  // relative: less than the digits that are shown
  return miss <= (1 + noise) * options.tolerance;
}

double share_of_tolerance(const CompensationOptions& options, const Mechanism& mechanism,
                          const BoxedOptional<Matrix3>& R_MT, const Vector6& deviation) {
  double share = controlled_position(mechanism, deviation) / options.tolerance;
  if (!R_MT) return share;
  const Vector3 turn = deviation.tail<3>(), axis = R_MT->col(2);
  share = std::max(share, tilt_angle(turn, axis) / options.tilt_tolerance);
  if (options.spin_tolerance) share = std::max(share, std::abs(turn.dot(axis)) / *options.spin_tolerance);
  return share;
}

bool is_below_band(const Job& job, const Waypoint& w, double share) {
  if (!w.covariance) return false;
  const Matrix3 controlled = controlled_axes(job.model.mechanism).asDiagonal();
  const auto is_below = [&](const Matrix3& part, const Vector3& d, const Matrix3& C) {
    return (part * d).norm() <= share * band(part * d, part * C * part.transpose());
  };
  if (!is_below(controlled, w.after.head<3>(), w.covariance->topLeftCorner<3, 3>())) return false;
  if (!w.R_MT) return true;
  const Vector3 turn = w.after.tail<3>(), axis = w.R_MT->col(2);
  const Matrix3 C = w.covariance->bottomRightCorner<3, 3>(), about = axis * axis.transpose();
  const auto& most_spin = job.options.spin_tolerance;
  return (tilt_angle(turn, axis) <= job.options.tilt_tolerance ||
          is_below(Matrix3::Identity() - about, turn, C)) &&
         (!most_spin || std::abs(turn.dot(axis)) <= *most_spin || is_below(about, turn, C));
}

std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) {
    const double miss = position_miss(job, w);
    if (w.exempt || w.insignificant) continue;
    if (auto failure = turn_failure(job, w)) return failure;
    if (is_within_tolerance(job.options, miss)) continue;
    return Failure{
        ErrorKind::not_compensated, w.line,
        fmt::format("verification failed: the tip misses the path by {} mm at {:.1f} % of this move, the "
                    "tolerance is {:.6g} mm",
                    format_beside(miss / mm, job.options.tolerance / mm, 4), 100 * w.fraction,
                    job.options.tolerance / mm),
        w.corrected_line};
  }
  return std::nullopt;
}

std::string outside_travel_words(const Mechanism& named, const CommandedPlace& at) {
  const Mechanism& mechanism = at.model.mechanism;
  Eigen::VectorXd rho = at.rho;
  if (rho.size() == 0) {
    const Pose X_MT{at.R.value_or(tip(mechanism, at.model.home).R), at.target};
    const NominalResult there = follow(at.model, at.model.home, X_MT);
    if (there.status != Status::converged) return "an actuator leaves its travel (outside_travel)";
    rho = actuator_values(mechanism, there.configuration);
  }
  const auto axis = tightest_axis(mechanism, rho);
  if (!axis || axis->margin >= 0) return "an actuator leaves its travel (outside_travel)";
  const Travel& travel = named.travel[axis->actuator];
  const double home = actuator_values(mechanism, at.model.home)[axis->actuator];
  const std::string parts = parts_of(travel, at, axis->value, home);
  const bool linear = travel.kind == JointKind::prismatic;
  return fmt::format(
      "{}{}{}; check the work offset (--work, [work]), the tool's length, and {} of the machine file",
      outside_travel_words(travel, axis->value), parts.empty() ? "" : ": ", parts,
      linear ? "min_mm and max_mm" : "min_deg and max_deg");
}

}  // namespace counterflex
