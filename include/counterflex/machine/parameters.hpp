#pragma once
/// The parameters of a machine: the numbers that measurements can identify, each with a name. They are the
/// components of assembly errors, compliances, masses, and of actuators the reversals, the harmonics, and the
/// positioning errors of tables whose deviation is stated.
///
/// Names. In a machine of one chain "mount.x_mm", else "CHAIN.mount.x_mm"; inside a branch of a group the
/// branch's name is in front, too. "mount" is an error slot (x_mm, y_mm, z_mm, rx_deg, ry_deg, rz_deg: the
/// rotation vector), a spring, or the `name` of a compliance or mass; without one "compliance2", "mass1",
/// counted from 1 in the chain or branch. A spring with a diagonal stiffness has "foot.x_m_per_N" to
/// "foot.rz_rad_per_Nm" for its finite compliances; another has one, "foot.compliance_m_per_N": the mean of
/// the first three on the diagonal, which scales the whole matrix. A reversal is "X.reversal_um",
/// "A1.reversal_mdeg" or "CHAIN.reversal_um": the axis or the chain as `actuator_names` has it; without such
/// a name "J3.reversal_um". Harmonics are "A1.sin_mdeg", "A1.cos_mdeg", "A1.sin2_mdeg", "A1.cos2_mdeg"; the
/// error at the position 100 mm or deg of a table is "X.error[100]_um" or "C.error[100]_mdeg".
#include <optional>
#include <string>
#include <vector>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

enum class ParameterKind { position, orientation, compliance, mass, reversal, table, harmonic };

struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::position;
  double value = 0;  ///< SI: m, rad, m/N, rad/(N m), kg
  double unit = 1;   ///< of the name's unit, in SI
};

/// In the order of chains and elements. Names are unique.
std::vector<Parameter> parameters(const Machine& machine);

/// Where parameters of these names are in `parameters`. Unknown names are left out.
std::vector<std::size_t> parameter_indices(const Machine& machine, const std::vector<std::string>& names);

/// The machine with these values (SI) of all its parameters, in the order of `parameters`. Compliances and
/// masses must be positive. Elements whose values are the same keep their bits.
Machine with_parameters(const Machine& machine, const std::vector<double>& values);

/// The standard deviation (SI) that the machine states of a parameter, in [parameters] or in its table.
std::optional<double> stated_deviation(const Machine& machine, const Parameter& parameter);

/// The parameters whose deviations are known: those of `machine.uncertainty->known` with their covariance,
/// then all others of which the machine states one. Reversals are left out.
KnownParameters uncertain_parameters(const Machine& machine);

/// How many numbers of a machine file have which source.
struct NumberSources {
  int measured = 0, catalogue = 0, prior = 0;
  bool compliance_measured = false;  ///< at least one compliance is measured

  int total() const { return measured + catalogue + prior; }
};
NumberSources number_sources(const Machine& machine);

/// "23 in [parameters]: 9 measured, 12 catalogue, 2 prior"; empty for a machine without [parameters].
std::string numbers_phrase(const Machine& machine);

/// "UNMEASURED: ...", for checks and reports; empty unless `is_unmeasured`.
std::string unmeasured_phrase(const Machine& machine);

/// Whether the file states the sources of its numbers, and no compliance among them is measured.
bool is_unmeasured(const Machine& machine);

}  // namespace counterflex
