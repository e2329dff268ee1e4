#pragma once
/// The least largest norm of vectors that depend linearly on common variables.
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// r + J x, where `column[k]` is the variable of the k-th column of J.
struct MinimaxRow {
  static constexpr int most = 8;
  Vector3 r = Vector3::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, most> J{};
  std::array<int, most> column{};

  Vector3 at(const Eigen::VectorXd& x) const;
};

/// The x that minimises the largest |r + J x| to within a millionth of the largest |r|; of several the
/// smallest, `weight` by variable.
Eigen::VectorXd least_largest(std::span<const MinimaxRow> rows, const Eigen::VectorXd& weight);

}  // namespace counterflex
