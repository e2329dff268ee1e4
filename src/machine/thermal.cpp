#include <algorithm>

#include "counterflex/machine/machine.hpp"

namespace counterflex {
namespace {

/// All chains move alike, so that closures do not change: the shift is their first element, the growth the
/// last, but for the mass of a tool.
std::ptrdiff_t after_growth(const Machine& machine, std::size_t chain) {
  return chain == 0 && machine.ends_with_tool_mass ? 1 : 0;
}

}  // namespace

ThermalShift thermal_shift(const ThermalTable& table, double temperature) {
  const auto above = std::upper_bound(table.temperatures.begin(), table.temperatures.end(), temperature);
  const std::size_t last = table.temperatures.size() - 1;
  const std::size_t i = std::min(static_cast<std::size_t>(above - table.temperatures.begin()), last);
  const double t0 = table.temperatures[i - 1], t1 = table.temperatures[i], s = (temperature - t0) / (t1 - t0);
  return {(1 - s) * table.shift[i - 1] + s * table.shift[i],
          (1 - s) * table.growth[i - 1] + s * table.growth[i]};
}

Machine without_temperature(const Machine& machine) {
  Machine result = machine;
  if (!machine.temperature) return result;
  result.temperature.reset();
  for (std::size_t i = 0; i < result.chains.size(); ++i) {
    std::vector<Element>& elements = result.chains[i].elements;
    elements.erase(elements.end() - after_growth(machine, i) - 1);
    elements.erase(elements.begin());
  }
  return result;
}

Machine at_temperature(const Machine& machine, double temperature) {
  const ThermalShift at = thermal_shift(*machine.thermal, temperature);
  Machine result = without_temperature(machine);
  result.temperature = temperature;
  const Matrix3& R_PS = machine.X_PS ? machine.X_PS->R : machine.X_PT.R;
  const AssemblyError growth{"spindle_growth", translation(R_PS * Vector3(0, 0, -at.growth))},
      shift{"thermal_shift", translation(at.shift)};
  for (std::size_t i = 0; i < result.chains.size(); ++i) {
    std::vector<Element>& elements = result.chains[i].elements;
    elements.insert(elements.end() - after_growth(machine, i), growth);
    elements.insert(elements.begin(), shift);
  }
  return result;
}

}  // namespace counterflex
