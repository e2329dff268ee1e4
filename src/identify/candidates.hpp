#pragma once
/// Which parameters of a machine are fitted, and what is known of them before.
#include <vector>

#include "counterflex/identify/identify.hpp"

namespace counterflex {

/// Of the prior deviation: data that leave more do not identify a parameter, or what a row shows.
inline constexpr double identified_share = 0.5;

struct Candidates {
  std::vector<std::size_t> varied;       ///< indices into `parameters(machine)`
  std::vector<ParameterSet> set;         ///< by varied parameter: the first that has it
  std::vector<bool> is_default;          ///< the machine file states no standard deviation
  Eigen::VectorXd before, prior, least;  ///< values of the file, standard deviations, lower bounds (SI)
  Eigen::MatrixXd correlation;           ///< of what is known before
};

/// The parameters of the sets, with the deviations of `earlier` or of the machine file, without those whose
/// standard deviation is zero, and without reversals if no row has a direction of motion.
Candidates candidates(const Machine& machine, const Measurements& measurements,
                      const std::vector<ParameterSet>& sets, const KnownParameters& earlier);

/// Prior deviations of the candidates whose sets are in `sets`, 0 for the others.
Eigen::VectorXd prior_of(const Candidates& candidates, const std::vector<ParameterSet>& sets);

}  // namespace counterflex
