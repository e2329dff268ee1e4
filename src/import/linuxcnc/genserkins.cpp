#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "counterflex/geometry/types.hpp"
#include "counterflex/import/import.hpp"
#include "import/linuxcnc/kinematics.hpp"
#include "import/serial_arm.hpp"
#include "import/toml_text.hpp"

namespace counterflex::import {
namespace {

constexpr std::size_t serial_joints = 6;

std::vector<std::string> serial_pins() {
  std::vector<std::string> names = {"genserkins.max-iterations", "genserkins.last-iterations"};
  for (std::size_t i = 0; i < serial_joints; ++i)
    for (const char* kind : {"A", "ALPHA", "D", "unrotate"})
      names.push_back(fmt::format("genserkins.{}-{}", kind, i));
  return names;
}

/// LinuxCNC computes the joint angle as shown - unrotate * (joint angle before it). So the shown value is the
/// joint angle + unrotate * (shown before - unrotate before * (...)).
std::vector<std::pair<std::size_t, double>> couplings(const std::vector<int>& unrotate, std::size_t joint) {
  std::vector<std::pair<std::size_t, double>> list;
  double factor = unrotate[joint];
  for (std::size_t other = joint; other-- > 0 && factor != 0;) {
    list.insert(list.begin(), {other, factor});
    factor *= -unrotate[other];
  }
  return list;
}

int unrotate_of(const LinuxCnc& source, std::size_t joint) {
  const std::string name = fmt::format("genserkins.unrotate-{}", joint);
  if (joint == 0 || !source.pins.contains(name)) return 0;  // the default of all versions
  const double value = pin_value(source.pins, name, source.file);
  if (value != std::round(value) || std::abs(value) > 100)
    fail(source.pins.at(name).at, fmt::format("{} is {}; it must be a whole number", name, number(value)));
  return static_cast<int>(value);
}

}  // namespace

std::string genserkins_machine(const LinuxCnc& source) {
  refuse_unknown_pins(source.pins, serial_pins());
  SerialArm arm;
  arm.name = machine_name(source);
  arm.head = {fmt::format("{}linuxcnc: genserkins of {}", import_mark, file_name(source.file))};
  if (source.ini == nullptr)
    arm.head.push_back("# PLACEHOLDER: lengths are taken to be in mm: the HAL file does not state the unit.");
  std::vector<int> unrotate;
  for (std::size_t i = 0; i < serial_joints; ++i) {
    const auto pin = [&](const char* kind) {
      return pin_value(source.pins, fmt::format("genserkins.{}-{}", kind, i), source.file);
    };
    ArmJoint joint;
    joint.name = fmt::format("joint {}", i);
    joint.before.push_back({{pin("A") * source.length, 0, 0}, {pin("ALPHA"), 0, 0}});
    joint.after.push_back({{0, 0, pin("D") * source.length}, Vector3::Zero()});
    const Travel travel = travel_of_joint(source.ini, i, deg);
    joint.min = travel.min;
    joint.max = travel.max;
    unrotate.push_back(unrotate_of(source, i));
    joint.shown_with = couplings(unrotate, i);
    arm.joints.push_back(std::move(joint));
  }
  arm.kinematics_comment = "LinuxCNC computes with these lengths";
  arm.mass_comment =
      "the files have none. Add mass = { kg = ..., at_mm = [...], name = \"...\" } to elements, and "
      "gravity_m_s2";
  arm.dialect = "linuxcnc";
  arm.units = program_units(source);
  return machine_text(arm);
}

}  // namespace counterflex::import
