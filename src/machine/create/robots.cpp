#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "machine/create/robot_data.hpp"
#include "machine/create/words.hpp"

namespace counterflex::made {
namespace {

constexpr double robot_tool_mm = 200;

/// Compliances (rad/(N m)) of axes 1 to 3 and of the wrist, usual for a payload.
struct UsualJoints {
  double arm, wrist;
  std::string_view what;
};

UsualJoints usual_joints(const Robot& robot) {
  if (robot.maker == "ur") return {10e-6, 40e-6, "usual for strain wave gears of this size"};
  if (robot.payload_kg < 60) return {2.5e-6, 25e-6, "usual for a payload of 10 to 60 kg"};
  return {0.35e-6, 3e-6, "usual for a payload of 100 to 300 kg, as identified on a KUKA KR 270"};
}

/// Where a program of this maker's control takes its frame from.
std::string_view work_name(const Robot& robot) {
  if (robot.maker == "kuka") return "\"BASE_DATA[1]\"";
  if (robot.maker == "fanuc") return "\"UF 1\"";
  if (robot.maker == "abb") return "wobj1";
  return "";
}

const Robot& robot_of(const MachineFacts& facts) {
  std::vector<std::string_view> names;
  for (const Robot& robot : robots()) names.push_back(robot.name);
  const auto found = std::find(names.begin(), names.end(), facts.robot);
  if (found != names.end()) return robots()[static_cast<std::size_t>(found - names.begin())];
  if (facts.robot.empty())
    throw InputError(ErrorKind::usage, {},
                     fmt::format("robot6r needs --robot NAME, one of {}", fmt::join(names, ", ")));
  const std::string_view meant = nearest(facts.robot, names);
  throw InputError(
      ErrorKind::usage, {},
      fmt::format("--robot is '{}', must be one of {}; {}", facts.robot, fmt::join(names, ", "),
                  meant.empty() ? "for another robot, change the lengths in the file of one with "
                                  "the same build, or use counterflex import"
                                : fmt::format("did you mean {}?", meant)));
}

double compliance_of(const Robot& robot, std::size_t i) {
  const UsualJoints usual = usual_joints(robot);
  return robot.joints[i].compliance.value_or(i < 3 ? usual.arm : usual.wrist);
}

std::string joint_lines(const Robot& robot, std::size_t i) {
  const RobotJoint& joint = robot.joints[i];
  const std::string axis = fmt::format("A{}", i + 1);
  return fmt::format(
             "  {{ actuator = \"revolute\", axis = \"{}\"{}, min_deg = {}, max_deg = {}, home_deg = {}, "
             "harmonics_mdeg = [0, 0, 0, 0] }},\n",
             joint.axis, joint.shown, number(joint.min), number(joint.max), number(joint.home)) +
         fmt::format(
             "  {{ compliance = \"revolute\", axis = \"{}\", compliance_rad_per_Nm = {}, name = \"{}\" }},\n",
             joint.axis, number(compliance_of(robot, i)), axis);
}

/// The error slot of joint `i`, whose rotation about the axis is the joint's zero, and the link behind it.
std::string link_lines(const Robot& robot, std::size_t i) {
  const RobotJoint& joint = robot.joints[i];
  const std::string& place = i + 1 < robot.joints.size() ? robot.joints[i + 1].place : robot.flange;
  std::string text = fmt::format("  {{ error = \"A{}\" }},\n", i + 1);
  if (!place.empty() || joint.kg)
    text += fmt::format("  {{ rigid = {{ {} }}", place) +
            (joint.kg ? fmt::format(", mass = {{ kg = {}, at_mm = {}, name = \"link{}\" }}",
                                    number(*joint.kg), triple(joint.at_mm), i + 1)
                      : "") +
            " },\n";
  return text;
}

std::string arm(const Robot& robot) {
  std::string text = "\n[[chain]]\nname = \"arm\"\nelements = [\n";
  if (!robot.joints[0].place.empty())
    text += fmt::format("  {{ rigid = {{ {} }} }},\n", robot.joints[0].place);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) text += joint_lines(robot, i) + link_lines(robot, i);
  return text + "]\n";
}

std::string arm_parameters(const Robot& robot) {
  const UsualJoints usual = usual_joints(robot);
  const Knowledge position{sigma(0.5), NumberSource::prior, "usual before calibration"};
  const Knowledge orientation{sigma(0.05), NumberSource::prior, "usual before calibration"};
  std::string text = parameters_header();
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Knowledge stiffness = robot.joints[i].compliance
                                    ? Knowledge{percent(30), NumberSource::catalogue, robot.stiffness}
                                    : Knowledge{percent(100), NumberSource::prior, std::string(usual.what)};
    text += stated(fmt::format("A{}.compliance_rad_per_Nm", i + 1), stiffness);
  }
  for (std::size_t i = 0; i < robot.joints.size(); ++i)
    if (robot.joints[i].kg)
      text += stated(fmt::format("link{}.kg", i + 1), {percent(10), NumberSource::catalogue, robot.masses});
  for (std::size_t i = 0; i < robot.joints.size(); ++i)
    text += stated_errors(fmt::format("A{}", i + 1), {"x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg"},
                          position, orientation);
  return text;
}

std::string arm_head(const Robot& robot, const MachineFacts& facts) {
  std::string text = title(
      {fmt::format("counterflex new robot6r --robot {}", robot.name),
       fmt::format("Link lengths, axis directions and travel: {}. The machine frame M is the world frame of "
                   "the control. Compare the actuator values and the tip of `counterflex analyze --joints` "
                   "with the pendant at two poses before you use this file.",
                   robot.lengths),
       facts.name.empty() ? robot.title : facts.name, R"("x", "y", "z", "rx", "ry", "rz")"});
  if (robot.masses.empty())
    text += comment(
        "No masses are published for this robot, so no weight acts. Add mass = { kg = 40, at_mm = [0, 0, "
        "60], "
        "name = \"spindle\" } to elements and gravity_m_s2 = [0, 0, -9.81] here when you know them.");
  else
    text +=
        "gravity_m_s2 = [0, 0, -9.81]\ngravity_reference = \"home\"  # the control's zero was set under the "
        "weight\n";
  return text + fmt::format(
                    "\n[tool]  # the control's tool frame on the flange: replace it by yours\n"
                    "xyz_mm = [0, 0, {}]\n"
                    "spindle_axis = \"-z\"  # z points out of the tool\n"
                    "\n[limits]\nmax_correction_mm = 5\n",
                    number(robot_tool_mm));
}

/// The place under the tip at home (mm, whole).
Vector3 below_tip(const std::string& text) {
  Pose X;
  const Machine machine = read_machine(text, "machine.toml");
  for (const Element& element : machine.chains.at(0).elements) {
    if (const auto* rigid = std::get_if<Rigid>(&element)) X = X * rigid->X;
    if (const auto* actuator = std::get_if<Actuator>(&element))
      X = X * rotation(exp_so3(actuator->joint.axis * actuator->home));
  }
  constexpr double clearance_mm = 100;
  const Vector3 tip_mm = X * Vector3(0, 0, robot_tool_mm * mm) / mm;
  return (tip_mm - Vector3(0, 0, clearance_mm)).array().round();
}

}  // namespace

std::string robot_file(const MachineFacts& facts) {
  const Robot& robot = robot_of(facts);
  const std::string before = arm_head(robot, facts), after = arm(robot) + arm_parameters(robot);
  const std::string_view work = work_name(robot);
  if (work.empty()) return before + after;  // URScript gives its frames itself
  return before + work_offset(work, below_tip(before + after)) + after;
}

}  // namespace counterflex::made
