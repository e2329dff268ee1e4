#include <fmt/format.h>

#include <cmath>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {
namespace {

constexpr double same = 1e-6;  // m

std::string with_sign(double length, std::string_view what, bool first) {
  const double shown = rounded(length / mm, 1);
  return fmt::format("{}{} {:.7g}", first ? "" : " + ", what, shown);
}

/// What the value of a linear axis consists of; empty where it is not the sum of offset, program and tool,
/// and where the control shows another value.
std::string parts_of(const Travel& axis, const CommandedPlace& at, double value, double home) {
  const std::size_t c = std::string_view("XYZ").find(axis.name.back());
  if (at.model.mechanism.shown.differ()) return "";
  if (!axis.name.starts_with("axis ") || axis.name.size() != 6 || c > 2) return "";
  const auto i = static_cast<Eigen::Index>(c);
  const Mechanism& mechanism = at.model.mechanism;
  const Pose X_MT_home = tip(mechanism, at.model.home);
  const bool follows = std::abs(value - home - (at.target - X_MT_home.p)[i]) < same;
  if (!follows || !at.frame.X_MW.R.isIdentity(same)) return "";
  const double offset = at.frame.X_MW.p[i], tool = (at.model.home.X_MP.p - X_MT_home.p)[i];
  const double rest = value - at.target[i] - tool;
  const char letter = "XYZ"[c];
  std::string text =
      at.frame.name.empty() ? "" : with_sign(offset, fmt::format("{} {}", at.frame.name, letter), true);
  text += with_sign(at.target[i] - offset, fmt::format("program {}", letter), text.empty());
  if (std::abs(tool) > same)
    text += with_sign(tool, at.tool > 0 ? fmt::format("tool T{}", at.tool) : "[tool]", false);
  if (std::abs(rest) > same) text += with_sign(rest, "machine", false);
  return text + " mm";
}

}  // namespace

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
  const double home = actuator_values(mechanism, at.model.home)[static_cast<Eigen::Index>(axis->actuator)];
  const std::string parts = parts_of(travel, at, axis->value, home);
  const bool linear = travel.kind == JointKind::prismatic;
  return fmt::format(
      "{}{}{}; check the work offset (--work, [work]), the tool's length, and {} of the machine file",
      outside_travel_words(travel, axis->value), parts.empty() ? "" : ": ", parts,
      linear ? "min_mm and max_mm" : "min_deg and max_deg");
}

}  // namespace counterflex
