#include "machine/read/read_shown.hpp"

#include <fmt/format.h>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/shown.hpp"

namespace counterflex::toml_file {
namespace {

constexpr double largest_factor = 10;  // a larger coupling of two axes probably has a wrong unit

std::string_view zero_key(JointKind kind) {
  return kind == JointKind::prismatic ? "shown_zero_mm" : "shown_zero_deg";
}

void read_program_axis(const toml::node& node, const Source& source, ActuatorsBefore& before,
                       Actuator& actuator) {
  const std::string name = as_choice(node, "program_axis", {"E1", "E2", "E3", "E4", "E5", "E6"}, source);
  actuator.program_axis = name[1] - '0';
  if (!before.program_axes.insert(actuator.program_axis).second)
    source.fail(node,
                fmt::format("two actuators have program_axis = \"{0}\"; at most one actuator follows {0} "
                            "of the program",
                            name));
}

double read_sign(const toml::node& node, const Reading& reading) {
  const double sign = as_number(node, {"shown_sign"}, reading);
  if (sign != 1 && sign != -1)
    reading.source.fail(node, fmt::format("shown_sign is {:.9g}; it must be 1 or -1", sign));
  return sign;
}

/// The index of "J2" in the actuators before this one.
std::size_t read_number(const toml::key& key, JointKind kind, const Source& source,
                        const ActuatorsBefore& before) {
  const std::string_view name = key.str();
  const std::size_t own = before.kinds.size() + 1;
  const bool is_number = name.size() > 1 && name.size() <= 4 && name[0] == 'J' && name[1] != '0' &&
                         name.find_first_not_of("0123456789", 1) == std::string_view::npos;
  if (!is_number)
    source.fail(key, fmt::format("shown_with has the key \"{}\"; it must be J and the number of an actuator "
                                 "before this one, as in {{ J2 = 1 }}",
                                 name));
  const auto number = static_cast<std::size_t>(std::stoi(std::string(name.substr(1))));
  if (number >= own)
    source.fail(key, fmt::format("shown_with of actuator {} names {}; it must be an actuator before this one",
                                 own, name));
  if (before.kinds[number - 1] != kind)
    source.fail(key,
                fmt::format("shown_with couples a linear and a rotary actuator ({} with actuator {}); both "
                            "must be of one kind",
                            name, own));
  return number - 1;
}

void read_couplings(const toml::node& node, const Reading& reading, const ActuatorsBefore& before,
                    Actuator& actuator) {
  for (const auto& [key, value] : as_table(node, "shown_with", reading.source)) {
    const std::size_t number = read_number(key, actuator.joint.kind, reading.source, before);
    const double factor = as_number(value, {key.str()}, reading);
    if (!(std::abs(factor) <= largest_factor))
      reading.source.fail(value, fmt::format("shown_with has {} = {:.9g}; a factor from -{} to {} is allowed",
                                             key.str(), factor, largest_factor, largest_factor));
    actuator.shown.coupled.push_back({number, factor});
  }
}

/// An axis of the program has the value of its joint.
void refuse_shown(const toml::table& table, JointKind kind, const Source& source) {
  for (const std::string_view key :
       {std::string_view("shown_sign"), zero_key(kind), std::string_view("shown_with")})
    if (table.contains(key))
      source.fail(key_of(table, key),
                  fmt::format("{} is not allowed with program_axis; reverse the axis, or put a rigid element "
                              "before the actuator",
                              key));
}

void convert_homes(std::vector<Element>& elements, const Eigen::VectorXd& q, Eigen::Index& next) {
  for (Element& element : elements) {
    if (auto* actuator = std::get_if<Actuator>(&element); actuator != nullptr && actuator->program_axis == 0)
      actuator->home = q[next++];
    if (auto* group = std::get_if<Group>(&element))
      for (Branch& branch : group->branches) convert_homes(branch.elements, q, next);
  }
}

}  // namespace

std::vector<std::string_view> shown_keys(JointKind kind) {
  return {"program_axis", "shown_sign", zero_key(kind), "shown_with"};
}

void read_shown(const toml::table& table, const Reading& reading, ActuatorsBefore& before,
                Actuator& actuator) {
  const JointKind kind = actuator.joint.kind;
  if (const toml::node* node = table.get("program_axis")) {
    read_program_axis(*node, reading.source, before, actuator);
    return refuse_shown(table, kind, reading.source);
  }
  if (const toml::node* node = table.get("shown_sign")) actuator.shown.sign = read_sign(*node, reading);
  if (const toml::node* node = table.get(zero_key(kind)))
    actuator.shown.zero =
        as_number(*node, {zero_key(kind)}, reading) * (kind == JointKind::prismatic ? mm : deg);
  if (const toml::node* node = table.get("shown_with")) read_couplings(*node, reading, before, actuator);
  before.kinds.push_back(kind);
}

void convert_homes(Machine& machine) {
  const ShownActuators shown = shown_actuators(machine);
  if (!shown.differ()) return;
  const Eigen::VectorXd q = joint_values(shown, home_values(machine));
  Eigen::Index next = 0;
  for (Chain& chain : machine.chains) convert_homes(chain.elements, q, next);
}

}  // namespace counterflex::toml_file
