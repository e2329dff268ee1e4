#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/machine/shown.hpp"
#include "machine/describe/describe_elements.hpp"
#include "machine/describe/phrases.hpp"
#include "machine/spindle_axes.hpp"
#include "machine/walk.hpp"

namespace counterflex {
namespace {

constexpr std::string_view component_names[] = {"x", "y", "z", "rx", "ry", "rz"};

std::string controlled_phrase(const Machine& machine) {
  if (machine.controlled.empty()) return "nothing (analysis only)";
  std::string text;
  for (const Component component : machine.controlled)
    text += fmt::format("{}{}", text.empty() ? "" : " ", component_names[static_cast<int>(component)]);
  return text;
}

std::string home_phrase(const Machine& machine) {
  if (!machine.home_X_MP) return "at the platform pose of the joints' home values";
  if (is_identity(*machine.home_X_MP)) return "reference point at the machine's origin";
  return "reference point at " + phrase(*machine.home_X_MP);
}

/// `X_PT` with the axes of the control's tool frame.
Pose in_axes_of_control(const Pose& X_PT, const Machine& machine) {
  return {X_PT.R * tool_axes(machine.spindle_axis).transpose(), X_PT.p};
}

std::string tool_phrase(const Machine& machine) {
  const Pose X_PC = in_axes_of_control(machine.X_PT, machine);
  std::string text =
      is_identity(X_PC) ? "tip at the reference point" : "tip at " + phrase(X_PC) + " from the platform";
  if (machine.spindle_axis != SpindleAxis::z)
    text.append(", spindle in its ")
        .append(spindle_axis_names[static_cast<std::size_t>(machine.spindle_axis)]);
  return text;
}

std::string spindle_phrase(const Pose& X_PS) {
  return is_identity(X_PS) ? "gauge line of tools' lengths at the reference point"
                           : "gauge line of tools' lengths at " + phrase(X_PS) + " from the platform";
}

bool is_length_alone(const Tool& tool) {
  return tool.length && !tool.diameter && !tool.stickout && !tool.flute && tool.yields.empty() && !tool.mass;
}

/// Lists the tools that have only a length.
std::string lengths_phrase(const Machine& machine) {
  std::string text;
  for (const auto& [number, tool] : machine.tools)
    if (is_length_alone(tool))
      text += fmt::format("{}T{} {:.9g} mm", text.empty() ? "" : ", ", number, *tool.length / mm);
  return text.empty() ? text : text + " long";
}

std::string tool_phrase(const Tool& tool) {
  std::string text;
  const auto add = [&](const std::optional<double>& value, std::string_view what) {
    if (value) text += fmt::format("{:.9g} mm {}, ", *value / mm, what);
  };
  add(tool.length, "long");
  add(tool.diameter, "diameter");
  add(tool.stickout, "sticking out");
  add(tool.flute, "of flutes");
  if (tool.mass)
    text += fmt::format("{} at {} from its tip, ", phrase_mass(tool.mass->kg), phrase_mm(tool.mass->at));
  return text + stiffness_phrase(tool);
}

std::string tool_change_phrase(const ControlSettings& control) {
  const bool stays = control.dialect == "linuxcnc" || control.dialect == "grbl";
  if (!control.tool_change_moves)
    return control.dialect == "auto" ? "all axes (linuxcnc, grbl: no axis)" : stays ? "no axis" : "all axes";
  if (control.tool_change_moves->empty()) return "no axis";
  return fmt::format("{}", fmt::join(*control.tool_change_moves, " "));
}

std::string kinematics_phrase(const Machine& machine) {
  return machine.kinematics == ControlKinematics::factory
             ? "computes with calibrated lengths; the errors of assembly are those that it leaves"
             : "computes with catalogue lengths; the errors of assembly are all of the machine";
}

std::string corrects_phrase(const Machine& machine) {
  std::string text;
  for (const Corrected what : machine.already_corrects)
    text.append(text.empty() ? "" : ", ").append(corrected_names[static_cast<std::size_t>(what)]);
  return text + ": by the control itself; they are left out";
}

std::string gravity_phrase(const Machine& machine) {
  const double kg = total_mass(machine);
  if (machine.gravity.g.isZero(0)) return "not given: " + phrase_mass(kg) + " without weight";
  const Vector3 g = machine.gravity.g.array() + 0.0;  // never "-0"
  return fmt::format("{:.9g} {:.9g} {:.9g} m/s2 on {}; the control's zero was set {}", g.x(), g.y(), g.z(),
                     kg > 0 ? phrase_mass(kg) : "no mass",
                     machine.gravity.true_at_home ? "under the weights at home" : "unloaded");
}

std::string fixture_phrase(const Fixture& fixture) {
  std::string text = "the part deflects at " + phrase_mm(fixture.X_MF.p);
  for (int i = 0; i < 3; ++i)
    text +=
        fmt::format("{} {} {:.3g}", i == 0 ? ":" : ",", component_names[i], 1 / fixture.C(i, i) / N_per_um);
  return text + " N/um for a force there, in its axes";
}

std::string thermal_phrase(const ThermalTable& thermal) {
  return fmt::format("shift of the tip from {:.6g} to {:.6g} degrees Celsius, applied with --temperature-C",
                     thermal.temperatures.front(), thermal.temperatures.back());
}

std::string uncertainty_phrase(const Machine& machine) {
  const Uncertainty& of = *machine.uncertainty;
  std::string text =
      fmt::format("{} of {} parameters have a standard deviation; force {:.6g} %",
                  uncertain_parameters(machine).names.size(), parameters(machine).size(), 100 * of.force);
  if (of.tool_length > 0) text += fmt::format(", tool length {:.6g} um", of.tool_length / um);
  if (of.repeatability > 0) text += fmt::format(", repeatability {:.6g} um", of.repeatability / um);
  if (of.temperature > 0) text += fmt::format(", temperature {:.6g} K", of.temperature);
  return text + (of.covariance.empty() ? "" : "; covariance in " + without_controls(of.covariance));
}

std::string limits_phrase(const LoadLimits& limits) {
  std::string text;
  for (const LoadKind kind : load_kinds) {
    const LoadName& name = name_of(kind);
    if (limits[kind])
      text += fmt::format("{}{} {:.9g} {}", text.empty() ? "at most " : ", ", name.words,
                          *limits[kind] / name.si, name.unit);
  }
  return text.empty() ? "none" : text;
}

std::string datum_phrase(const Datum& datum) {
  if (datum.touched_at) return "touched off with this machine at " + phrase_mm(*datum.touched_at);
  return datum.is_machine ? "datum \"machine\"" : "datum not stated";
}

/// One line if all chains have the same limits, else one for each chain.
void describe_limits(const Machine& machine, std::string& text) {
  const std::vector<LoadLimits>& all = machine.load_limits;
  if (all.empty()) return;
  const bool same = std::all_of(all.begin(), all.end(), [&](const LoadLimits& l) { return l == all[0]; });
  for (std::size_t i = 0; i < (same ? 1 : all.size()); ++i)
    text +=
        fmt::format("{:<12} {}\n", same ? "loads" : "loads " + machine.chains[i].name, limits_phrase(all[i]));
}

void describe_settings(const Machine& machine, std::string& text) {
  const auto line = [&](std::string_view label, const std::string& value) {
    text += fmt::format("{:<12} {}\n", label, value);
  };
  line("machine", machine.name.empty() ? "without a name" : machine.name);
  if (!machine.serial.empty()) line("serial", machine.serial);
  if (!machine.date.empty()) line("date", machine.date);
  line("controlled", controlled_phrase(machine));
  line("home", home_phrase(machine));
  line("tool", tool_phrase(machine));
  if (!machine.gravity.g.isZero(0) || total_mass(machine) > 0) line("gravity", gravity_phrase(machine));
  if (machine.X_PS) line("spindle", spindle_phrase(in_axes_of_control(*machine.X_PS, machine)));
  if (const std::string lengths = lengths_phrase(machine); !lengths.empty()) line("tools", lengths);
  for (const auto& [number, tool] : machine.tools)
    if (!is_length_alone(tool)) line(fmt::format("tool T{}", number), tool_phrase(tool));
  line("program", fmt::format("dialect {}, units {}, a tool change moves {}", machine.control.dialect,
                              machine.control.units.empty() ? "not stated" : machine.control.units,
                              tool_change_phrase(machine.control)));
  if (!machine.control.harmless_calls.empty())
    line("calls",
         fmt::format("harmless, as the file states: {}", fmt::join(machine.control.harmless_calls, ", ")));
  if (machine.kinematics != ControlKinematics::unstated) line("controller", kinematics_phrase(machine));
  if (!machine.already_corrects.empty()) line("corrects", corrects_phrase(machine));
  if (machine.joint_values_as_shown)
    line("joints", "joint values of programs are the shown values; stated by the file");
  if (!machine.parameters.empty()) line("numbers", numbers_phrase(machine));
  if (is_unmeasured(machine)) line("stiffness", unmeasured_phrase(machine));
  if (machine.fixture) line("fixture", fixture_phrase(*machine.fixture));
  if (machine.thermal) line("thermal", thermal_phrase(*machine.thermal));
  if (machine.uncertainty) line("uncertainty", uncertainty_phrase(machine));
  line("correction", fmt::format("at most {:.9g} mm", machine.max_correction / mm));
  describe_limits(machine, text);
  if (machine.work_is_machine_frame)
    line("work", "program coordinates are machine coordinates");
  else if (machine.work.empty())
    line("work", "no offsets: programs are in the machine frame");
  for (const auto& [name, offset] : machine.work)
    line("work " + name,
         fmt::format("{}; {}", is_identity(offset.X_MW) ? "the machine frame" : phrase(offset.X_MW),
                     datum_phrase(offset.datum)));
}

void describe_chains(const Machine& machine, std::string& text) {
  ActuatorNumbers numbers{shown_homes(machine)};
  for (const Chain& chain : machine.chains) {
    const Freedoms count = freedoms(chain);
    const double kg = total_mass(chain);
    text += fmt::format("\n{:<12} {}, {}, {}{}\n", "chain " + chain.name,
                        counted(count.actuators, "actuator", "actuators"),
                        counted(count.passives, "passive joint", "passive joints"),
                        counted(count.elastic, "elastic coordinate", "elastic coordinates"),
                        kg > 0 ? ", " + phrase_mass(kg) : "");
    describe_elements(chain.elements, 2, numbers, text);
  }
}

void describe_springs(const Machine& machine, std::string& text) {
  const std::vector<const Spring*> springs = distinct_springs(machine);
  if (springs.empty()) return;
  text += "\nsprings      diagonal of the stiffness, N/m and N m/rad\n";
  for (const Spring* spring : springs) {
    text += fmt::format("  {:<10}", spring->name);
    for (int i = 0; i < 6; ++i) text += fmt::format(" {} {:<11.4g}", component_names[i], spring->K(i, i));
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
    if (spring->theta_0.isZero(0)) continue;
    text += fmt::format("  {:<10} preloaded: at rest at xyz {}, rotation vector {:.6g} {:.6g} {:.6g} deg\n",
                        "", phrase_mm(spring->theta_0.head<3>()), spring->theta_0[3] / deg,
                        spring->theta_0[4] / deg, spring->theta_0[5] / deg);
  }
}

void describe_actuators(const Machine& machine, std::string& text) {
  text += fmt::format("\n{:<12} {}\n", "actuators",
                      actuators(machine).empty() ? "none" : "axis in the frame of its chain there, travel");
  int number = 0;
  for_each<Actuator>(machine, [&](const Chain& chain, const Actuator& a) {
    const std::string name =
        a.program_axis > 0 ? fmt::format("E{}", a.program_axis) : fmt::format("{}", ++number);
    text += fmt::format("  {:>2}  {:<7} {:<24} {}", name, chain.name, phrase(a.joint),
                        phrase_range(a.joint, a.min, a.max));
    for (const std::string& more : {phrase_shown(a), phrase_errors(a)})
      if (!more.empty()) text += ", " + more;
    text += "\n";
  });
}

void describe_errors(const Machine& machine, std::string& text) {
  std::string lines;
  for_each<AssemblyError>(machine, [&](const Chain& chain, const AssemblyError& error) {
    if (!is_identity(error.X))
      lines += fmt::format("  {:<10} {:<10} {}\n", chain.name, error.name, phrase(error.X));
  });
  text += fmt::format("\n{:<12}{}\n{}", "errors of assembly", lines.empty() ? ": none" : "", lines);
}

}  // namespace

Freedoms freedoms(const Chain& chain) {
  Freedoms count;
  for_each_element(chain.elements, [&](const Element& element) {
    const auto* actuator = std::get_if<Actuator>(&element);
    count.actuators += actuator != nullptr && actuator->program_axis == 0;
    count.passives += std::holds_alternative<Passive>(element);
    count.elastic +=
        std::holds_alternative<Spring>(element) ? 6 : std::holds_alternative<Compliance>(element);
  });
  return count;
}

std::vector<const Spring*> distinct_springs(const Machine& machine) {
  std::vector<const Spring*> springs;
  for_each<Spring>(machine, [&](const Chain&, const Spring& spring) {
    const auto same = [&](const Spring* other) { return other->name == spring.name; };
    if (std::none_of(springs.begin(), springs.end(), same)) springs.push_back(&spring);
  });
  return springs;
}

std::string describe(const Machine& machine) {
  std::string text;
  describe_settings(machine, text);
  describe_chains(machine, text);
  describe_springs(machine, text);
  describe_actuators(machine, text);
  describe_errors(machine, text);
  return text;
}

}  // namespace counterflex
