#include "decompositions.hpp"

template class Eigen::LLT<Eigen::MatrixXd>;
template class Eigen::PartialPivLU<Eigen::MatrixXd>;
template class Eigen::FullPivLU<Eigen::MatrixXd>;
template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
template class Eigen::JacobiSVD<Eigen::MatrixXd>;
template class Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

namespace counterflex {

Eigen::MatrixXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A, const Eigen::MatrixXd& B) {
  return A.solve(B);
}

Eigen::VectorXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A, const Eigen::VectorXd& b) {
  return A.solve(b);
}

Eigen::VectorXd solved(const Eigen::FullPivLU<Eigen::MatrixXd>& A, const Eigen::VectorXd& b) {
  return A.solve(b);
}

}  // namespace counterflex
