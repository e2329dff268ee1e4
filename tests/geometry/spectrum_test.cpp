#include "counterflex/geometry/spectrum.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace counterflex;

namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> entry(-1, 1);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return entry(random); });
}

}  // namespace

TEST_CASE("a symmetric matrix stretches its eigenvectors by its eigenvalues, the smallest first") {
  for (const Eigen::Index n : {1, 3, 6, 20}) {
    CAPTURE(n);
    const Eigen::MatrixXd B = random_matrix(n, n), A = B + B.transpose();
    const Spectrum found = spectrum(A);
    CHECK((A * found.vectors - found.vectors * found.values.asDiagonal()).norm() < 1e-12 * A.norm());
    CHECK((found.vectors.transpose() * found.vectors - Eigen::MatrixXd::Identity(n, n)).norm() < 1e-12);
    CHECK(std::is_sorted(found.values.begin(), found.values.end()));
    CHECK((eigenvalues(A) - found.values).norm() < 1e-12 * A.norm());
  }
}

TEST_CASE("of a symmetric matrix only the lower half is read") {
  Eigen::MatrixXd A = random_matrix(4, 4);
  A = (A + A.transpose()).eval();
  const Eigen::VectorXd before = eigenvalues(A);
  A.triangularView<Eigen::StrictlyUpper>().setConstant(1e6);
  CHECK(eigenvalues(A) == before);
}

TEST_CASE("squares of singular values are the eigenvalues of A'A, the largest first") {
  const Eigen::MatrixXd A = random_matrix(7, 4);
  const Eigen::VectorXd squares = singular_values(A).cwiseAbs2();
  CHECK((squares.reverse() - eigenvalues(A.transpose() * A)).norm() < 1e-12 * A.squaredNorm());
}
