#include "identify/prior.hpp"

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameters.hpp"

namespace counterflex {
namespace {

// Standard deviations of parameters for which a machine file states none.
constexpr double default_position = 1 * mm, default_orientation = 0.1 * deg, default_share = 1;  // of a value
constexpr double default_reversal = 20 * um, default_reversal_angle = 0.01 * deg;
constexpr double default_harmonic = 0.02 * deg;  // strain wave gears: about 1 arcmin

}  // namespace

PriorDeviation prior_deviation(const Machine& machine, const Parameter& parameter) {
  if (const auto stated = stated_deviation(machine, parameter)) return {*stated, false};
  // Of a value of zero the deviation has to be absolute.
  if (parameter.kind == ParameterKind::position) return {default_position, true};
  if (parameter.kind == ParameterKind::orientation) return {default_orientation, true};
  if (parameter.kind == ParameterKind::reversal)
    return {parameter.unit == um ? default_reversal : default_reversal_angle, true};
  if (parameter.kind == ParameterKind::table) return {0, false};
  if (parameter.kind == ParameterKind::harmonic) return {default_harmonic, true};
  return {default_share * parameter.value, true};
}

}  // namespace counterflex
