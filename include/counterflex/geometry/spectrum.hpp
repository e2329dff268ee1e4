#pragma once
/// Eigenvalues and singular values of matrices of any size, compiled once for all modules: Eigen's
/// decompositions cost seconds wherever they are used.
#include <Eigen/Core>

namespace counterflex {

/// Of a symmetric matrix, whose lower half is read: eigenvalues, the smallest first, and eigenvectors of unit
/// length as columns in the same order.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
Spectrum spectrum(const Eigen::MatrixXd& A);

/// The eigenvalues alone.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A);

/// Singular values of any matrix, the largest first.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);

}  // namespace counterflex
