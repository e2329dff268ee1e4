#include "run/program_axes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/program_axes.hpp"

namespace counterflex::cli {
namespace {

using ExternalAxes = std::array<std::optional<ExternalAxis>, 6>;

double unit_of(const Actuator& axis) {
  return axis.joint.kind == JointKind::prismatic ? mm : deg;
}

Travel travel_of(const Actuator& axis) {
  return {axis.min, axis.max, axis.joint.kind, fmt::format("external axis E{}", axis.program_axis)};
}

const std::optional<ExternalAxis>& value_of(const Actuator& axis, const ExternalAxes& values) {
  return values.at(static_cast<std::size_t>(axis.program_axis - 1));
}

void refuse_outside_travel(const Actuator& axis, const Overview& program) {
  const auto& given = value_of(axis, program.external_axes);
  if (!given) return;
  const double value = given->value * unit_of(axis);
  if (value >= axis.min && value <= axis.max) return;
  throw InputError(
      ErrorKind::limit, {program.file, given->line, 1},
      fmt::format("{}; change the program, or {} of the machine file",
                  outside_travel_words(travel_of(axis), value),
                  axis.joint.kind == JointKind::prismatic ? "min_mm and max_mm" : "min_deg and max_deg"));
}

void refuse_unknown(const Actuator& axis, const Overview& program) {
  const auto& given = value_of(axis, program.external_axes);
  if (!given || given->unknown_in == 0) return;
  throw InputError(
      ErrorKind::program_text, {program.file, given->unknown_in, 1},
      fmt::format("external axis E{0} is not known at this target: line {1} gives {2:.6g}, {3}; give E{0} in "
                  "this target",
                  axis.program_axis, given->line, given->value,
                  given->unknown_in < given->line ? "which is behind it"
                                                  : "and a statement in between may have moved it"));
}

std::string home_words(const Actuator& axis) {
  return fmt::format("the program does not give external axis E{}: {} = {:.6g} of the machine file is used",
                     axis.program_axis, axis.joint.kind == JointKind::prismatic ? "home_mm" : "home_deg",
                     axis.home / unit_of(axis));
}

/// Warns of axes that the machine does not have. At zero they may be unused.
void warn_of_unknown(const std::vector<Actuator>& axes, const ExternalAxes& values,
                     std::vector<Remark>& warnings) {
  for (int i = 1; i <= 6; ++i) {
    const auto& given = values.at(static_cast<std::size_t>(i - 1));
    const bool known =
        std::any_of(axes.begin(), axes.end(), [i](const Actuator& axis) { return axis.program_axis == i; });
    if (!given || given->value == 0 || known) continue;
    warnings.push_back(
        {given->line,
         fmt::format(
             "external axis E{0} is at {1:.9g}, but no actuator of the machine file has program_axis = "
             "\"E{0}\": the file must describe the machine with this axis at {1:.9g}",
             i, given->value)});
  }
}

}  // namespace

std::vector<Remark> place_program_axes(const Overview& program, MachineInput& input) {
  if (const auto& moved = program.external_axes_move)
    throw InputError(ErrorKind::program_text, {program.file, moved->line, 1}, moved->what);
  const std::vector<Actuator> axes = program_axes(input.machine);
  std::vector<Remark> warnings;
  warn_of_unknown(axes, program.external_axes, warnings);
  if (axes.empty()) return warnings;
  ProgramAxisValues values;
  for (const Actuator& axis : axes) {
    refuse_outside_travel(axis, program);
    refuse_unknown(axis, program);
    const auto& given = value_of(axis, program.external_axes);
    if (given)
      values.at(static_cast<std::size_t>(axis.program_axis - 1)) = given->value;
    else
      warnings.push_back({0, home_words(axis)});
  }
  input.machine = at_program_axes(input.machine, values);
  input.model = prepare(input.machine);
  refuse_home(input.model, input.machine);
  return warnings;
}

SanityChecks check_program_axes(const Overview& program, const Machine& machine) {
  std::string given, missing;
  for (const Actuator& axis : program_axes(machine)) {
    const Travel travel = travel_of(axis);
    if (const auto& value = value_of(axis, program.external_axes))
      given += fmt::format("{}E{} at {}, line {}", given.empty() ? "" : "; ", axis.program_axis,
                           axis_value(travel, axis.home), value->line);
    else
      missing += (missing.empty() ? "" : "; ") + home_words(axis);
  }
  if (given.empty() && missing.empty()) return {};
  const SanityState state = missing.empty() ? SanityState::ok : SanityState::doubtful;
  return {{"external axes", state, missing.empty() ? given : missing}};
}

}  // namespace counterflex::cli
