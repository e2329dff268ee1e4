#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/mechanism.hpp"
#include "statics/model/travel_margin.hpp"

namespace counterflex {
namespace {

double unit_of(const Travel& travel) {
  return travel.kind == JointKind::prismatic ? mm : deg;
}
const char* unit_name(const Travel& travel) {
  return travel.kind == JointKind::prismatic ? "mm" : "deg";
}

// What a margin is compared with; a travel of one limit counts as 1 m or 1 rad.
double span_of(const Travel& travel) {
  const double span = travel.max - travel.min;
  return std::isfinite(span) && span > 0 ? span : 1;
}

}  // namespace

std::optional<AxisPlace> tightest_axis(const Mechanism& mechanism, const Eigen::VectorXd& rho) {
  std::optional<AxisPlace> tightest;
  for (std::size_t i = 0; i < mechanism.travel.size(); ++i) {
    const Travel& travel = mechanism.travel[i];
    const double value = shown_value(mechanism.shown, static_cast<Eigen::Index>(i), rho.data());
    const double margin = travel_margin(travel, value);
    if (!std::isfinite(margin)) continue;
    const double share = margin / span_of(travel);
    if (!tightest || share < tightest->share) tightest = AxisPlace{i, value, margin, share};
  }
  return tightest;
}

double actuator_distance(const Mechanism& mechanism, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd apart = a - b;
  for (std::size_t i = 0; i < mechanism.travel.size(); ++i)
    if (mechanism.travel[i].kind == JointKind::revolute) {
      double& angle = apart[static_cast<Eigen::Index>(i)];
      angle = std::remainder(angle, 2 * pi);
    }
  return apart.norm();
}

std::string axis_value(const Travel& travel, double value) {
  const double limit = (value < travel.min ? travel.min : travel.max) / unit_of(travel);
  return fmt::format("{} {}", format_beside(value / unit_of(travel), limit, 1), unit_name(travel));
}

std::string travel_range(const Travel& travel) {
  const auto limit = [&](double value) { return fmt::format("{:.6g}", rounded(value / unit_of(travel), 6)); };
  if (!std::isfinite(travel.max)) return fmt::format("from {} {}", limit(travel.min), unit_name(travel));
  if (!std::isfinite(travel.min)) return fmt::format("up to {} {}", limit(travel.max), unit_name(travel));
  return fmt::format("{} to {} {}", limit(travel.min), limit(travel.max), unit_name(travel));
}

std::string outside_travel_words(const Travel& travel, double value) {
  return fmt::format("{}: {} is outside its travel ({})", travel.name, axis_value(travel, value),
                     travel_range(travel));
}

}  // namespace counterflex
