#include <algorithm>

#include "counterflex/machine/machine.hpp"

namespace counterflex {
namespace {

// No error of a file has such a name.
constexpr const char *growth_name = "[thermal] growth", *shift_name = "[thermal] shift";

bool is_thermal(const Element& element) {
  const auto* error = std::get_if<AssemblyError>(&element);
  return error != nullptr && (error->name == growth_name || error->name == shift_name);
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

Machine at_temperature(const Machine& machine, double temperature) {
  const ThermalShift at = thermal_shift(*machine.thermal, temperature);
  Machine result = machine;
  if (machine.temperature)
    for (Chain& chain : result.chains) std::erase_if(chain.elements, is_thermal);
  result.temperature = temperature;
  // All chains move alike, so that closures do not change.
  const Matrix3& R_PS = machine.X_PS ? machine.X_PS->R : machine.X_PT.R;
  const Vector3 growth_P = R_PS * Vector3(0, 0, -at.growth);
  for (std::size_t i = 0; i < result.chains.size(); ++i) {
    std::vector<Element>& elements = result.chains[i].elements;
    const bool ends_with_mass = i == 0 && machine.ends_with_tool_mass;
    elements.insert(elements.end() - (ends_with_mass ? 1 : 0),
                    AssemblyError{growth_name, translation(growth_P)});
    elements.insert(elements.begin(), AssemblyError{shift_name, translation(at.shift)});
  }
  return result;
}

}  // namespace counterflex
