#include "identify/prior.hpp"

#include <algorithm>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameter_places.hpp"

namespace counterflex {
namespace {

// Standard deviations of parameters for which a machine file states none.
constexpr double default_position = 1 * mm, default_orientation = 0.1 * deg, default_share = 1;  // of a value
constexpr double default_reversal = 20 * um, default_reversal_angle = 0.01 * deg;
constexpr double default_harmonic = 0.02 * deg;  // strain wave gears: about 1 arcmin

/// Of a value of an error table; the table states it.
double table_sigma(Machine machine, const std::string& name) {
  for (const ParameterPlace& place : parameter_places(machine))
    if (place.name == name) return std::get<Actuator>(*place.element).errors->sigma.value_or(0);
  return 0;
}

}  // namespace

PriorDeviation prior_deviation(const Machine& machine, const Parameter& parameter) {
  const auto stated = std::find_if(machine.parameters.begin(), machine.parameters.end(),
                                   [&](const ParameterStatement& s) { return s.name == parameter.name; });
  if (stated != machine.parameters.end() && stated->sigma) return {*stated->sigma, false};
  // Of a value of zero the deviation has to be absolute.
  if (parameter.kind == ParameterKind::position) return {default_position, true};
  if (parameter.kind == ParameterKind::orientation) return {default_orientation, true};
  if (parameter.kind == ParameterKind::reversal)
    return {parameter.unit == um ? default_reversal : default_reversal_angle, true};
  if (parameter.kind == ParameterKind::table) return {table_sigma(machine, parameter.name), false};
  if (parameter.kind == ParameterKind::harmonic) return {default_harmonic, true};
  return {default_share * parameter.value, true};
}

}  // namespace counterflex
