#include "identify/fit/responses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/parallel.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/shown.hpp"
#include "identify/fit/clamped.hpp"

namespace counterflex {
namespace {

constexpr std::size_t slice = 32;  // states for one thread at a time

std::string shown_words(const Model& model, const Eigen::VectorXd& shown) {
  std::string text;
  for (Eigen::Index i = 0; i < shown.size(); ++i) {
    const bool turns = model.mechanism.travel[static_cast<std::size_t>(i)].kind == JointKind::revolute;
    text += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", shown[i] / (turns ? deg : mm));
  }
  return text;
}

/// The sign of the tangent by each varied parameter: of a reversal that of its actuator's direction.
class Signs {
 public:
  Signs(const Machine& machine, const std::vector<std::size_t>& varied) {
    std::vector<std::size_t> reversing;
    const std::vector<Actuator> all = actuators(machine);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].reversal) reversing.push_back(i);
    std::size_t next = 0;
    const std::vector<Parameter> listed = parameters(machine);
    std::vector<std::size_t> actuator_of(listed.size());
    for (std::size_t k = 0; k < listed.size(); ++k)
      if (listed[k].kind == ParameterKind::reversal) actuator_of[k] = reversing[next++];
    for (std::size_t k = 0; k < varied.size(); ++k) {
      if (listed[varied[k]].kind == ParameterKind::reversal)
        reversals_.emplace_back(k, actuator_of[varied[k]]);
      is_compliance_.push_back(listed[varied[k]].kind == ParameterKind::compliance);
    }
  }

  void apply(const Directions& directions, Eigen::Matrix<double, 6, Eigen::Dynamic>& tangents) const {
    for (const auto& [column, actuator] : reversals_)
      tangents.col(static_cast<Eigen::Index>(column)) *= directions.of(actuator);
  }

  const std::vector<bool>& is_compliance() const { return is_compliance_; }

 private:
  std::vector<std::pair<std::size_t, std::size_t>> reversals_;  ///< column, actuator
  std::vector<bool> is_compliance_;
};

}  // namespace

std::map<long, Model> models_of(const Machine& machine, const States& states) {
  std::map<long, Model> models;
  const Model base = prepare(machine);
  for (const CommandedState* state : states.state) {
    if (models.contains(state->tool)) continue;
    const bool is_base = state->tool == 0;
    models.emplace(state->tool,
                   is_base ? base : prepare_with_tool(machine, base, machine.tools.at(state->tool)));
  }
  return models;
}

States nominal_states(const Machine& machine, const Measurements& measurements, int threads) {
  States states;
  std::vector<const Measurement*> row_of;
  for (const Measurement& row : measurements.rows) {
    states.first.push_back(states.state.size());
    for (const CommandedState& state : row.states) {
      states.state.push_back(&state);
      row_of.push_back(&row);
    }
  }
  const std::map<long, Model> models = models_of(machine, states);
  states.nominal.resize(states.state.size());
  states.X_MT.resize(states.state.size());
  std::vector<Status> found(states.state.size());
  for_each_index((states.state.size() + slice - 1) / slice, threads, [&](std::size_t s) {
    for (std::size_t i = s * slice; i < std::min((s + 1) * slice, states.state.size()); ++i) {
      const Model& model = models.at(states.state[i]->tool);
      const NominalResult nominal =
          nominal_forward(model, model.home, joint_values(model.mechanism.shown, states.state[i]->shown));
      found[i] = nominal.status;
      states.nominal[i] = nominal.configuration;
      states.X_MT[i] = tip(model.mechanism, nominal.configuration);
    }
  });
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] != Status::converged)
      throw InputError(ErrorKind::machine_or_force, row_of[i]->at,
                       fmt::format("the machine cannot be at the actuator values {} (mm, deg)",
                                   shown_words(models.at(states.state[i]->tool), states.state[i]->shown)));
  return states;
}

std::vector<Response> responses(const Machine& machine, const std::vector<std::size_t>& varied,
                                const States& states, int threads, std::vector<Configuration>& loaded) {
  const std::map<long, Model> models = models_of(machine, states);
  std::map<long, ParameterTangents> all_tangents;
  for (const auto& [number, model] : models) {
    const Tool* tool = number != 0 ? &machine.tools.at(number) : nullptr;
    all_tangents.emplace(number, ParameterTangents(machine, model, varied, false, tool));
  }
  const Signs signs(machine, varied);
  std::vector<Response> found(states.state.size());
  const bool has_starts = !loaded.empty();
  loaded.resize(states.state.size());
  for_each_index((found.size() + slice - 1) / slice, threads, [&](std::size_t s) {
    std::map<long, std::pair<StaticsWork, StaticsWork>> works;  // of equilibria and of tangents
    for (std::size_t i = s * slice; i < std::min((s + 1) * slice, found.size()); ++i) {
      const CommandedState& state = *states.state[i];
      const Model& model = models.at(state.tool);
      const ParameterTangents& tangents = all_tangents.at(state.tool);
      auto& [work, tangent_work] =
          works.try_emplace(state.tool, StaticsWork(model.mechanism), tangents.work()).first->second;
      const Load load{state.F, false};
      // Joints lag behind the commanded values.
      Eigen::VectorXd joints = actuator_values(model.mechanism, states.nominal[i]);
      if (has_reversals(model)) joints += lag_of(model.mechanism, state.directions);
      Equilibrium equilibrium;
      if (has_starts) {
        set_actuator_values(model.mechanism, joints, loaded[i]);
        equilibrium = refine_forward(model, loaded[i], load, Stage{}, work);
      }
      if (equilibrium.status != Status::converged) {
        const NominalResult lagging = nominal_forward(model, states.nominal[i], joints);
        equilibrium = solve_forward(model, lagging.configuration, load, Stage{}, work);
      }
      found[i].status = equilibrium.status;
      loaded[i] = equilibrium.status == Status::converged ? equilibrium.configuration : states.nominal[i];
      if (equilibrium.status != Status::converged) continue;
      found[i].X_MT = tip(model.mechanism, equilibrium.configuration);
      found[i].tangents = tangents.of_tip(equilibrium.configuration, load, tangent_work);
      signs.apply(state.directions, found[i].tangents);
      if (state.clamped)
        fill_clamped(model, equilibrium.configuration, *state.clamped, {tangents, signs.is_compliance()},
                     work, tangent_work, found[i]);
    }
  });
  return found;
}

}  // namespace counterflex
