#include "counterflex/statics/directions.hpp"

namespace counterflex {

Eigen::VectorXd lag_of(const Mechanism& mechanism, const Directions& directions) {
  Eigen::VectorXd lag(static_cast<Eigen::Index>(mechanism.reversal.size()));
  for (std::size_t a = 0; a < mechanism.reversal.size(); ++a)
    lag[static_cast<Eigen::Index>(a)] = -0.5 * directions.of(a) * mechanism.reversal[a];
  return lag;
}

}  // namespace counterflex
