#pragma once
/// Polynomials in three variables of [-1, 1], all powers together up to a degree, in the order of the lane kernels.
#include <Eigen/Core>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// x^(d-i) y^(i-j) z^(j-k) for i = 0..d, j = 0..i, k = 0..j.
Eigen::RowVectorXd monomials(const Vector3& x, int degree);

/// Their derivatives by x, y, z (columns 0 to 2) and by xx, xy, xz, yy, yz, zz (3 to 8), a monomial a row.
Eigen::Matrix<double, Eigen::Dynamic, 9> derivatives_of_monomials(const Vector3& x, int degree);

inline int monomial_count(int degree) { return (degree + 1) * (degree + 2) * (degree + 3) / 6; }

/// Points at which a function is to be known, crowded towards the faces (those of a lower degree first), and the matrix from
/// its values there to the coefficients that fit them best.
struct PolynomialFit {
  std::vector<Vector3> points;
  Eigen::MatrixXd from_values;
};
const PolynomialFit& polynomial_fit(int degree);

/// Points of the same kind that are in no fit, to judge one by.
const std::vector<Vector3>& polynomial_checks();

/// Monomials there, one point a row.
const Eigen::MatrixXd& powers_at_checks(int degree);

}  // namespace counterflex
