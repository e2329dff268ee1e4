#include "counterflex/compensation/tip_uncertainties.hpp"

#include "compensation/solve/solver.hpp"

namespace counterflex {
namespace {

/// Nothing where the machine does not reach the place.
DatumTangents datum_tangents(const TouchedPlace& touched, const Model& model,
                             const TipUncertainty& uncertainty) {
  const Equilibrium found =
      PlaceSolver(nullptr, false).equilibrium({.model = &model, .target = touched.p_MT});
  if (found.status != Status::converged) return {};
  StaticsWork work = uncertainty.work();
  return uncertainty.of_datum(found.configuration, touched.axes, work);
}

}  // namespace

TipUncertainties tip_uncertainties(const Machine& machine, const Model& model, const ToolModels& tools,
                                   const std::vector<WorkFrame>& frames) {
  TipUncertainties all;
  if (!machine.uncertainty) return all;
  const TipUncertainty& own = all.by_model.emplace(&model, TipUncertainty(machine, model)).first->second;
  for (const auto& [number, with] : tools)
    all.by_model.emplace(&with, TipUncertainty(machine, with, &machine.tools.at(number)));
  for (const WorkFrame& frame : frames)
    all.by_frame.push_back(frame.touched ? datum_tangents(*frame.touched, model, own) : DatumTangents{});
  return all;
}

}  // namespace counterflex
