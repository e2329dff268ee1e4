#include <fmt/core.h>

#include <array>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "report/analysis/analysis_parts.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

namespace {

constexpr std::array components = {"x", "y", "z", "rx", "ry", "rz"};

const char* kind_of(PartKind kind) {
  switch (kind) {
    case PartKind::actuator:
      return "actuator";
    case PartKind::passive:
      return "passive";
    case PartKind::compliance:
      return "compliance";
    default:
      return "spring";
  }
}

double unit_of(const CoordinateDetail& coordinate) {
  return coordinate.angular ? deg : mm;
}

Json coordinate_json(const CoordinateDetail& c) {
  return {{"element", c.element},
          {"kind", kind_of(c.kind)},
          {"component",
           c.component < 0 ? Json(nullptr) : Json(components[static_cast<std::size_t>(c.component)])},
          {"unit", c.angular ? "deg" : "mm"},
          {"value", number(c.value / unit_of(c), analysis_digits)},
          {"change", number(c.change / unit_of(c), analysis_digits)},
          {"load", c.kind == PartKind::actuator ? Json(nullptr) : number(c.load, analysis_digits)},
          {"load_unit", c.angular ? "N m" : "N"}};
}

Json rows_json(const Eigen::Matrix<double, Eigen::Dynamic, 6>& rows) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < rows.rows(); ++i) list.push_back(six_json(rows.row(i).transpose()));
  return list;
}

Json names_json(const ChainDetail& chain, const std::vector<std::size_t>& coordinates) {
  Json list = Json::array();
  for (const std::size_t i : coordinates) list.push_back(name_of(chain.coordinates[i]));
  return list;
}

Json detail_json(const ChainDetail& chain) {
  Json coordinates = Json::array();
  for (const CoordinateDetail& c : chain.coordinates) coordinates.push_back(coordinate_json(c));
  const bool stiff = chain.stiffness.available;
  return {{"name", chain.name},
          {"wrench_N_Nm", numbers(chain.wrench, analysis_digits)},
          {"energy_J", significant(chain.energy, analysis_significant_digits)},
          {"eps_si", chain.eps ? six_json(*chain.eps) : Json(nullptr)},
          {"dt_si", chain.dt ? six_json(*chain.dt) : Json(nullptr)},
          {"stiffness_si", stiff ? matrix_json(chain.stiffness.K_C) : Json(nullptr)},
          {"K_Cq_si", stiff ? rows_json(chain.stiffness.K_Cq) : Json(nullptr)},
          {"K_Cq_rows", names_json(chain, chain.passive)},
          {"K_Ctheta_si", stiff ? rows_json(chain.stiffness.K_Ctheta) : Json(nullptr)},
          {"K_Ctheta_rows", names_json(chain, chain.elastic)},
          {"coordinates", std::move(coordinates)}};
}

std::string twist_text(const std::optional<Vector6>& twist) {
  if (!twist) return "unknown: a group of the chain has no stiffness in some direction";
  const auto three = [](const Vector3& v) {
    return fmt::format("({}, {}, {})", format_fixed(v.x(), 4), format_fixed(v.y(), 4),
                       format_fixed(v.z(), 4));
  };
  return three(twist->head<3>() / mm) + " mm, " + three(twist->tail<3>() / deg) + " deg";
}

std::string wrench_text(const Vector6& F) {
  return fmt::format("({}, {}, {}) N, ({}, {}, {}) N m", format_fixed(F[0], 2), format_fixed(F[1], 2),
                     format_fixed(F[2], 2), format_fixed(F[3], 3), format_fixed(F[4], 3),
                     format_fixed(F[5], 3));
}

std::string detail_text(std::size_t index, const ChainDetail& chain) {
  std::string text = fmt::format("  {:>3} chain {}\n", index, chain.name);
  text += "      wrench on its end  " + wrench_text(chain.wrench) + "\n";
  text += fmt::format("      elastic energy     {:.6g} J\n", chain.energy);
  text += "      errors, eps        " + twist_text(chain.eps) + "\n";
  text += "      motion minus eps   " + twist_text(chain.dt) + "\n";
  text += fmt::format("      {:<44}{:>14}{:>14}{:>14}\n", "element", "value", "change", "load");
  for (const CoordinateDetail& c : chain.coordinates) {
    const char* const unit = c.angular ? "deg" : "mm";
    text += fmt::format("      {:<44}{:>10} {:<3}{:>10} ", name_of(c), format_fixed(c.value / unit_of(c), 4),
                        unit, format_fixed(c.change / unit_of(c), 4));
    if (c.kind == PartKind::actuator)
      text += fmt::format("{}\n", unit);
    else
      text += fmt::format("{:<3}{:>10} {}\n", unit, format_fixed(c.load, 3), c.angular ? "N m" : "N");
  }
  return text;
}

}  // namespace

std::string name_of(const CoordinateDetail& c) {
  std::string name = c.element + " " + kind_of(c.kind);
  if (c.component >= 0) name += fmt::format(" {}", components[static_cast<std::size_t>(c.component)]);
  return name;
}

Json details_json(const std::vector<ChainDetail>& chains) {
  Json list = Json::array();
  for (const ChainDetail& chain : chains) list.push_back(detail_json(chain));
  return list;
}

Json held_json(const HeldPose& held) {
  const bool known = held.status == Status::converged;
  return {
      {"tip_mm", numbers(Vector3(held.X_MT.p / mm), analysis_digits)},
      {"tip_rpy_deg", numbers(Vector3(to_rpy(held.X_MT.R) / deg), analysis_digits)},
      {"status", to_string(held.status)},
      {"why", held.why.empty() ? Json(nullptr) : Json(held.why)},
      {"wrench_at_tip_N_Nm", known ? numbers(held.at_tip, analysis_digits) : Json(nullptr)},
      {"wrench_at_reference_point_N_Nm", known ? numbers(held.at_platform, analysis_digits) : Json(nullptr)},
      {"chains", details_json(held.chains)}};
}

std::string details_text(const AnalysisReport& report) {
  std::string text;
  for (std::size_t i = 0; i < report.poses.size(); ++i)
    for (const ChainDetail& chain : report.poses[i].details) text += detail_text(i + 1, chain);
  return text.empty() ? "" : "\nThe chains in full; matrices with --json\n" + text;
}

std::string held_text(const AnalysisReport& report) {
  std::string text;
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    if (!report.poses[i].held) continue;
    const HeldPose& held = *report.poses[i].held;
    const Vector3 p = held.X_MT.p / mm, rpy = to_rpy(held.X_MT.R) / deg;
    text += fmt::format("\nHeld with the tip at ({}, {}, {}) mm, ({}, {}, {}) deg; actuators of pose {}\n",
                        format_fixed(p.x(), 4), format_fixed(p.y(), 4), format_fixed(p.z(), 4),
                        format_fixed(rpy.x(), 4), format_fixed(rpy.y(), 4), format_fixed(rpy.z(), 4), i + 1);
    if (held.status != Status::converged) {
      text += wrapped("  ", fmt::format("{}: {}", to_string(held.status), held.why), 2);
      continue;
    }
    text += "  wrench that holds it, at the tool tip         " + wrench_text(held.at_tip) + "\n";
    text += "  wrench that holds it, at the reference point  " + wrench_text(held.at_platform) + "\n";
    for (const ChainDetail& chain : held.chains)
      text += fmt::format("  of it chain {:<34.34}{}\n", chain.name, wrench_text(chain.wrench));
  }
  return text;
}

}  // namespace counterflex
