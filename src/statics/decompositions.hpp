#pragma once
/// Eigen's decompositions of matrices of any size, compiled once for the module: each costs seconds wherever it is used.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

extern template class Eigen::LLT<Eigen::MatrixXd>;
extern template class Eigen::PartialPivLU<Eigen::MatrixXd>;
extern template class Eigen::FullPivLU<Eigen::MatrixXd>;
extern template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
extern template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;
extern template class Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

namespace counterflex {

/// Solutions of minimum norm, and of square systems: calls of Eigen's own `solve`.
Eigen::MatrixXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A, const Eigen::MatrixXd& B);
Eigen::VectorXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A, const Eigen::VectorXd& b);
Eigen::VectorXd solved(const Eigen::FullPivLU<Eigen::MatrixXd>& A, const Eigen::VectorXd& b);

}  // namespace counterflex
