#pragma once
/// Eigen's decompositions of matrices of any size, compiled once for the module: each costs seconds wherever
/// it is used.
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <optional>

#include "counterflex/geometry/types.hpp"

extern template void Eigen::PartialPivLU<Eigen::MatrixXd>::compute();
extern template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::computeInPlace();
extern template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::computeInPlace();
extern template Eigen::JacobiSVD<Eigen::MatrixXd>& Eigen::JacobiSVD<Eigen::MatrixXd>::compute(
    const Eigen::MatrixXd&, unsigned);

namespace counterflex {

/// An orthonormal basis, as columns, of the vectors x with C x = 0; pivots of Eigen's QR of C' below
/// `rank_threshold` of the largest are zero.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& C);

/// A decomposition of `A` that takes pivots below `rank_threshold` of the largest for zero.
using Decomposition = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
Decomposition decomposed(const Eigen::MatrixXd& A);

/// Solutions of minimum norm: calls of Eigen's own `solve`.
Eigen::MatrixXd solved(const Decomposition& A, const Eigen::MatrixXd& B);
Eigen::VectorXd solved(const Decomposition& A, const Eigen::VectorXd& b);

/// The inverse of a stiffness or a compliance M; empty where D M D has a pivot of zero, D the diagonal matrix
/// of `units`.
std::optional<Matrix6> inverse_in_units(const Matrix6& M, const Vector6& units);

}  // namespace counterflex
