#include "statics/theory/decompositions.hpp"

#include "statics/model/tolerances.hpp"

template void Eigen::PartialPivLU<Eigen::MatrixXd>::compute();
template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::computeInPlace();
template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::computeInPlace();

namespace counterflex {

Eigen::MatrixXd null_space(const Eigen::MatrixXd& C, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(threshold);
  qr.compute(C.transpose());
  const auto nullity = C.cols() - qr.rank();
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(C.cols(), nullity);
  if (nullity == 0) return Z;
  Z.bottomRows(nullity).setIdentity();
  Z.applyOnTheLeft(qr.householderQ().setLength(qr.rank()));
  return Z;
}

Eigen::MatrixXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A,
                       const Eigen::MatrixXd& B) {
  return A.solve(B);
}

Eigen::VectorXd solved(const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>& A,
                       const Eigen::VectorXd& b) {
  return A.solve(b);
}

std::optional<Matrix6> inverse_in_units(const Matrix6& M, const Vector6& units) {
  Eigen::FullPivLU<Matrix6> lu(units.asDiagonal() * M * units.asDiagonal());
  lu.setThreshold(rank_threshold);
  if (!lu.isInvertible()) return std::nullopt;
  return units.asDiagonal() * lu.inverse() * units.asDiagonal();
}

}  // namespace counterflex
