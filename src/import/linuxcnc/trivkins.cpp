#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/import/import.hpp"
#include "import/linuxcnc/kinematics.hpp"
#include "import/serial_arm.hpp"
#include "import/toml_text.hpp"

namespace counterflex::import {
namespace {

/// The letter of each joint: what `coordinates=` of KINEMATICS gives, or X Y Z A B C U V W.
std::string letters_of(const LinuxCnc& source) {
  const PlacedText& kinematics = *source.ini->find("KINS", "KINEMATICS");
  std::string letters = "XYZABCUVW";
  constexpr std::string_view option = "coordinates=";
  if (const std::size_t at = kinematics.text.find(option); at != kinematics.text.npos) {
    letters = kinematics.text.substr(at + option.size());
    letters = letters.substr(0, letters.find_first_of(" \t"));
    for (char& letter : letters) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    if (letters.empty() || letters.find_first_not_of("XYZABCUVW") != letters.npos)
      fail(kinematics.at, fmt::format("coordinates are '{}'; allowed are the letters X Y Z A B C U V W",
                                      without_controls(letters)));
  }
  const auto joints = source.ini->number("KINS", "JOINTS");
  if (!joints || *joints < 1 || *joints > 9)
    fail(kinematics.at, "[KINS] must have JOINTS, the number of joints, from 1 to 9");
  return letters.substr(0, static_cast<std::size_t>(*joints));
}

/// The joints of an axis: a gantry moves one axis with two.
std::vector<std::size_t> joints_of(char letter, std::string_view letters) {
  std::vector<std::size_t> joints;
  for (std::size_t joint = 0; joint < letters.size(); ++joint)
    if (letters[joint] == letter) joints.push_back(joint);
  return joints;
}

/// The travel that all joints of the axis allow.
Travel common_travel(const LinuxCnc& source, char letter, const std::vector<std::size_t>& joints) {
  Travel common;
  for (const std::size_t joint : joints) {
    const PlacedText* type = source.ini->find(fmt::format("JOINT_{}", joint), "TYPE");
    if (type != nullptr && type->text != "LINEAR")
      fail(type->at, fmt::format("the TYPE of joint {}, axis {}, is '{}'; it must be LINEAR", joint, letter,
                                 without_controls(type->text)));
    const Travel travel = travel_of_joint(source.ini, joint, source.length);
    if (travel.min) common.min = std::max(*travel.min, common.min.value_or(*travel.min));
    if (travel.max) common.max = std::min(*travel.max, common.max.value_or(*travel.max));
  }
  if (common.min && common.max && !(*common.min + 1e-9 < *common.max))
    fail(source.ini->find("KINS", "KINEMATICS")->at,
         fmt::format("the joints {} of axis {} have no travel in common: the largest MIN_LIMIT is {}, the "
                     "least MAX_LIMIT is {}; correct them",
                     fmt::join(joints, ", "), letter, number(*common.min / source.length),
                     number(*common.max / source.length)));
  return common;
}

}  // namespace

std::string trivkins_machine(const LinuxCnc& source) {
  if (source.ini == nullptr)
    fail({source.file, 1, 1}, "trivkins is imported from the INI file, which has the travel");
  const std::string letters = letters_of(source);
  SerialArm mill;
  mill.name = machine_name(source);
  mill.chain = "axes";
  mill.head = {fmt::format("{}linuxcnc: trivkins of {}", import_mark, file_name(source.file)),
               "# PLACEHOLDER: the order of the axes in the chain, from the work to the tool: the files do "
               "not state it."};
  std::string left_out;
  for (const char letter : letters) {
    const std::size_t axis = std::string_view("XYZ").find(letter);
    if (axis == std::string_view::npos && left_out.find(letter) == left_out.npos)
      left_out += std::string(left_out.empty() ? "" : ", ") + letter;
  }
  for (const char letter : std::string_view("XYZ")) {
    const std::vector<std::size_t> joints = joints_of(letter, letters);
    if (joints.empty()) continue;
    ArmJoint axis;
    axis.name = fmt::format("{}, joint{} {}", letter, joints.size() == 1 ? "" : "s", fmt::join(joints, ", "));
    axis.joint = {JointKind::prismatic, Vector3::Unit(letter - 'X')};
    const Travel travel = common_travel(source, letter, joints);
    axis.min = travel.min;
    axis.max = travel.max;
    mill.joints.push_back(std::move(axis));
  }
  if (mill.joints.empty())
    fail(source.ini->find("KINS", "KINEMATICS")->at, "the machine has none of the axes X, Y and Z");
  if (!left_out.empty())
    mill.head.push_back(fmt::format(
        "# PLACEHOLDER: axes that are left out, because trivkins does not state where they are: {}.",
        left_out));
  mill.kinematics_comment = "LinuxCNC computes without errors of the axes";
  mill.mass_comment =
      "the files have none. Add mass = { kg = ..., at_mm = [...], name = \"...\" } to elements, and "
      "gravity_m_s2";
  mill.dialect = "linuxcnc";
  mill.units = program_units(source);
  mill.spindle_axis = "z";
  mill.sigma_mm = 0.02;
  mill.sigma_deg = 0.005;
  return machine_text(mill);
}

}  // namespace counterflex::import
