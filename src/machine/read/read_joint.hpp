#pragma once
/// Reads joints and springs of one coordinate from the machine file.
#include "counterflex/machine/machine.hpp"
#include "machine/read/read_shown.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// Adds the actuator to `before`.
Actuator read_actuator(const toml::table& table, const Reading& reading, ActuatorsBefore& before);
Passive read_passive(const toml::table& table, const Reading& reading);
Compliance read_compliance(const toml::table& table, const Reading& reading);

}  // namespace counterflex::toml_file
