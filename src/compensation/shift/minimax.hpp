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

/// What the variables from + x cost: the sum of of[k] (from + x)[k]^2 / 2.
struct MinimaxCost {
  Eigen::VectorXd of, from;
};

/// The x that minimises the largest |r + J x| and the cost together, to within a millionth of the largest
/// |r|. All variables need a cost, because places may not depend on some of them.
Eigen::VectorXd least_largest(std::span<const MinimaxRow> rows, const MinimaxCost& cost);

}  // namespace counterflex
