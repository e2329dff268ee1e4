#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "counterflex/geometry/types.hpp"
#include "import/serial_arm.hpp"
#include "import/toml_text.hpp"

namespace counterflex::import {
namespace {

// Placeholders of the compliance. Each joint alone gives the tip of an outstretched arm this stiffness:
// between that of a UR10 (0.06 N/um, joint 2 at 10 urad/(N m)) and of an arm for 270 kg (0.5 N/um). A linear
// axis has that of a light machine tool.
constexpr double tip_stiffness = 0.1 * N_per_um;
constexpr double axis_stiffness = 50 * N_per_um;
constexpr double shortest_lever = 0.05;  // m

constexpr std::array<std::string_view, 6> component_names = {"x", "y", "z", "rx", "ry", "rz"};
constexpr std::array<std::string_view, 6> error_components = {"x_mm",   "y_mm",   "z_mm",
                                                              "rx_deg", "ry_deg", "rz_deg"};

double unit_of(const ArmJoint& joint) {
  return joint.joint.kind == JointKind::revolute ? deg : mm;
}

std::string transform_text(const FixedTransform& fixed) {
  std::string text;
  if (!fixed.xyz.isZero(0)) text = "xyz_mm = " + list_mm(fixed.xyz);
  if (!fixed.rpy.isZero(0)) text += (text.empty() ? "" : ", ") + ("rpy_deg = " + list_deg(fixed.rpy));
  return text.empty() ? "{}" : "{ " + text + " }";
}

std::string with_comment(std::string line, std::string_view comment) {
  if (!comment.empty()) line += "  # " + comment_text(comment);
  return line + "\n";
}

std::string mass_text(const LinkMass& mass) {
  return fmt::format("mass = {{ kg = {}, at_mm = {}, name = {} }}", number(mass.kg), list_mm(mass.at),
                     toml_string(mass.name));
}

std::string axis_text(const Vector3& axis) {
  for (int i = 0; i < 3; ++i)
    if (axis == Vector3::Unit(i)) return fmt::format("\"{}\"", component_names[static_cast<std::size_t>(i)]);
  return fmt::format("[{}, {}, {}]", axis.x(), axis.y(), axis.z());
}

double compliance_of(const SerialArm& arm, std::size_t joint) {
  if (arm.joints[joint].joint.kind == JointKind::prismatic) return 1 / axis_stiffness;
  const double lever = std::max({reach(arm, joint), reach(arm, 0) / 2, shortest_lever});
  return 1 / (tip_stiffness * lever * lever);
}

std::string actuator_text(const ArmJoint& joint, double home, const SerialArm& arm) {
  const bool turns = joint.joint.kind == JointKind::revolute;
  const std::string_view unit = turns ? "deg" : "mm";
  std::string text = fmt::format("  {{ actuator = \"{}\", axis = {}", turns ? "revolute" : "prismatic",
                                 axis_text(joint.joint.axis));
  if (joint.min) text += fmt::format(", min_{} = {}", unit, number(*joint.min / unit_of(joint)));
  if (joint.max) text += fmt::format(", max_{} = {}", unit, number(*joint.max / unit_of(joint)));
  text += fmt::format(", home_{} = {}", unit, number(home / unit_of(joint)));
  if (turns) text += ", harmonics_mdeg = [0, 0, 0, 0]";
  std::string coupled;
  for (const auto& [other, factor] : joint.shown_with)
    coupled += fmt::format("{}J{} = {}", coupled.empty() ? "" : ", ", other + 1, number(factor));
  if (!coupled.empty()) text += fmt::format(", shown_with = {{ {} }}", coupled);
  const std::string more =
      joint.min && joint.max ? arm.travel_comment : "PLACEHOLDER: travel: the source does not state it";
  const std::string comment = joint.name + (joint.name.empty() || more.empty() ? "" : "; ") + more;
  return with_comment(text + " },", comment);
}

/// The elements of a joint: transforms, actuator, compliance, error slot, transforms; the mass beside the
/// last.
std::string joint_text(const SerialArm& arm, std::size_t index, double home) {
  const ArmJoint& joint = arm.joints[index];
  const bool turns = joint.joint.kind == JointKind::revolute;
  std::string text;
  for (const FixedTransform& fixed : joint.before)
    if (!fixed.is_identity())
      text += with_comment("  { rigid = " + transform_text(fixed) + " },", fixed.comment);
  text += actuator_text(joint, home, arm);
  text += fmt::format(
      "  {{ compliance = \"{}\", axis = {}, compliance_{} = {:.2g}, name = \"J{}\" }},  # PLACEHOLDER\n",
      turns ? "revolute" : "prismatic", axis_text(joint.joint.axis), turns ? "rad_per_Nm" : "m_per_N",
      compliance_of(arm, index), index + 1);
  std::vector<FixedTransform> after = joint.after;
  std::erase_if(after, [](const FixedTransform& fixed) { return fixed.is_identity(); });
  const std::string mass = joint.mass ? ", " + mass_text(*joint.mass) : "";
  text += fmt::format("  {{ error = \"J{}\"{} }},\n", index + 1, after.empty() ? mass : "");
  for (std::size_t i = 0; i < after.size(); ++i)
    text += with_comment(
        fmt::format("  {{ rigid = {}{} }},", transform_text(after[i]), i + 1 == after.size() ? mass : ""),
        after[i].comment);
  return text;
}

std::string head_text(const SerialArm& arm, const ArmHome& home) {
  std::string text;
  for (const std::string& line : arm.head) text += line + "\n";
  text +=
      "# Search for PLACEHOLDER: these numbers are not in the source. Replace them by measured or catalogue "
      "values.\n"
      "format = \"counterflex-machine 1\"\n";
  text += "name = " + toml_string(arm.name) + "\n";
  std::vector<std::string> names;
  for (const Component component : home.controlled)
    names.push_back(toml_string(component_names[static_cast<std::size_t>(component)]));
  text += fmt::format("controlled = [{}]{}\n", fmt::join(names, ", "),
                      !names.empty() ? ""
                      : arm.joints.size() > 6
                          ? "  # PLACEHOLDER: of more than six joints, make the external axes program_axis"
                          : "  # PLACEHOLDER: no regular home pose was found");
  const bool weighs =
      std::any_of(arm.joints.begin(), arm.joints.end(), [](const auto& joint) { return joint.mass; });
  if (weighs)
    text += fmt::format(
        "gravity_m_s2 = [0, 0, -9.81]            # PLACEHOLDER: for a base on the floor\n"
        "{}gravity_reference = \"home\"              # PLACEHOLDER: the robot was calibrated under its "
        "own weight\n",
        names.empty() ? "# when controlled has components: " : "");
  else
    text += "# PLACEHOLDER: masses: " + arm.mass_comment + "\n";
  return text;
}

std::string settings_text(const SerialArm& arm) {
  std::string text =
      fmt::format("\n[controller]\nkinematics = \"{}\"  # {}\n", arm.kinematics, arm.kinematics_comment);
  text += fmt::format(
      "\n[tool]                                  # PLACEHOLDER: the tool's tip in the last frame\n"
      "xyz_mm = [0, 0, 0]\nspindle_axis = \"{}\"\n",
      arm.spindle_axis);
  if (!arm.dialect.empty()) text += program_text(arm.dialect, arm.units);
  return text + "\n[limits]\nmax_correction_mm = 5                   # PLACEHOLDER\n";
}

std::string parameters_text(const SerialArm& arm) {
  std::string text =
      "\n# Names of numbers that measurements can identify. sigma is the standard deviation before a "
      "measurement.\n"
      "[parameters]\n";
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const ArmJoint& joint = arm.joints[i];
    const bool turns = joint.joint.kind == JointKind::revolute;
    text += fmt::format("\"J{}.compliance_{}\" = {{ prior_percent = {}, source = \"prior\" }}\n", i + 1,
                        turns ? "rad_per_Nm" : "m_per_N", turns ? 200 : 100);
    for (std::size_t c = 0; c < 6; ++c)
      text += fmt::format("\"J{}.{}\" = {{ sigma = {}, source = \"prior\" }}\n", i + 1, error_components[c],
                          number(c < 3 ? arm.sigma_mm : arm.sigma_deg));
    if (!joint.mass) continue;
    const bool doubtful = !joint.mass->doubt.empty();
    text += fmt::format("{} = {{ prior_percent = {}, source = \"{}\", note = {} }}",
                        toml_string(joint.mass->name + ".kg"), doubtful ? 50 : 10,
                        doubtful ? "prior" : "catalogue", toml_string(joint.mass->note));
    text += doubtful ? "  # PLACEHOLDER: " + comment_text(joint.mass->doubt) + "\n" : "\n";
  }
  return text;
}

}  // namespace

std::string machine_text(const SerialArm& arm) {
  const ArmHome home = choose_home(arm);
  std::string text = head_text(arm, home) + settings_text(arm);
  text += fmt::format("\n[[chain]]\nname = \"{}\"\n", arm.chain);
  if (std::any_of(arm.joints.begin(), arm.joints.end(),
                  [](const ArmJoint& joint) { return joint.joint.kind == JointKind::revolute; }))
    text +=
        "# PLACEHOLDER: the home values select the branch (elbow up or down, wrist) on which joint values "
        "are "
        "solved.\n";
  text += "elements = [\n";
  for (std::size_t i = 0; i < arm.joints.size(); ++i) text += joint_text(arm, i, home.shown[i]);
  for (const FixedTransform& fixed : arm.end)
    if (!fixed.is_identity())
      text += with_comment("  { rigid = " + transform_text(fixed) + " },", fixed.comment);
  return text + "]\n" + parameters_text(arm);
}

}  // namespace counterflex::import
