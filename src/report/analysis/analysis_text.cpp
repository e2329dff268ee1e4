#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/compensation/options.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/tip_stiffness.hpp"
#include "report/analysis/analysis_parts.hpp"
#include "report/names.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

namespace {

std::string number_text(double value, int decimals) {
  return format_fixed(value, decimals);
}

// A number that fills its column is wider than the column by a blank.
std::string cell(double value, int decimals, std::size_t width) {
  const std::string text = number_text(value, decimals);
  return fmt::format("{:>{}}", text, std::max(width, text.size() + 1));
}

std::string cells(const Vector3& v, int decimals, std::size_t width) {
  return cell(v.x(), decimals, width) + cell(v.y(), decimals, width) + cell(v.z(), decimals, width);
}

std::string title(const AnalysisReport& report) {
  std::string text = report.machine.empty() ? "Machine without a name" : report.machine;
  if (!report.poses.empty()) text += fmt::format(", method {}", to_string(report.poses.front().method));
  if (!report.tool.empty()) text += "\nwith " + report.tool;
  const Vector6& F = report.load.F;
  const std::string own = own_loads(report);
  if (F.isZero(0)) return text + (own.empty() ? ", no load\n" : ", no load but " + own + "\n");
  return text +
         fmt::format("\nload ({}, {}, {}) N, ({}, {}, {}) N m at the {}, machine axes\n",
                     number_text(F[0], 2), number_text(F[1], 2), number_text(F[2], 2), number_text(F[3], 3),
                     number_text(F[4], 3), number_text(F[5], 3),
                     report.load.at_platform ? "platform's reference point" : "tool tip") +
         (own.empty() ? "" : "which acts in addition to " + own + "\n");
}

std::string deviations(const AnalysisReport& report) {
  std::string text = "\nDeviation of the tool tip, actual minus wanted\n";
  text += fmt::format("  {:>3}{:>31}{:>28}{:>27}\n", "", "wanted x y z, mm", "deviation, mm",
                      "rotation vector, deg");
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    const PoseAnalysis& pose = report.poses[i];
    text += fmt::format("  {:>3}{}", i + 1, cells(pose.X_MT.p / mm, 3, 11));
    if (has_values(pose.status))
      text += cells(pose.deviation.head<3>() / mm, 4, 9) + cells(pose.deviation.tail<3>() / deg, 4, 9) + "\n";
    else
      text += fmt::format("   {}\n", to_string(pose.status));
  }
  for (std::size_t i = 0; i < report.poses.size(); ++i)
    if (!report.poses[i].why.empty())
      text += wrapped("", fmt::format("  pose {}: {}", i + 1, report.poses[i].why), 4);
  return text;
}

std::string chain_row(std::size_t index, const ChainLoads& chain) {
  constexpr std::size_t width = 10;
  return fmt::format("  {:>3} {:<12.12}", index, chain.name) +
         cell(chain.wrench.head<3>().cwiseAbs().maxCoeff(), 2, width) +
         cell(chain[LoadKind::moment], 2, width) + cell(chain[LoadKind::group_moment], 2, width) +
         cell(chain[LoadKind::spring_translation] / mm, 3, width) +
         cell(chain[LoadKind::spring_rotation] / deg, 3, width) +
         cell(chain[LoadKind::spring_force], 2, width) + cell(chain[LoadKind::spring_torque], 2, width) +
         cell(chain[LoadKind::passive_change] / deg, 3, width) + "\n";
}

std::string chain_loads(const AnalysisReport& report) {
  std::string text = "\nLoads in the chains, largest components\n";
  for (std::size_t i = 0; i < report.poses.size(); ++i)
    if (report.poses[i].indeterminate)
      text +=
          fmt::format("  pose {}: redundant rigid closures, the wrenches are the smallest of many\n", i + 1);
  text += fmt::format("  {:>3} {:<12}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "", "end",
                      "end", "group", "spring", "spring", "spring", "spring", "passive");
  text += fmt::format("  {:>3} {:<12}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "chain", "N",
                      "N m", "N m", "mm", "deg", "N", "N m", "deg");
  for (std::size_t i = 0; i < report.poses.size(); ++i)
    for (const ChainLoads& chain : report.poses[i].chains) text += chain_row(i + 1, chain);
  return text;
}

