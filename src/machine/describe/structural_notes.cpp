#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/spectrum.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/machine/shown.hpp"
#include "machine/describe/phrases.hpp"
#include "machine/walk.hpp"

namespace counterflex {
namespace {

using Notes = std::vector<std::string>;

constexpr double large_error_length = 10 * mm;
constexpr double large_error_angle = 5 * deg;

/// Number of directions of a spring without stiffness, computed with a unit diagonal.
int free_directions(const Spring& spring) {
  const Vector6 d = spring.K.diagonal().unaryExpr([](double k) { return k > 0 ? 1 / std::sqrt(k) : 1.0; });
  const Matrix6 scaled = d.asDiagonal() * spring.K * d.asDiagonal();
  return static_cast<int>((eigenvalues(scaled).array() < 1e-9).count());
}

void note_springs(const Machine& machine, Notes& notes) {
  for (const Spring* spring : distinct_springs(machine)) {
    if (const int count = free_directions(*spring); count > 0)
      notes.push_back(fmt::format(
          "spring \"{}\" is only semidefinite: {} without stiffness", spring->name,
          count == 1 ? "1 of its 6 directions is" : fmt::format("{} of its 6 directions are", count)));
    if (!spring->theta_0.isZero(0))
      notes.push_back(
          fmt::format("spring \"{}\" is preloaded: the machine deforms without a force", spring->name));
  }
}

void note_passives(const Machine& machine, Notes& notes) {
  int preloaded = 0, limited = 0;
  for_each<Passive>(machine, [&](const Chain&, const Passive& p) {
    preloaded += p.stiffness > 0 && !p.rest_at_home && p.rest != p.home;
    limited += std::isfinite(p.min) || std::isfinite(p.max);
  });
  if (preloaded > 0)
    notes.push_back(fmt::format(
        "{} with a spring whose rest is not its home value: the machine is loaded without a force",
        counted(preloaded, "passive joint", "passive joints")));
  if (limited > 0)
    notes.push_back(fmt::format("{} with limits: only the travel of actuators is checked",
                                counted(limited, "passive joint", "passive joints")));
}

/// Notes travel beyond the positions of an error table.
void note_error_table(const std::string& who, const Actuator& a, Notes& notes) {
  if (!a.errors) return;
  const double first = a.errors->positions.front(), last = a.errors->positions.back();
  if (a.min < first || a.max > last)
    notes.push_back(fmt::format(
        "{} has a travel of {}, but error table \"{}\" covers {}: beyond it the errors "
        "are those of its ends",
        who, phrase_range(a.joint, a.min, a.max), a.errors->name, phrase_range(a.joint, first, last)));
}

void note_actuators(const Machine& machine, Notes& notes) {
  int number = 0;
  const Eigen::VectorXd homes = shown_homes(machine);
  for_each<Actuator>(machine, [&](const Chain& chain, const Actuator& a) {
    const double home = a.program_axis > 0 ? a.home : homes[number];
    const std::string name =
        a.program_axis > 0 ? fmt::format("axis E{}", a.program_axis) : fmt::format("actuator {}", ++number);
    const std::string who = fmt::format("{} (chain {}, {})", name, chain.name, phrase(a.joint));
    if (!std::isfinite(a.min) || !std::isfinite(a.max))
      notes.push_back(
          fmt::format("{} has {}: leaving its travel is not detected", who,
                      std::isfinite(a.min) || std::isfinite(a.max) ? "one limit only" : "no limits"));
    note_error_table(who, a, notes);
    if (home < a.min || home > a.max)
      notes.push_back(fmt::format("{} starts at {}, outside its travel {}", who, phrase_value(a.joint, home),
                                  phrase_range(a.joint, a.min, a.max)));
  });
  if (number > 0 && machine.controlled.empty())
    notes.push_back("controlled is empty: the machine can be analysed, not compensated");
}

void note_errors(const Machine& machine, Notes& notes) {
  for_each<AssemblyError>(machine, [&](const Chain& chain, const AssemblyError& error) {
    if (error.X.p.norm() > large_error_length || log_so3(error.X.R).norm() > large_error_angle)
      notes.push_back(fmt::format("errors.{} of chain {} is large for an error of assembly: {}", error.name,
                                  chain.name, phrase(error.X)));
  });
}

void note_groups(const Machine& machine, Notes& notes) {
  for_each<Group>(machine, [&](const Chain& chain, const Group& group) {
    if (group.branches.size() == 1)
      notes.push_back(fmt::format(
          "chain {} has a parallel element with one branch, \"{}\": its elements can be in the chain itself",
          chain.name, group.branches.front().name));
  });
}

void note_masses(const Machine& machine, Notes& notes) {
  const double kg = total_mass(machine);
  const bool pulls = !machine.gravity.g.isZero(0);
  const bool left_out = std::ranges::count(machine.already_corrects, Corrected::gravity) > 0;
  if (kg > 0 && !pulls && !left_out)
    notes.push_back(fmt::format("masses of {} but no gravity_m_s2: there is no weight", phrase_mass(kg)));
  if (pulls && kg == 0) notes.push_back("gravity_m_s2 but no masses: there is no weight");
}

/// Whether an element can have a load of this kind.
bool can_have(const Element& element, LoadKind kind) {
  if (kind == LoadKind::group_moment) return std::holds_alternative<Group>(element);
  const auto* passive = std::get_if<Passive>(&element);
  if (kind == LoadKind::passive_change)
    return passive != nullptr && passive->joint.kind == JointKind::revolute;
  const bool turns = kind == LoadKind::spring_rotation || kind == LoadKind::spring_torque;
  const auto* compliance = std::get_if<Compliance>(&element);
  return std::holds_alternative<Spring>(element) ||
         (compliance != nullptr && (compliance->joint.kind == JointKind::revolute) == turns);
}

bool can_have(const Chain& chain, LoadKind kind) {
  bool any = kind == LoadKind::moment;
  for_each_element(chain.elements, [&](const Element& element) { any = any || can_have(element, kind); });
  return any;
}

/// Notes limits of loads that no chain can have: probably another kind of load was meant.
void note_load_limits(const Machine& machine, Notes& notes) {
  for (const LoadKind kind : load_kinds) {
    bool given = false, possible = false;
    for (std::size_t i = 0; i < machine.load_limits.size(); ++i)
      if (machine.load_limits[i][kind]) {
        given = true;
        possible = possible || can_have(machine.chains[i], kind);
      }
    if (given && !possible)
      notes.push_back(fmt::format("{} limits a load that no chain has: it has no effect", name_of(kind).key));
  }
}

bool has_errors(const Machine& machine) {
  bool any = false;
  for_each<AssemblyError>(
      machine, [&](const Chain&, const AssemblyError& error) { any = any || !is_identity(error.X); });
  for_each<Actuator>(machine, [&](const Chain&, const Actuator& a) {
    any = any || a.errors || a.reversal.value_or(0) > 0 || largest_harmonic(a) > 0;
  });
  return any;
}

/// Notes machines without elastic elements, and chains that cannot deflect in every direction.
void note_elasticity(const Machine& machine, Notes& notes) {
  int elastic = 0;
  for (const Chain& chain : machine.chains) elastic += freedoms(chain).elastic;
  if (elastic == 0) {
    notes.push_back(has_errors(machine)
                        ? "no elastic elements: the machine does not deflect under forces"
                        : "no elastic elements and no errors of assembly: there is nothing to compensate");
    return;
  }
  if (!has_errors(machine))
    notes.push_back("no errors of assembly are given: the geometry is assumed perfect");
  for (const Chain& chain : machine.chains) {
    const Freedoms count = freedoms(chain);
    if (count.elastic == 0)
      notes.push_back(fmt::format("chain {} has no elastic elements: it is rigid", chain.name));
    else if (count.elastic + count.passives < 6)
      notes.push_back(fmt::format("chain {} has {} and {}: its end cannot deflect in every direction",
                                  chain.name,
                                  counted(count.elastic, "elastic coordinate", "elastic coordinates"),
                                  counted(count.passives, "passive joint", "passive joints")));
  }
}

}  // namespace

std::vector<std::string> structural_notes(const Machine& machine) {
  Notes notes;
  note_elasticity(machine, notes);
  note_springs(machine, notes);
  note_passives(machine, notes);
  note_groups(machine, notes);
  note_masses(machine, notes);
  note_actuators(machine, notes);
  note_errors(machine, notes);
  note_load_limits(machine, notes);
  return notes;
}

}  // namespace counterflex
