#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "counterflex/files/text.hpp"
#include "counterflex/import/import.hpp"
#include "import/serial_arm.hpp"
#include "import/toml_text.hpp"
#include "import/urdf/urdf_text.hpp"

namespace counterflex {
namespace import {
namespace {

using Link = urdf::LinkConstSharedPtr;

std::string names_of_links(const UrdfText& text) {
  constexpr std::size_t most = 40;
  std::vector<std::string> names;
  for (const auto& [name, element] : text.links)
    if (names.size() < most) names.push_back(without_controls(name));
  return fmt::format("{}{}", fmt::join(names, ", "), text.links.size() > most ? ", ..." : "");
}

Link find_link(const urdf::ModelInterface& model, const std::string& name, std::string_view option,
               const UrdfText& text) {
  if (Link link = model.getLink(name)) return link;
  std::vector<std::string_view> known;
  for (const auto& [other, element] : text.links) known.push_back(other);
  const std::string_view meant = nearest(name, known);
  fail(
      text.robot(),
      fmt::format("{} is '{}', which is not a link of the robot{}; links: {}", option, without_controls(name),
                  meant.empty() ? "" : fmt::format("; did you mean {}?", meant), names_of_links(text)));
}

/// The only link below `base` without children.
Link only_end(const Link& base, const UrdfText& text) {
  std::vector<Link> ends, open = {base};
  while (!open.empty()) {
    const Link link = open.back();
    open.pop_back();
    if (link->child_links.empty()) ends.push_back(link);
    open.insert(open.end(), link->child_links.begin(), link->child_links.end());
  }
  if (ends.size() == 1) return ends.front();
  std::vector<std::string> names;
  for (const Link& end : ends) names.push_back(without_controls(end->name));
  std::sort(names.begin(), names.end());
  fail(text.robot(), fmt::format("the robot has several ends below {}: {}; choose one with --tip",
                                 without_controls(base->name), fmt::join(names, ", ")));
}

/// The joints from `base` to `tip`.
std::vector<urdf::JointSharedPtr> path_between(const Link& base, const Link& tip, const UrdfText& text) {
  std::vector<urdf::JointSharedPtr> path;
  std::vector<std::string> above;
  for (Link link = tip; link != base; link = link->getParent()) {
    if (link->getParent() == nullptr)
      fail(text.place(*text.links.at(tip->name)),
           above.empty()
               ? fmt::format("the tip {} is the root of the robot; no joint leads to it",
                             without_controls(tip->name))
               : fmt::format("no path leads from the base {} to the tip {}; the links above the tip are {}",
                             without_controls(base->name), without_controls(tip->name),
                             fmt::join(above, ", ")));
    above.push_back(without_controls(link->getParent()->name));
    path.push_back(link->parent_joint);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

void refuse_joint(const urdf::Joint& joint, const UrdfText& text) {
  const Location at = text.place(*text.joints.at(joint.name));
  const std::string name = without_controls(joint.name);
  if (joint.mimic)
    fail(at, fmt::format("the joint {} follows {} (mimic); an imported machine has one actuator per joint. "
                         "Choose --base and --tip so that the path does not "
                         "contain it",
                         name, without_controls(joint.mimic->joint_name)));
  if (joint.type == urdf::Joint::FLOATING || joint.type == urdf::Joint::PLANAR)
    fail(at, fmt::format(
                 "the joint {} is {}; joints of the path must be revolute, continuous, prismatic or fixed",
                 name, joint.type == urdf::Joint::FLOATING ? "floating" : "planar"));
  if (Vector3(joint.axis.x, joint.axis.y, joint.axis.z).norm() == 0)
    fail(at, fmt::format("the axis of the joint {} is a zero vector; it must have a direction", name));
  if (joint.type != urdf::Joint::CONTINUOUS && !(joint.limits->lower + 1e-9 < joint.limits->upper))
    fail(at, fmt::format("the upper limit of the joint {}, {:.9g}, is not above the lower, {:.9g}", name,
                         joint.limits->upper, joint.limits->lower));
}

/// Sum of the masses of a link and of all links that are fixed to it, and their centre.
struct FixedMasses {
  double kg = 0;
  Vector3 moment = Vector3::Zero();  ///< kg m
  bool has_zero_inertia = false;

  void add(const Link& link, const Pose& X) {
    if (link->inertial && link->inertial->mass > 0) {
      const urdf::Inertial& inertial = *link->inertial;
      const urdf::Vector3& p = inertial.origin.position;
      kg += inertial.mass;
      moment += inertial.mass * (X * Vector3(p.x, p.y, p.z));
      has_zero_inertia = has_zero_inertia || (inertial.ixx == 0 && inertial.iyy == 0 && inertial.izz == 0);
    }
  }
};

void add_fixed(const Link& link, const Pose& X, const UrdfText& text, FixedMasses& masses) {
  masses.add(link, X);
  for (const urdf::JointSharedPtr& joint : link->child_joints)
    if (joint->type == urdf::Joint::FIXED) {
      const auto child =
          std::find_if(link->child_links.begin(), link->child_links.end(),
                       [&](const urdf::LinkSharedPtr& other) { return other->parent_joint == joint; });
      if (child != link->child_links.end())
        add_fixed(*child, X * origin_of(*text.joints.at(joint->name)).pose(), text, masses);
    }
}

std::optional<LinkMass> mass_of(const Link& link, const UrdfText& text) {
  FixedMasses masses;
  add_fixed(link, Pose{}, text, masses);
  if (masses.kg < 1e-9) return std::nullopt;  // less than the machine file shows
  LinkMass mass;
  mass.kg = masses.kg;
  mass.at = masses.moment / masses.kg;
  mass.name = identifier(link->name);
  mass.note = "inertial of the URDF";
  if (masses.has_zero_inertia) mass.doubt = "the inertia beside the mass is zero, so the mass may be a stub";
  return mass;
}

ArmJoint joint_of(const urdf::Joint& joint, const Link& child, const UrdfText& text) {
  ArmJoint result;
  result.name = joint.name;
  const bool slides = joint.type == urdf::Joint::PRISMATIC;
  result.joint = {slides ? JointKind::prismatic : JointKind::revolute,
                  Vector3(joint.axis.x, joint.axis.y, joint.axis.z).stableNormalized()};
  if (joint.type != urdf::Joint::CONTINUOUS) {
    result.min = joint.limits->lower;
    result.max = joint.limits->upper;
  }
  result.mass = mass_of(child, text);
  return result;
}

/// Adds the number of the last joint to the name of its mass, if an earlier mass has this name: "a b" and
/// "a.b" are both a_b.
void name_mass(std::vector<ArmJoint>& joints) {
  std::optional<LinkMass>& mass = joints.back().mass;
  if (!mass) return;
  const auto is_taken = [&](const ArmJoint& other) { return other.mass && other.mass->name == mass->name; };
  while (mass->name.empty() || std::any_of(joints.begin(), joints.end() - 1, is_taken))
    mass->name += fmt::format("_{}", joints.size());
}

/// Names of the links that joints beside the path move: they are not imported.
std::vector<std::string> left_out(const std::vector<urdf::JointSharedPtr>& path, const Link& base) {
  std::vector<std::string> names;
  std::vector<Link> open = {base};
  while (!open.empty()) {
    const Link link = open.back();
    open.pop_back();
    for (const urdf::LinkSharedPtr& child : link->child_links) {
      const bool beside = std::find(path.begin(), path.end(), child->parent_joint) == path.end();
      if (beside && child->parent_joint->type != urdf::Joint::FIXED)
        names.push_back(comment_text(child->name));
      else
        open.push_back(child);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace
}  // namespace import

std::string import_urdf(std::string_view text, const std::string& file, const std::string& base,
                        const std::string& tip) {
  using namespace import;
  UrdfText urdf;
  read_urdf_text(text, file, urdf);
  const urdf::ModelInterfaceSharedPtr model = parse_urdf(urdf);
  const Link first = base.empty() ? Link(model->getRoot()) : find_link(*model, base, "--base", urdf);
  const Link last = tip.empty() ? only_end(first, urdf) : find_link(*model, tip, "--tip", urdf);
  const std::vector<urdf::JointSharedPtr> path = path_between(first, last, urdf);
  SerialArm arm;
  arm.name = comment_text(model->getName());
  if (arm.name.empty()) arm.name = file_stem(file);
  arm.head = {fmt::format("{}urdf: {}, from {} to {}", import_mark, file_name(file),
                          comment_text(first->name), comment_text(last->name)),
              fmt::format("# M is {}, P is {}.", comment_text(first->name), comment_text(last->name))};
  for (const urdf::JointSharedPtr& joint : path) {
    FixedTransform origin = origin_of(*urdf.joints.at(joint->name));
    origin.comment = joint->name;
    arm.end.push_back(origin);
    if (joint->type == urdf::Joint::FIXED) continue;
    refuse_joint(*joint, urdf);
    arm.joints.push_back(joint_of(*joint, model->getLink(joint->child_link_name), urdf));
    name_mass(arm.joints);
    arm.end.back().comment.clear();  // it is that of the actuator
    arm.joints.back().before = std::move(arm.end);
    arm.end.clear();
  }
  if (arm.joints.empty())
    fail(urdf.robot(), fmt::format("the path from {} to {} has no joint that moves",
                                   without_controls(first->name), without_controls(last->name)));
  if (const std::vector<std::string> names = left_out(path, first); !names.empty())
    arm.head.push_back(
        fmt::format("# Left out, with everything behind them, because other joints move them: {}.",
                    fmt::join(names, ", ")));
  arm.kinematics_comment = "PLACEHOLDER: the control computes with the lengths of the URDF";
  arm.mass_comment =
      "the URDF has none. Add mass = { kg = ..., at_mm = [...], name = \"...\" } to elements, and "
      "gravity_m_s2";
  return machine_text(arm);
}

}  // namespace counterflex
