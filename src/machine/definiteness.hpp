#pragma once
/// Checks whether a 6x6 matrix can be a stiffness or a compliance, and finds the entry that prevents it.
#include <optional>
#include <string>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// An entry (row and column from 0) and its error.
struct BadEntry {
  int row = 0;
  int column = 0;
  std::string why;
};

/// The first entry that differs from its mirror image by more than 1e-6 of the larger one. Entries that are
/// negligible beside their diagonals (1e-9 of the geometric mean) may differ: computed matrices have such
/// noise.
std::optional<BadEntry> find_asymmetry(const Matrix6& A);

/// The entry that prevents symmetric `A` from being positive definite or, if `semidefinite`, positive
/// semidefinite. Uses A scaled to a unit diagonal, so that lengths and angles are not compared.
std::optional<BadEntry> find_indefiniteness(const Matrix6& A, bool semidefinite);

/// The inverse of symmetric positive definite `A`, exactly symmetric; scaled before it is inverted.
Matrix6 symmetric_inverse(const Matrix6& A);

}  // namespace counterflex
