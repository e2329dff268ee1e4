#pragma once
/// Eigen's decompositions of matrices of any size, compiled once for the module: each costs seconds wherever it is used.
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

extern template void Eigen::PartialPivLU<Eigen::MatrixXd>::compute();
extern template void Eigen::FullPivLU<Eigen::MatrixXd>::computeInPlace();
extern template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::computeInPlace();
extern template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::computeInPlace();
extern template Eigen::JacobiSVD<Eigen::MatrixXd>& Eigen::JacobiSVD<Eigen::MatrixXd>::compute(const Eigen::MatrixXd&, unsigned);

namespace counterflex {

/// An orthonormal basis, as columns, of the vectors x with C x = 0; what is zero is judged as in Eigen's QR of C'.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& C, double threshold);

/// Solutions of minimum norm, and of square systems: calls of Eigen's own `solve`.
Eigen::MatrixXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A, const Eigen::MatrixXd& B);
Eigen::VectorXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A, const Eigen::VectorXd& b);
Eigen::VectorXd solved(const Eigen::FullPivLU<Eigen::MatrixXd>& A, const Eigen::VectorXd& b);

}  // namespace counterflex
