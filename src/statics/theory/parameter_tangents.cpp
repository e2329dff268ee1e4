#include "counterflex/statics/parameter_tangents.hpp"

#include <algorithm>
#include <map>

#include "counterflex/machine/parameter_places.hpp"
#include "statics/model/home.hpp"
#include "statics/model/motion_errors.hpp"
#include "statics/model/part.hpp"
#include "statics/model/tip.hpp"
#include "statics/model/walk.hpp"
#include "statics/theory/manipulator.hpp"

namespace counterflex {

/// Where an element is in the whole system.
struct PartPlace {
  int variable = 0;
  const Part* part = nullptr;
};

/// One varied parameter.
struct VariedParameter {
  ParameterKind kind;
  double value = 0;   ///< SI
  int component = 0;  ///< of an error or a diagonal spring; -1: one parameter scales the whole spring
  PartPlace at{};
  Model heavier{};            ///< of a mass: with 1 kg more
  MotionErrors unit_error{};  ///< of harmonics and tables
};

namespace {

/// Fills the places of all elements of a branch, in the order in which the whole system counts its variables.
void place_parts(const Branch& branch, const Series& series, bool weighs, int& variable,
                 std::map<const Element*, PartPlace>& places) {
  const int first = variable;
  variable += series.columns;
  std::size_t next = 0;
  for (const Element& element : branch.elements) {
    if (!weighs && std::holds_alternative<PointMass>(element)) continue;
    const Part& part = series.parts[next++];
    places[&element] = {first + part.column, &part};
    if (const auto* group = std::get_if<Group>(&element))
      for (std::size_t b = 0; b < group->branches.size(); ++b)
        place_parts(group->branches[b], series.groups[part.group].branches[b], weighs, variable, places);
  }
}

/// The state of a series whose varied errors are coordinates.
SeriesState with_error_coordinates(const Series& plain, const Series& series, const SeriesState& state) {
  SeriesState result{
      Eigen::VectorXd::Zero(series.columns), Eigen::VectorXd::Zero(series.columns), state.F, {}};
  for (std::size_t i = 0; i < series.parts.size(); ++i) {
    const Part &from = plain.parts[i], &to = series.parts[i];
    if (to.column < 0) continue;
    if (from.kind == PartKind::error) {  // a spring here: transform [Exp(phi), p], as that of an error
      result.x.segment<6>(to.column) << from.X.p, from.log_R;
    } else {
      const int count = columns_of(to);
      result.x.segment(to.column, count) = state.x.segment(from.column, count);
      result.x_nominal.segment(to.column, count) = state.x_nominal.segment(from.column, count);
    }
  }
  for (std::size_t g = 0; g < series.groups.size(); ++g) {
    GroupState group{state.groups[g].X, {}};
    for (std::size_t b = 0; b < series.groups[g].branches.size(); ++b)
      group.branches.push_back(with_error_coordinates(
          plain.groups[g].branches[b], series.groups[g].branches[b], state.groups[g].branches[b]));
    result.groups.push_back(std::move(group));
  }
  return result;
}

/// d gradient / d parameter (SI) of a compliance: its forces fall with 1 / c. That of a joint with a knee is
/// F(x / c) with the knee's load held, so that dF/dc = -x dF/dx / c.
void add_force_change(const VariedParameter& varied, const WholeSystem& system, const Units& units,
                      const Eigen::VectorXd& deflection, Eigen::Ref<Eigen::VectorXd> column) {
  const bool is_spring = varied.at.part->kind == PartKind::spring;
  const int count = is_spring && varied.component < 0 ? 6 : 1, first = std::max(varied.component, 0);
  for (int i = first; i < first + count; ++i) {
    const int row = varied.at.variable + i;
    const double force = is_spring ? varied.at.part->K.row(i).dot(deflection)
                                   : force_of_joint(*varied.at.part, deflection[0]).stiffness * deflection[0];
    column[row] -= units.of_column(system.variables[row].angular) / units.energy() * force / varied.value;
  }
}

/// Of an actuator whose only error is one unit of a parameter. Errors are linear in harmonics, and in the
/// values of tables that have deviations.
MotionErrors unit_error(const ParameterPlace& place) {
  Actuator actuator = std::get<Actuator>(*place.element);
  const auto i = static_cast<std::size_t>(place.component);
  if (place.kind == ParameterKind::harmonic) {
    std::fill(actuator.harmonics.begin(), actuator.harmonics.end(), 0);
    actuator.harmonics[i] = 1;
  } else {
    for (Vector6& error : actuator.errors->errors) error.setZero();
    actuator.errors->errors[i].segment<3>(actuator.joint.kind == JointKind::prismatic ? 0 : 3) =
        actuator.joint.axis;
  }
  return motion_errors(actuator);
}

/// How far an actuator at a value moves in all while its command moves by one.
double motion_by_command(const Part& actuator, double value) {
  return actuator.errors.empty() ? 1 : 1 + error_along(actuator.joint, actuator.errors, value).slope;
}

/// Deflections of all springs and compliances, by first variable of the part.
std::map<int, Eigen::VectorXd> deflections_of(const Mechanism& mechanism, const Configuration& configuration,
                                              const Stage& stage) {
  std::map<int, Eigen::VectorXd> deflections;
  int first = 0;
  for_each_series(mechanism.chains, configuration.chains,
                  [&](const Series& series, const SeriesState& state) {
                    for (const Part& part : series.parts) {
                      if (part.kind == PartKind::spring)
                        deflections[first + part.column] = spring_deflection(part, state, stage);
                      if (part.kind == PartKind::compliance)
                        deflections[first + part.column] =
                            Eigen::VectorXd::Constant(1, joint_deflection(part, state, stage));
                    }
                    first += series.columns;
                  });
  return deflections;
}

/// A varied machine, with the length and the zeros of the machine itself. It has no home.
Model varied_model(const Machine& varied, const Mechanism& itself) {
  Model model;
  model.mechanism = compile(varied);
  model.mechanism.length = itself.length;
  set_zero_offsets(zero_offsets(itself), model.mechanism);
  return model;
}

/// How the offsets of a zero that was set under weight change with a parameter; central difference.
Eigen::VectorXd offset_tangent(const Machine& machine, std::size_t index) {
  std::vector<double> values;
  for (const Parameter& parameter : parameters(machine)) values.push_back(parameter.value);
  const double value = values[index], step = 1e-4 * value;
  const auto offsets = [&](double moved) {
    values[index] = moved;
    return zero_offsets(prepare(with_parameters(machine, values)).mechanism);
  };
  return (offsets(value + step) - offsets(value - step)) / (2 * step);
}

/// Where the parameters of a machine are in it with a tool, if there is one. They have the same order there,
/// before those of the tool. A mass of [tool] in whose place the tool has its own is without an element.
std::vector<ParameterPlace> places_with(const Tool* tool, Machine machine, Machine& with) {
  const bool has_own_mass = tool != nullptr && tool->mass && machine.ends_with_tool_mass;
  const Element* const replaced = has_own_mass ? &machine.chains.front().elements.back() : nullptr;
  const std::vector<ParameterPlace> there = parameter_places(with);
  std::vector<ParameterPlace> places = parameter_places(machine);
  std::size_t next = 0;
  for (ParameterPlace& place : places)
    if (place.element == replaced)
      place.element = nullptr;
    else
      place.element = there[next++].element;
  return places;
}

}  // namespace

struct ParameterTangents::Impl {
  Mechanism plain;  ///< of the machine itself
  Machine machine;  ///< varied errors are springs without stiffness: their coordinates are the parameters
  Model model;      ///< of that machine
  std::vector<VariedParameter> varied;
  std::vector<PartPlace> actuators;
  Eigen::MatrixXd offsets;  ///< actuators x varied: tangents of zeros that were set under weight
  bool and_load = false;

