#include "statics/theory/decompositions.hpp"

#include "statics/model/tolerances.hpp"

template void Eigen::PartialPivLU<Eigen::MatrixXd>::compute();
template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::computeInPlace();
template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::computeInPlace();

namespace counterflex {

Eigen::MatrixXd null_space(const Eigen::MatrixXd& C) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(rank_threshold);
  qr.compute(C.transpose());
  const auto nullity = C.cols() - qr.rank();
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(C.cols(), nullity);
  if (nullity == 0) return Z;
  Z.bottomRows(nullity).setIdentity();
  Z.applyOnTheLeft(qr.householderQ().setLength(qr.rank()));
  return Z;
}

Decomposition decomposed(const Eigen::MatrixXd& A) {
  Decomposition decomposition;
  decomposition.setThreshold(rank_threshold);
  decomposition.compute(A);
  return decomposition;
}

Eigen::MatrixXd solved(const Decomposition& A, const Eigen::MatrixXd& B) {
  return A.solve(B);
}

Eigen::VectorXd solved(const Decomposition& A, const Eigen::VectorXd& b) {
  return A.solve(b);
}

std::optional<Matrix6> inverse_in_units(const Matrix6& M, const Vector6& units) {
  Eigen::FullPivLU<Matrix6> lu(units.asDiagonal() * M * units.asDiagonal());
  lu.setThreshold(rank_threshold);
  if (!lu.isInvertible()) return std::nullopt;
  return units.asDiagonal() * lu.inverse() * units.asDiagonal();
}

}  // namespace counterflex
