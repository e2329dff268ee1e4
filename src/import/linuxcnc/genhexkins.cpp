#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/import/import.hpp"
#include "import/linuxcnc/kinematics.hpp"
#include "import/serial_arm.hpp"
#include "import/toml_text.hpp"

namespace counterflex::import {
namespace {

constexpr std::size_t struts = 6;
constexpr double strut_compliance = 2e-8;  // m/N: 50 N/um, of a screw with a steel tube; a placeholder
constexpr double sigma_mm = 0.1;           // of joints and lengths

struct Strut {
  Vector3 base, platform;  ///< m, in M and in P
  Travel travel;           ///< of the length
};

std::vector<std::string> hexapod_pins() {
  std::vector<std::string> names;
  for (const char* name : {"spindle-offset",
                           "tool-offset",
                           "screw-lead",
                           "convergence-criterion",
                           "limit-iterations",
                           "max-error",
                           "last-iterations",
                           "max-iterations",
                           "fwd-kins-fail",
                           "x",
                           "y",
                           "z",
                           "a",
                           "b",
                           "c",
                           "gui.x",
                           "gui.y",
                           "gui.z",
                           "gui.a",
                           "gui.b",
                           "gui.c"})
    names.push_back(fmt::format("genhexkins.{}", name));
  for (std::size_t i = 0; i < struts; ++i) {
    names.push_back(fmt::format("genhexkins.correction.{}", i));
    for (const char* end : {"base", "platform", "base-n", "platform-n"})
      for (const char axis : {'x', 'y', 'z'})
        names.push_back(fmt::format("genhexkins.{}.{}.{}", end, i, axis));
  }
  return names;
}

/// The value of a pin whose default is 0 in all versions. Connected with a signal it counts as 0 if
/// `may_change`.
double optional_pin(const LinuxCnc& source, const std::string& name, bool may_change = false) {
  const auto found = source.pins.find(name);
  if (found == source.pins.end() || (may_change && found->second.value.empty())) return 0;
  return pin_value(source.pins, name, source.file);
}

std::vector<Strut> read_struts(const LinuxCnc& source) {
  const double offset = optional_pin(source, "genhexkins.spindle-offset") +
                        optional_pin(source, "genhexkins.tool-offset", /*may_change=*/true);
  std::vector<Strut> list;
  for (std::size_t i = 0; i < struts; ++i) {
    const auto point = [&](const char* end) {
      Vector3 p;
      for (int k = 0; k < 3; ++k)
        p[k] = pin_value(source.pins, fmt::format("genhexkins.{}.{}.{}", end, i, "xyz"[k]), source.file);
      return Vector3((p + Vector3(0, 0, offset)) * source.length);
    };
    list.push_back({point("base"), point("platform"), travel_of_joint(source.ini, i, source.length)});
  }
  return list;
}

/// [TRAJ] HOME: X, Y and Z, and A, B and C, the roll, pitch and yaw of the platform, 0 if they are not given.
/// None if Z is 0, as by default: the platform is not in its base.
std::optional<FixedTransform> stated_home(const LinuxCnc& source) {
  const PlacedText* home = source.ini == nullptr ? nullptr : source.ini->find("TRAJ", "HOME");
  if (home == nullptr) return std::nullopt;
  Vector6 numbers = Vector6::Zero();
  std::string_view rest = home->text;
  for (int k = 0; k < 6; ++k) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (k >= 3 && (rest.empty() || rest.starts_with('#') || rest.starts_with(';'))) break;
    const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
    numbers[k] = read_usable(rest.substr(0, end), home->at, "each of the first six numbers of [TRAJ] HOME");
    rest.remove_prefix(end);
  }
  if (numbers[2] == 0) return std::nullopt;
  return FixedTransform{numbers.head<3>() * source.length, numbers.tail<3>() * deg};
}

/// As far from the base as the base joints are from their middle, on the side of positive z.
Vector3 assumed_home(const std::vector<Strut>& list) {
  Vector3 base = Vector3::Zero(), platform = Vector3::Zero();
  for (const Strut& strut : list) base += strut.base / struts, platform += strut.platform / struts;
  double radius = 0;
  for (const Strut& strut : list) radius += (strut.base - base).norm() / struts;
  return base - platform + Vector3(0, 0, radius);
}

std::string leg_text(std::size_t index, const Strut& strut, const FixedTransform& home) {
  const Matrix3 R_MP = home.pose().R;
  const Vector3 span = home.xyz + R_MP * strut.platform - strut.base;
  const Vector3 turn = log_so3(Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), span).toRotationMatrix());
  const Vector3 turn_back = home.rpy.isZero(0) ? Vector3(-turn) : log_so3(exp_so3(-turn) * R_MP);
  std::string travel;
  if (strut.travel.min) travel += ", min_mm = " + number(*strut.travel.min / mm);
  if (strut.travel.max) travel += ", max_mm = " + number(*strut.travel.max / mm);
  const bool is_known = strut.travel.min && strut.travel.max;
  return fmt::format(
      "\n[[chain]]\nname = \"leg{}\"\nelements = [\n"
      "  {{ rigid = {{ xyz_mm = {} }} }},  # base joint {}\n"
      "  {{ error = \"base\" }},\n"
      "  {{ rigid = {{ rotvec_deg = {} }} }},  # z is along the strut at home\n"
      "  {{ passive = \"revolute\", axis = \"y\" }},\n"
      "  {{ passive = \"revolute\", axis = \"x\" }},\n"
      "  {{ actuator = \"prismatic\", axis = \"z\"{}, home_mm = {} }},{}\n"
      "  {{ compliance = \"prismatic\", axis = \"z\", compliance_m_per_N = {:.2g}, name = \"strut\" }},  # "
      "PLACEHOLDER\n"
      "  {{ error = \"length\" }},\n"
      "  {{ passive = \"revolute\", axis = \"x\" }},\n"
      "  {{ passive = \"revolute\", axis = \"y\" }},\n"
      "  {{ passive = \"revolute\", axis = \"z\" }},\n"
      "  {{ rigid = {{ rotvec_deg = {} }} }},\n"
      "  {{ error = \"platform\" }},\n"
      "  {{ rigid = {{ xyz_mm = {} }} }},  # from platform joint {} to the reference point\n"
      "]\n",
      index + 1, list_mm(strut.base), index, list_deg(turn), travel, number(span.norm() / mm),
      is_known ? "" : "  # PLACEHOLDER: travel: the source does not state it", strut_compliance,
      list_deg(turn_back), list_mm(-strut.platform), index);
}