std::string actuator_values_text(const Eigen::VectorXd& rho, const std::vector<Travel>& travel) {
  std::string text;
  for (Eigen::Index k = 0; k < rho.size(); ++k) {
    const bool slides = travel[k].kind == JointKind::prismatic;
    text += fmt::format("{:>11} {:<3}", number_text(rho[k] / (slides ? mm : deg), 4), slides ? "mm" : "deg");
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::string actuators(const AnalysisReport& report) {
  if (report.travel.empty()) return "";
  std::string text = "\nActuators\n";
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    const PoseAnalysis& pose = report.poses[i];
    if (pose.rho.size() == 0) continue;
    text += fmt::format("  {:>3} nominal {}\n", i + 1,
                        actuator_values_text(shown_values(report.shown, pose.rho), report.travel));
    if (pose.corrected && has_values(pose.corrected->status))
      text +=
          fmt::format("         ->   {}\n",
                      actuator_values_text(shown_values(report.shown, pose.corrected->rho), report.travel));
  }
  return text;
}

std::string corrected_targets(const AnalysisReport& report) {
  std::string text = "\nCorrected targets\n";
  text += fmt::format("  {:>3}{:>33}{:>33}\n", "", "x y z, mm", "roll pitch yaw, deg");
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    const PoseAnalysis& pose = report.poses[i];
    if (!pose.corrected) {
      if (has_values(pose.status))
        text += fmt::format("  {:>3}   undefined: the machine controls no component of the tip\n", i + 1);
      continue;
    }
    text += fmt::format("  {:>3}", i + 1);
    if (has_values(pose.corrected->status))
      text += cells(pose.corrected->X_MT.p / mm, 4, 11) + cells(to_rpy(pose.corrected->X_MT.R) / deg, 4, 11);
    text += fmt::format("   {}\n", to_string(pose.corrected->status));
  }
  return text;
}

std::string newtons_per_um(double stiffness) {
  return std::isfinite(stiffness) ? stiffness_text(stiffness * um, number_text(stiffness * um, 3)) : "rigid";
}

std::string softest(const PoseAnalysis& pose) {
  const Matrix6& C = *pose.tip_compliance;
  std::string text = fmt::format("      stiffness for a force at the tip along x, y, z: {}, {}, {} N/um",
                                 newtons_per_um(stiffness_along(C, Vector3::UnitX())),
                                 newtons_per_um(stiffness_along(C, Vector3::UnitY())),
                                 newtons_per_um(stiffness_along(C, Vector3::UnitZ())));
  if (pose.softest_stiffness != 0)
    text += fmt::format("\n      softest to a force at the tip along ({}, {}, {}): {} N/um",
                        number_text(pose.softest.x(), 3), number_text(pose.softest.y(), 3),
                        number_text(pose.softest.z(), 3), newtons_per_um(pose.softest_stiffness));
  return text + "\n";
}

// Shows values of the size of rounding as zero.
double clean(const Matrix6& K, int i, int j) {
  const double scale = K.block<3, 3>(i < 3 ? 0 : 3, j < 3 ? 0 : 3).cwiseAbs().maxCoeff();
  return std::abs(K(i, j)) < 1e-9 * scale ? 0.0 : K(i, j);
}

// Names of the columns, and of the rows before them.
struct MatrixLabels {
  std::array<const char*, 6> columns, rows;
};
constexpr MatrixLabels stiffness_labels{{"x, m", "y, m", "z, m", "rx, rad", "ry, rad", "rz, rad"},
                                        {"fx, N", "fy, N", "fz, N", "mx, N m", "my, N m", "mz, N m"}};
constexpr MatrixLabels compliance_labels{{"fx, N", "fy, N", "fz, N", "mx, N m", "my, N m", "mz, N m"},
                                         {"x, um", "y, um", "z, um", "rx, urad", "ry, urad", "rz, urad"}};

std::string matrix_text(std::size_t index, const Matrix6& K, const MatrixLabels& labels) {
  std::string text = fmt::format("  {:>3} {:<9}", index, "");
  for (const char* column : labels.columns) text += fmt::format("{:>13}", column);
  text += "\n";
  for (int i = 0; i < 6; ++i) {
    text += fmt::format("      {:<9}", labels.rows[i]);
    for (int j = 0; j < 6; ++j) text += fmt::format("{:>13.4e}", clean(K, i, j));
    text += "\n";
  }
  return text;
}

std::string stiffness_of(std::size_t index, const PoseAnalysis& pose) {
  if (!pose.tip_compliance)
    return fmt::format("  {:>3} undefined: the machine does not resist some wrench at the tip\n", index);
  if (!pose.tip_stiffness)
    return fmt::format("  {:>3} undefined: the machine is rigid in some direction\n", index) + softest(pose);
  return matrix_text(index, *pose.tip_stiffness, stiffness_labels) + softest(pose);
}

std::string stiffnesses(const AnalysisReport& report) {
  std::string text = "\nStiffness at the tool tip, machine axes: wrench (rows) per motion (columns)\n";
  for (std::size_t i = 0; i < report.poses.size(); ++i)
    if (has_values(report.poses[i].status)) text += stiffness_of(i + 1, report.poses[i]);
  text += "\nCompliance at the tool tip, machine axes: motion (rows) per wrench (columns)\n";
  for (std::size_t i = 0; i < report.poses.size(); ++i)
    if (const auto& C = report.poses[i].tip_compliance)
      text += matrix_text(i + 1, *C / um, compliance_labels);
  return text;
}

}  // namespace

std::string own_loads(const AnalysisReport& report) {
  if (report.weighs && report.preloaded) return "the machine's own weight and preloads";
  return report.weighs ? "the machine's own weight" : report.preloaded ? "the machine's preloads" : "";
}

std::string to_text(const AnalysisReport& report) {
  return title(report) + deviations(report) + chain_loads(report) + actuators(report) +
         corrected_targets(report) + stiffnesses(report) + details_text(report) + held_text(report) +
         curves_text(report);
}

}  // namespace counterflex
