#include "machine/describe/phrases.hpp"

#include <fmt/format.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

/// Removes rounding noise of conversions: 0 instead of 1e-15 or -0.
double tidy(double value) {
  return std::abs(value) < 1e-9 ? 0.0 : value;
}

std::string triple(const Vector3& v) {
  return fmt::format("{:.9g} {:.9g} {:.9g}", tidy(v[0]), tidy(v[1]), tidy(v[2]));
}

double unit(const Joint& joint) {
  return joint.kind == JointKind::prismatic ? mm : deg;
}

std::string_view unit_name(const Joint& joint) {
  return joint.kind == JointKind::prismatic ? "mm" : "deg";
}

}  // namespace

std::string counted(int count, std::string_view singular, std::string_view plural) {
  if (count == 0) return fmt::format("no {}", plural);
  return fmt::format("{} {}", count, count == 1 ? singular : plural);
}

std::string phrase_mm(const Vector3& p) {
  return fmt::format("{} mm", triple(p / mm));
}

std::string phrase_mass(double kg) {
  return fmt::format("{:.9g} kg", kg);
}

bool is_identity(const Pose& X) {
  return X.p.norm() < 1e-12 && (X.R - Matrix3::Identity()).norm() < 1e-12;
}

std::string phrase(const Pose& X) {
  if (is_identity(X)) return "none";
  const std::string xyz = "xyz " + phrase_mm(X.p);
  if (is_identity(rotation(X.R))) return xyz;
  const std::string rpy = fmt::format("rpy {} deg", triple(to_rpy(X.R) / deg));
  return is_identity(translation(X.p)) ? rpy : xyz + ", " + rpy;
}

std::string phrase(const Joint& joint) {
  const std::string_view way = joint.kind == JointKind::prismatic ? "prismatic along" : "revolute about";
  for (int i = 0; i < 3; ++i)
    if (joint.axis == Vector3::Unit(i)) return fmt::format("{} {}", way, "xyz"[i]);
  return fmt::format("{} ({:.6g} {:.6g} {:.6g})", way, tidy(joint.axis[0]), tidy(joint.axis[1]),
                     tidy(joint.axis[2]));
}

std::string phrase_value(const Joint& joint, double value) {
  return fmt::format("{:.9g} {}", tidy(value / unit(joint)), unit_name(joint));
}

std::string phrase_range(const Joint& joint, double min, double max) {
  const bool below = std::isfinite(max), above = std::isfinite(min);
  if (above && below)
    return fmt::format("{:.9g} to {:.9g} {}", tidy(min / unit(joint)), tidy(max / unit(joint)),
                       unit_name(joint));
  if (above) return "above " + phrase_value(joint, min);
  return below ? "below " + phrase_value(joint, max) : "without limits";
}

std::string phrase_shown(const Actuator& actuator) {
  const ShownValue& shown = actuator.shown;
  if (shown.sign == 1 && shown.zero == 0 && shown.coupled.empty()) return "";
  std::string text = shown.sign < 0 ? "shown = -q" : "shown = q";
  const auto sign = [](double value) { return value < 0 ? '-' : '+'; };
  if (shown.zero != 0)
    text += fmt::format(" {} {}", sign(shown.zero), phrase_value(actuator.joint, std::abs(shown.zero)));
  for (const auto& [other, factor] : shown.coupled)
    text += fmt::format(" {} {:.9g} J{}", sign(factor), std::abs(factor), other + 1);
  return text;
}

std::string phrase_errors(const Actuator& actuator) {
  std::string text;
  if (const auto& table = actuator.errors)
    text = fmt::format("errors of table {} ({})", table->name,
                       phrase_range(actuator.joint, table->positions.front(), table->positions.back()));
  if (const double most = largest_harmonic(actuator); most > 0)
    text = fmt::format("harmonics of {:.3g} mdeg", most / (1e-3 * deg));
  if (!actuator.reversal) return text;
  const bool linear = actuator.joint.kind == JointKind::prismatic;
  return text + fmt::format("{}reversal {:.9g} {}", text.empty() ? "" : ", ",
                            tidy(*actuator.reversal / (linear ? um : 1e-3 * deg)), linear ? "um" : "mdeg");
}

std::string phrase_stiffness(const Joint& joint, double stiffness) {
  return fmt::format("{:.6g} {}", stiffness, joint.kind == JointKind::prismatic ? "N/m" : "N m/rad");
}

}  // namespace counterflex
