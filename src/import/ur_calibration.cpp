#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/import/import.hpp"
#include "import/serial_arm.hpp"
#include "import/toml_text.hpp"

namespace counterflex {
namespace import {
namespace {

constexpr std::array<std::string_view, 6> links = {"shoulder", "upper_arm", "forearm",
                                                   "wrist_1",  "wrist_2",   "wrist_3"};
constexpr std::array<std::string_view, 6> joints = {"base",    "shoulder", "elbow",
                                                    "wrist 1", "wrist 2",  "wrist 3"};
constexpr std::array<std::string_view, 6> keys = {"x", "y", "z", "roll", "pitch", "yaw"};
constexpr std::array<double, 6> home_deg = {0, -90, -90, -90, 90, 0};

Location place(const YAML::Mark& mark, const std::string& file) {
  if (mark.is_null()) return {file, 1, 1};
  return {file, mark.line + 1, mark.column + 1};
}

std::string shown(const YAML::Node& node) {
  return node.IsScalar()     ? "'" + without_controls(node.Scalar()) + "'"
         : node.IsMap()      ? "a map"
         : node.IsSequence() ? "a list"
                             : "empty";
}

/// The keys of a map, each once, in `allowed`.
template <std::size_t N>
void check_map(const YAML::Node& map, const std::string& name, const std::array<std::string_view, N>& allowed,
               const std::string& file) {
  if (!map.IsMap())
    fail(place(map.Mark(), file), fmt::format("{} is {}; it must be a map", name, shown(map)));
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const std::string key = entry.first.Scalar();
    const Location at = place(entry.first.Mark(), file);
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
      const std::string_view meant = nearest(key, {allowed.begin(), allowed.end()});
      fail(at, fmt::format("unknown key '{}' in {}{}; allowed: {}", without_controls(key), name,
                           meant.empty() ? "" : fmt::format("; did you mean {}?", meant),
                           fmt::join(allowed, ", ")));
    }
    if (!seen.insert(key).second) fail(at, fmt::format("{} has the key '{}' twice", name, key));
  }
}

double number_under(const YAML::Node& link, std::string_view name, std::string_view key,
                    const std::string& file) {
  const YAML::Node node = link[std::string(key)];
  if (!node)
    fail(place(link.Mark(), file),
         fmt::format("{} lacks {}; a link has x, y, z (m) and roll, pitch, yaw (rad)", name, key));
  const std::string what = fmt::format("{}.{}", name, key);
  if (!node.IsScalar())
    fail(place(node.Mark(), file), fmt::format("{} is {}; it must be a finite number", what, shown(node)));
  return read_usable(node.Scalar(), place(node.Mark(), file), what);
}

double angle_under(const YAML::Node& link, std::string_view name, std::string_view key,
                   const std::string& file) {
  const double angle = number_under(link, name, key, file);
  constexpr double turn = 2 * pi;
  constexpr double rounding = 1e-6;
  if (!(std::abs(angle) <= turn + rounding))
    fail(place(link[std::string(key)].Mark(), file),
         fmt::format("{}.{} is {:.6g}; angles of a calibration file are in rad, at most a turn ({:.4f})",
                     name, key, angle, turn));
  return angle;
}

FixedTransform read_link(const YAML::Node& kinematics, std::string_view name, const std::string& file) {
  const YAML::Node link = kinematics[std::string(name)];
  if (!link)
    fail(place(kinematics.Mark(), file),
         fmt::format("kinematics lacks the link {}; an arm has {}", name, fmt::join(links, ", ")));
  check_map(link, std::string(name), keys, file);
  FixedTransform fixed;
  for (int i = 0; i < 3; ++i)
    fixed.xyz[i] = number_under(link, name, keys[static_cast<std::size_t>(i)], file);
  for (int i = 0; i < 3; ++i)
    fixed.rpy[i] = angle_under(link, name, keys[static_cast<std::size_t>(i) + 3], file);
  fixed.comment = name;
  constexpr double longest = 5;  // m; a UR20 reaches 1.75 m
  if (!(fixed.xyz.cwiseAbs().maxCoeff() <= longest))
    fail(place(link.Mark(), file),
         fmt::format(
             "{} is {:.6g} m away from the link before; lengths of a calibration file are in m, at most {}",
             name, fixed.xyz.norm(), longest));
  return fixed;
}

YAML::Node load(std::string_view text, const std::string& file) {
  try {
    return YAML::Load(std::string(text));
  } catch (const YAML::Exception& error) {
    fail(place(error.mark, file), fmt::format("not YAML: {}", without_controls(error.msg)));
  }
}

}  // namespace
}  // namespace import

std::string import_ur_calibration(std::string_view text, const std::string& file) {
  using namespace import;
  const YAML::Node document = load(text, file);
  const YAML::Node kinematics =
      document.IsMap() ? document["kinematics"] : YAML::Node(YAML::NodeType::Undefined);
  if (!kinematics)
    fail({file, 1, 1},
         "the file has no map kinematics; give the calibration that ur_calibration of the ROS driver has "
         "written");
  std::array<std::string_view, 7> allowed;
  std::copy(links.begin(), links.end(), allowed.begin());
  allowed.back() = "hash";
  check_map(kinematics, "kinematics", allowed, file);
  const YAML::Node hash = kinematics["hash"];
  SerialArm arm;
  arm.name = "Universal Robots arm" + (hash && hash.IsScalar() ? " " + hash.Scalar() : "");
  arm.head = {fmt::format("{}ur-calibration: the calibrated lengths of {}", import_mark, file_name(file)),
              "# M is the frame Base of the control, P its flange (tool0)."};
  for (std::size_t i = 0; i < links.size(); ++i) {
    ArmJoint joint;
    joint.name = joints[i];
    joint.before.push_back(read_link(kinematics, links[i], file));
    joint.min = -360 * deg;
    joint.max = 360 * deg;
    joint.home = home_deg[i] * deg;
    arm.joints.push_back(joint);
  }
  arm.kinematics = "factory";
  arm.kinematics_comment =
      "the control computes with these calibrated lengths: the errors are what they leave";
  arm.travel_comment = "PLACEHOLDER: travel of most UR arms";
  arm.mass_comment =
      "the calibration has none. Add mass = { kg = ..., at_mm = [...], name = \"...\" } to elements, and "
      "gravity_m_s2";
  arm.dialect = "ur";
  arm.sigma_mm = 0.2;
  arm.sigma_deg = 0.02;
  return machine_text(arm);
}

}  // namespace counterflex
