#include "counterflex/machine/parameters.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameter_places.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 6> error_units = {"x_mm",   "y_mm",   "z_mm",
                                                         "rx_deg", "ry_deg", "rz_deg"};
constexpr std::array<std::string_view, 6> spring_units = {"x_m_per_N",     "y_m_per_N",     "z_m_per_N",
                                                          "rx_rad_per_Nm", "ry_rad_per_Nm", "rz_rad_per_Nm"};

constexpr std::array<std::string_view, 4> harmonic_names = {"sin", "cos", "sin2", "cos2"};

/// (p, Log R): the six components of an assembly error.
Vector6 components(const Pose& X) {
  Vector6 c;
  c << X.p, log_so3(X.R);
  return c;
}

bool is_diagonal(const Matrix6& K) {
  return Matrix6(K.diagonal().asDiagonal()) == K;
}

/// Mean compliance in the three directions (m/N); 0 where the matrix has no inverse.
double mean_compliance(const Matrix6& K) {
  const Eigen::FullPivLU<Matrix6> lu(K);
  return lu.isInvertible() ? lu.inverse().diagonal().head<3>().mean() : 0;
}

/// The error of a table's position along or about the actuator's axis (m or rad).
double axis_error(const Actuator& actuator, int position) {
  const Vector6& error = actuator.errors->errors[static_cast<std::size_t>(position)];
  return actuator.joint.axis.dot(actuator.joint.kind == JointKind::prismatic ? Vector3(error.head<3>())
                                                                             : Vector3(error.tail<3>()));
}

double read(const Actuator& actuator, const ParameterPlace& place) {
  if (place.kind == ParameterKind::reversal) return *actuator.reversal;
  if (place.kind == ParameterKind::table) return axis_error(actuator, place.component);
  return actuator.harmonics[static_cast<std::size_t>(place.component)];
}

/// Other components of a table's error stay.
void write(Actuator& actuator, const ParameterPlace& place, double value) {
  if (place.kind == ParameterKind::reversal)
    actuator.reversal = value;
  else if (place.kind == ParameterKind::harmonic)
    actuator.harmonics[static_cast<std::size_t>(place.component)] = value;
  else
    actuator.errors->errors[static_cast<std::size_t>(place.component)].segment<3>(
        actuator.joint.kind == JointKind::prismatic ? 0 : 3) +=
        (value - axis_error(actuator, place.component)) * actuator.joint.axis;
}

double read(const ParameterPlace& place) {
  const int i = place.component;
  if (const auto* error = std::get_if<AssemblyError>(place.element)) return components(error->X)[i];
  if (const auto* joint = std::get_if<Compliance>(place.element)) return 1 / joint->stiffness;
  if (const auto* mass = std::get_if<PointMass>(place.element)) return mass->kg;
  if (const auto* actuator = std::get_if<Actuator>(place.element)) return read(*actuator, place);
  const auto& spring = std::get<Spring>(*place.element);
  return i >= 0 ? 1 / spring.K(i, i) : mean_compliance(spring.K);
}

void write(const ParameterPlace& place, double value) {
  const int i = place.component;
  if (auto* error = std::get_if<AssemblyError>(place.element)) {
    Vector6 c = components(error->X);
    c[i] = value;
    error->X = {exp_so3(c.tail<3>()), c.head<3>()};
  } else if (auto* joint = std::get_if<Compliance>(place.element)) {
    if (joint->beyond) joint->beyond->stiffness /= value * joint->stiffness;
    joint->stiffness = 1 / value;
  } else if (auto* mass = std::get_if<PointMass>(place.element)) {
    mass->kg = value;
  } else if (auto* actuator = std::get_if<Actuator>(place.element)) {
    write(*actuator, place, value);
  } else if (auto& spring = std::get<Spring>(*place.element); i >= 0) {
    spring.K(i, i) = 1 / value;
  } else {
    spring.K *= mean_compliance(spring.K) / value;
  }
}

/// Lists the parameters of a series of elements.
class Lister {
 public:
  Lister(std::vector<ParameterPlace>& list, std::vector<std::string> actuators)
      : list_(list), actuators_(std::move(actuators)) {}

  void add(std::vector<Element>& elements, const std::string& prefix) {
    int compliances = 0, masses = 0;
    std::map<std::string, int> springs;
    for (Element& element : elements) {
      if (auto* error = std::get_if<AssemblyError>(&element)) {
        for (int i = 0; i < 6; ++i)
          list_.push_back({prefix + error->name + "." + std::string(error_units[static_cast<std::size_t>(i)]),
                           i < 3 ? ParameterKind::position : ParameterKind::orientation, i < 3 ? mm : deg,
                           &element, i});
      } else if (auto* joint = std::get_if<Compliance>(&element)) {
        const std::string name =
            joint->name.empty() ? fmt::format("compliance{}", ++compliances) : joint->name;
        const bool turns = joint->joint.kind == JointKind::revolute;
        list_.push_back({prefix + name + (turns ? ".compliance_rad_per_Nm" : ".compliance_m_per_N"),
                         ParameterKind::compliance, 1, &element});
      } else if (auto* mass = std::get_if<PointMass>(&element)) {
        if (mass->is_of_tool) continue;
        const std::string name = mass->name.empty() ? fmt::format("mass{}", ++masses) : mass->name;
        list_.push_back({prefix + name + ".kg", ParameterKind::mass, 1, &element});
      } else if (auto* spring = std::get_if<Spring>(&element)) {
        const int count = ++springs[spring->name];
        add_spring(element, prefix + spring->name + (count == 1 ? "" : fmt::format("({})", count)));
      } else if (std::holds_alternative<Actuator>(element)) {
        add_motion(element);
      } else if (auto* group = std::get_if<Group>(&element)) {
        for (Branch& branch : group->branches) add(branch.elements, prefix + branch.name + ".");
      }
    }
  }

