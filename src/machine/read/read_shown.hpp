#pragma once
/// Keys of an actuator that are about the control: its external axis, and how its value is shown.
#include <set>
#include <string_view>
#include <vector>

#include "counterflex/machine/machine.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// The actuators of the file before an element.
struct ActuatorsBefore {
  std::vector<JointKind> kinds;  ///< of the numbered ones
  std::set<int> program_axes;
};

/// The keys of `read_shown` for values of this kind of joint.
std::vector<std::string_view> shown_keys(JointKind kind);

/// Reads `program_axis`, `shown_sign`, `shown_zero_mm` or `shown_zero_deg`, and `shown_with` of an actuator
/// whose joint is read. Adds the actuator to `before`.
void read_shown(const toml::table& table, const Reading& reading, ActuatorsBefore& before,
                Actuator& actuator);

/// Converts the shown home values, as the file has them, to joint values.
void convert_homes(Machine& machine);

}  // namespace counterflex::toml_file
