#pragma once
/// Fixed-size vectors and matrices. Six-vectors are ordered translation first: (x y z rx ry rz), (fx fy fz mx my mz).
#include <Eigen/Core>

namespace counterflex {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

}  // namespace counterflex