  Configuration configuration(const Configuration& found) const {
    Configuration result{found.X_MP, {}};
    for (std::size_t i = 0; i < found.chains.size(); ++i)
      result.chains.push_back(
          with_error_coordinates(plain.chains[i], model.mechanism.chains[i], found.chains[i]));
    return result;
  }
};

ParameterTangents::ParameterTangents(const Machine& machine, const Model& model,
                                     const std::vector<std::size_t>& varied, bool and_load, const Tool* tool)
    : impl_(std::make_unique<Impl>(Impl{model.mechanism,
                                        tool != nullptr ? with_tool(machine, *tool) : machine,
                                        {},
                                        {},
                                        {},
                                        {},
                                        and_load})) {
  const std::vector<Parameter> values = parameters(machine);
  const std::vector<ParameterPlace> all = places_with(tool, machine, impl_->machine);
  for (const std::size_t index : varied)
    if (auto* error = std::get_if<AssemblyError>(all[index].element))
      *all[index].element = Spring{error->name};
  impl_->model = varied_model(impl_->machine, model.mechanism);
  const Mechanism& mechanism = impl_->model.mechanism;
  int variable = 0;
  std::map<const Element*, PartPlace> places;
  for (std::size_t i = 0; i < impl_->machine.chains.size(); ++i)
    place_parts(impl_->machine.chains[i], mechanism.chains[i], !mechanism.gravity.isZero(0), variable,
                places);
  impl_->actuators.resize(mechanism.travel.size());
  for (const auto& [element, place] : places)
    if (place.part->actuator >= 0) impl_->actuators[static_cast<std::size_t>(place.part->actuator)] = place;
  impl_->offsets.setZero(static_cast<Eigen::Index>(mechanism.travel.size()),
                         static_cast<Eigen::Index>(varied.size()));
  for (const std::size_t index : varied) {
    const ParameterPlace& place = all[index];
    VariedParameter entry{place.kind, values[index].value, place.component};
    if (const auto found = places.find(place.element); found != places.end()) entry.at = found->second;
    if (place.element == nullptr) {
      entry.heavier = impl_->model;  // it does not act
    } else if (place.kind == ParameterKind::mass) {
      std::get<PointMass>(*place.element).kg += 1;
      entry.heavier = varied_model(impl_->machine, model.mechanism);
      std::get<PointMass>(*place.element).kg -= 1;
    }
    const bool holds_zero = place.kind == ParameterKind::compliance || place.kind == ParameterKind::mass;
    if (machine.gravity.true_at_home && holds_zero)
      impl_->offsets.col(static_cast<Eigen::Index>(impl_->varied.size())) = offset_tangent(machine, index);
    if (place.kind == ParameterKind::table || place.kind == ParameterKind::harmonic)
      entry.unit_error = unit_error(place);
    impl_->varied.push_back(std::move(entry));
  }
}

ParameterTangents::~ParameterTangents() = default;
ParameterTangents::ParameterTangents(ParameterTangents&&) noexcept = default;

StaticsWork ParameterTangents::work() const {
  return StaticsWork(impl_->model.mechanism);
}

Eigen::Matrix<double, 6, Eigen::Dynamic> ParameterTangents::of_tip(const Configuration& found,
                                                                   const Load& load,
                                                                   StaticsWork& work) const {
  const Impl& impl = *impl_;
  const Stage stage{};
  const Units units{impl.model.mechanism.length};
  const Configuration configuration = impl.configuration(found);
  const Problem problem{load, stage, nullptr};
  const auto system_of = [&](const Model& model) {
    evaluate_all(model, configuration, stage, work.impl());
    return whole_system(model, configuration, problem, work.impl());
  };
  const WholeSystem system = system_of(impl.model);
  const auto deflections = deflections_of(impl.model.mechanism, configuration, stage);
  const Eigen::VectorXd values = actuator_values(impl.plain, found);
  HeldSteps steps;
  steps.is_held.assign(system.variables.size(), false);
  const auto n = static_cast<Eigen::Index>(impl.varied.size());
  const Eigen::Index columns = n + (impl.and_load ? 1 : 0);
  steps.held.setZero(static_cast<Eigen::Index>(system.variables.size()), columns);
  steps.gradient.setZero(static_cast<Eigen::Index>(system.variables.size()), columns);
  for (Eigen::Index k = 0; k < n; ++k) {
    const VariedParameter& varied = impl.varied[static_cast<std::size_t>(k)];
    const int first = varied.at.variable;
    if (varied.kind == ParameterKind::mass)
      steps.gradient.col(k) = system_of(varied.heavier).gradient - system.gradient;
    else if (varied.kind == ParameterKind::compliance)
      add_force_change(varied, system, units, deflections.at(first), steps.gradient.col(k));
    else if (varied.kind == ParameterKind::reversal)
      steps.held(first, k) = -0.5;
    else if (!varied.unit_error.empty()) {
      const double value = values[varied.at.part->actuator];
      steps.held(first, k) = error_along(varied.at.part->joint, varied.unit_error, value).error /
                             motion_by_command(*varied.at.part, value);
    } else
      steps.held(first + varied.component, k) = 1;
    // Offsets do not move the place in a table.
    for (std::size_t a = 0; a < impl.actuators.size(); ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      steps.held(impl.actuators[a].variable, k) +=
          impl.offsets(i, k) / motion_by_command(*impl.actuators[a].part, values[i]);
    }
    if (varied.kind == ParameterKind::position || varied.kind == ParameterKind::orientation)
      for (int i = 0; i < 6; ++i) steps.is_held[static_cast<std::size_t>(first + i)] = true;
  }
  if (impl.and_load)  // the gradient is linear in it
    steps.gradient.col(n).tail<6>() =
        -applied_wrench(impl.model.mechanism, configuration.X_MP, load, stage.load)
             .F.cwiseProduct(units.of_pose()) /
        units.energy();
  const Eigen::MatrixXd moved = solve_held(system, steps, units);
  return tip_from_platform(impl.model.mechanism, configuration.X_MP) * moved.bottomRows<6>();
}

}  // namespace counterflex