 private:
  /// "axis X" is X, "chain a" is a, "actuator 3" is J3.
  void add_motion(Element& element) {
    const auto& actuator = std::get<Actuator>(element);
    if (actuator.program_axis > 0) return;
    const std::string& full = actuators_[next_actuator_++];
    const std::string name = (full.starts_with("actuator ") ? "J" : "") + full.substr(full.find(' ') + 1);
    const bool turns = actuator.joint.kind == JointKind::revolute;
    const auto add = [&](const std::string& what, ParameterKind kind, int component) {
      list_.push_back({name + "." + what + (turns ? "_mdeg" : "_um"), kind, turns ? 1e-3 * deg : um, &element,
                       component});
    };
    if (actuator.reversal) add("reversal", ParameterKind::reversal, -1);
    for (std::size_t i = 0; i < actuator.harmonics.size(); ++i)
      add(std::string(harmonic_names[i]), ParameterKind::harmonic, static_cast<int>(i));
    if (!actuator.errors || !actuator.errors->sigma) return;
    const std::vector<double>& positions = actuator.errors->positions;
    for (std::size_t i = 0; i < positions.size(); ++i)
      add(fmt::format("error[{:.9g}]", positions[i] / (turns ? deg : mm)), ParameterKind::table,
          static_cast<int>(i));
  }

  void add_spring(Element& element, const std::string& name) {
    const Matrix6& K = std::get<Spring>(element).K;
    if (!is_diagonal(K)) {
      if (mean_compliance(K) > 0)
        list_.push_back({name + ".compliance_m_per_N", ParameterKind::compliance, 1, &element});
      return;
    }
    for (int i = 0; i < 6; ++i)
      if (K(i, i) > 0)
        list_.push_back({name + "." + std::string(spring_units[static_cast<std::size_t>(i)]),
                         ParameterKind::compliance, 1, &element, i});
  }

  std::vector<ParameterPlace>& list_;
  const std::vector<std::string> actuators_;
  std::size_t next_actuator_ = 0;
};

}  // namespace

std::vector<ParameterPlace> parameter_places(Machine& machine) {
  std::vector<ParameterPlace> list;
  Lister lister(list, actuator_names(machine));
  for (Chain& chain : machine.chains)
    lister.add(chain.elements, machine.chains.size() == 1 ? "" : chain.name + ".");
  std::map<std::string, int> seen;  // branches used twice in one chain
  for (ParameterPlace& place : list)
    if (const int count = ++seen[place.name]; count > 1)
      place.name.insert(place.name.rfind('.', place.name.find('[')), fmt::format("({})", count));
  return list;
}

std::vector<Parameter> parameters(const Machine& machine) {
  Machine copy = machine;
  std::vector<Parameter> list;
  for (const ParameterPlace& place : parameter_places(copy))
    list.push_back({place.name, place.kind, read(place), place.unit});
  return list;
}

std::vector<std::size_t> parameter_indices(const Machine& machine, const std::vector<std::string>& names) {
  const std::vector<Parameter> all = parameters(machine);
  std::vector<std::size_t> indices;
  for (const std::string& name : names)
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].name == name) indices.push_back(i);
  return indices;
}

Machine with_parameters(const Machine& machine, const std::vector<double>& values) {
  Machine result = machine;
  const std::vector<ParameterPlace> list = parameter_places(result);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (read(list[i]) != values[i]) write(list[i], values[i]);
  return result;
}

NumberSources number_sources(const Machine& machine) {
  NumberSources sources;
  std::map<std::string_view, ParameterKind> kinds;
  const std::vector<Parameter> all = parameters(machine);
  for (const Parameter& parameter : all) kinds[parameter.name] = parameter.kind;
  for (const ParameterStatement& stated : machine.parameters) {
    sources.measured += stated.source == NumberSource::measured;
    sources.catalogue += stated.source == NumberSource::catalogue;
    sources.prior += stated.source == NumberSource::prior;
    if (stated.source == NumberSource::measured && kinds[stated.name] == ParameterKind::compliance)
      sources.compliance_measured = true;
  }
  return sources;
}

std::string numbers_phrase(const Machine& machine) {
  const NumberSources sources = number_sources(machine);
  if (sources.total() == 0) return {};
  return fmt::format("{} in [parameters]: {} measured, {} catalogue, {} prior", sources.total(),
                     sources.measured, sources.catalogue, sources.prior);
}

bool is_unmeasured(const Machine& machine) {
  return !machine.parameters.empty() && !number_sources(machine).compliance_measured;
}

std::string unmeasured_phrase(const Machine& machine) {
  return is_unmeasured(machine) ? "UNMEASURED: no stiffness in the machine file is measured" : "";
}

}  // namespace counterflex
