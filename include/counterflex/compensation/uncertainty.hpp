#pragma once
/// Bands of deviations: to first order, and from samples: machines, forces and tools drawn from their
/// uncertainty, each solved.
#include <cstddef>
#include <map>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"

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

/// A machine that is drawn, and the force and the tip's own errors that come with it.
struct DrawnMachine {
  Machine machine;
  double force = 1;        ///< factor of the wrench on the tool
  double tool_length = 0;  ///< m: by which the tool is longer
};

/// Number `index` of the machines of `machine`, which has an uncertainty: each parameter, the force, the
/// tool's length and the temperature from normal distributions. Compliances and masses stay positive: they
/// are drawn again. The same number gives the same machine.
DrawnMachine drawn_machine(const Machine& machine, std::size_t index);

/// What samples show of the bands that are computed to first order. Over all places together.
struct SampledBands {
  std::size_t samples = 0, places = 0;
  std::size_t unsolved = 0;  ///< places of samples without a stable equilibrium: not counted
  double covered_percent =
      0;  ///< of the deviations: inside of their band, which is about the run's deviation
  /// Standard deviation of the samples by that of the first order, of all places: least and largest.
  double least_ratio = 1, largest_ratio = 1;
};

/// The bands of `after` (of a prediction: `before`, which is the same there), of at most 64 places that have
/// a covariance, at equal distances in the list, whose parts are at `frames`. `tools`: of the program. The
/// result does not depend on `threads`.
SampledBands sample_bands(const Machine& machine, const std::vector<long>& tools,
                          const std::vector<WorkFrame>& frames, const std::vector<LoadPlace>& places,
                          std::size_t samples, int threads);

/// The covariance of the tip at a place, by its parts. Nothing where it cannot be solved.
std::optional<TipCovariance> solve_covariance(const LoadPlace& place, const TipUncertainties& uncertainties,
                                              const StartTables* starts = nullptr);

}  // namespace counterflex
