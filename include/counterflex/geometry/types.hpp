#pragma once
/// Fixed-size vectors and matrices. Six-vectors are ordered translation first: (x y z rx ry rz), (fx fy fz mx
/// my mz).
#include <Eigen/Core>

namespace counterflex {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Inside everything is SI (m, rad, N, N m, s); these convert what files and people use. `3 * mm` is 0.003 m,
// `p / mm` is a length in millimetres.

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double mm = 1e-3;
inline constexpr double um = 1e-6;
inline constexpr double inch = 25.4e-3;
inline constexpr double deg = pi / 180.0;
inline constexpr double N_per_um = 1e6;
inline constexpr double N_per_mm = 1e3;
inline constexpr double N_per_mm2 = 1e6;

}  // namespace counterflex
