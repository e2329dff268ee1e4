#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "machine/definiteness.hpp"
#include "machine/read/beam.hpp"

namespace counterflex {
namespace {

constexpr double core_share = 0.8;  // of the diameter

struct Elasticity {
  double E, poisson;  // Pa, 1
};

Elasticity elasticity_of(ToolMaterial material) {
  return material == ToolMaterial::carbide ? Elasticity{600e9, 0.22} : Elasticity{210e9, 0.3};
}

/// Displacement along x (0) or y (1) per force there, m/N.
double compliance_along(const Element& element, int axis) {
  if (const auto* compliance = std::get_if<Compliance>(&element))
    return compliance->joint.axis[axis] * compliance->joint.axis[axis] / compliance->stiffness;
  if (const auto* spring = std::get_if<Spring>(&element)) return symmetric_inverse(spring->K)(axis, axis);
  return 0;
}

}  // namespace

std::vector<Element> radial_tool(double k) {
  return {Compliance{{JointKind::prismatic, Vector3::UnitX()}, k},
          Compliance{{JointKind::prismatic, Vector3::UnitY()}, k}};
}

Spring cantilever_tool(double diameter, double stickout, ToolMaterial material) {
  const auto [E, poisson] = elasticity_of(material);
  const double core = core_share * diameter, area = std::numbers::pi * core * core / 4;
  const double I = area * core * core / 16, G = E / (2 * (1 + poisson));
  const Beam beam{stickout, E * area, G * 2 * I, E * I, E * I};
  const Matrix3 x_to_minus_z{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
  return {"tool", symmetric_inverse(turned(tip_compliance(beam), x_to_minus_z))};
}

double radial_stiffness(const Tool& tool) {
  double x = 0, y = 0;
  for (const Element& element : tool.yields) {
    x += compliance_along(element, 0);
    y += compliance_along(element, 1);
  }
  const double most = std::max(x, y);
  return most > 0 ? 1 / most : std::numeric_limits<double>::infinity();
}

Pose tip_of(const Machine& machine, const Tool& tool) {
  if (!machine.X_PS || !tool.length) return machine.X_PT;
  return *machine.X_PS * Pose{Matrix3::Identity(), Vector3(0, 0, -*tool.length)};
}

bool changes_model(const Machine& machine, const Tool& tool) {
  return !tool.yields.empty() || (machine.X_PS && tool.length) || (tool.mass && !machine.gravity.g.isZero(0));
}

Machine with_tool(const Machine& machine, const Tool& tool) {
  Machine result = machine;
  const Pose X_PT = tip_of(machine, tool);
  result.X_PT = X_PT;
  if (tool.mass) {
    // Before the tool's springs, so that the holder's place in the platform carries it.
    PointMass mass = *tool.mass;
    mass.at = X_PT * mass.at;
    mass.is_of_tool = true;
    std::vector<Element>& elements = result.chains.front().elements;
    if (result.ends_with_tool_mass)
      elements.back() = mass;
    else
      elements.push_back(mass);
    result.ends_with_tool_mass = true;
  }
  if (tool.yields.empty()) return result;
  result.X_PT = {};
  result.p_EP = inverse(X_PT).p;
  if (result.home_X_MP) *result.home_X_MP = *result.home_X_MP * X_PT;
  if (result.chains.size() > 1) result.chains = {Chain{"machine and tool", {Group{result.chains}}}};
  std::vector<Element>& elements = result.chains.front().elements;
  elements.push_back(Rigid{X_PT});
  elements.insert(elements.end(), tool.yields.begin(), tool.yields.end());
  return result;
}

std::string stiffness_phrase(const Tool& tool) {
  if (tool.from == ToolStiffness::rigid)
    return tool.in_file ? "rigid" : "rigid, with its length from the tool table or the settings";
  const std::string at_tip = fmt::format("{:.3g} N/um at its tip", radial_stiffness(tool) / N_per_um);
  if (tool.from == ToolStiffness::radial) return "stiffness from holder_N_per_um: " + at_tip;
  if (tool.from == ToolStiffness::matrix) return "stiffness from a 6x6 matrix: " + at_tip;
  return fmt::format("stiffness from a {} cantilever of {:.9g} diameter core, {:.9g} mm long: {}",
                     tool.material == ToolMaterial::carbide ? "carbide" : "steel", core_share,
                     *tool.stickout / mm, at_tip);
}

}  // namespace counterflex