std::string hexapod_parameters() {
  std::string text =
      "\n# Names of numbers that measurements can identify. sigma is the standard deviation before a "
      "measurement.\n"
      "[parameters]\n";
  for (std::size_t i = 1; i <= struts; ++i) {
    text += fmt::format(
        "\"leg{}.strut.compliance_m_per_N\" = {{ prior_percent = 100, source = \"prior\" }}\n", i);
    for (const char* name :
         {"base.x", "base.y", "base.z", "length.z", "platform.x", "platform.y", "platform.z"})
      text += fmt::format("\"leg{}.{}_mm\" = {{ sigma = {}, source = \"prior\" }}\n", i, name, sigma_mm);
  }
  return text;
}

}  // namespace

std::string genhexkins_machine(const LinuxCnc& source) {
  refuse_unknown_pins(source.pins, hexapod_pins());
  if (optional_pin(source, "genhexkins.screw-lead") != 0)
    fail(source.pins.at("genhexkins.screw-lead").at,
         "the strut lengths depend on the orientation of the joints (screw-lead is not 0); this is not "
         "imported");
  const std::vector<Strut> list = read_struts(source);
  const std::optional<FixedTransform> stated = stated_home(source);
  const FixedTransform home = stated ? *stated : FixedTransform{assumed_home(list)};
  std::string text = fmt::format("{}linuxcnc: genhexkins of {}\n", import_mark, file_name(source.file));
  if (source.ini == nullptr)
    text += "# PLACEHOLDER: lengths are taken to be in mm: the HAL file does not state the unit.\n";
  text += fmt::format(
      "# Search for PLACEHOLDER: these numbers are not in the source. Replace them by measured or catalogue "
      "values.\n"
      "format = \"counterflex-machine 1\"\nname = {}\ncontrolled = [\"x\", \"y\", \"z\", \"rx\", \"ry\", "
      "\"rz\"]\n"
      "# PLACEHOLDER: masses: the files have none. Add mass = {{ kg = ..., at_mm = [...], name = \"...\" }} "
      "to elements, and gravity_m_s2\n"
      "\n[home]\nxyz_mm = {}{}\n{}"
      "\n[controller]\nkinematics = \"catalogue\"  # LinuxCNC computes with these joints\n"
      "\n[tool]                                  # PLACEHOLDER: the tool's tip in the platform frame\nxyz_mm "
      "= [0, 0, 0]\n"
      "{}"
      "\n[limits]\nmax_correction_mm = 5                   # PLACEHOLDER\n",
      toml_string(machine_name(source)), list_mm(home.xyz),
      stated ? "" : "  # PLACEHOLDER: a pose in the middle of the work space: the source does not state one",
      home.rpy.isZero(0) ? "" : fmt::format("rpy_deg = {}  # A, B, C of [TRAJ] HOME\n", list_deg(home.rpy)),
      program_text("linuxcnc", program_units(source)));
  for (std::size_t i = 0; i < struts; ++i) text += leg_text(i, list[i], home);
  return text + hexapod_parameters();
}

}  // namespace counterflex::import
