#pragma once
/// The uncertainties that a run's waypoints need.
#include <map>
#include <vector>

#include "counterflex/statics/nominal.hpp"
#include "counterflex/statics/tip_uncertainty.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

/// Of a machine without an uncertainty: empty.
struct TipUncertainties {
  std::map<const Model*, TipUncertainty>
      by_model;  ///< of the machine and of its tools; the models outlive it
  std::vector<DatumTangents> by_frame;

  bool empty() const { return by_model.empty(); }
};

/// `model`: of the machine without a tool, with which the parts of `frames` were touched off.
TipUncertainties tip_uncertainties(const Machine& machine, const Model& model, const ToolModels& tools,
                                   const std::vector<WorkFrame>& frames);

}  // namespace counterflex
