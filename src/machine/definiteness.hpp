#pragma once
/// Whether a 6x6 matrix may be a stiffness or a compliance, and which entry says that it may not.
#include <optional>
#include <string>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// What is wrong with an entry (row and column from 0).
struct BadEntry {
  int row = 0;
  int column = 0;
  std::string why;
};

/// The first entry that differs from its mirror image by more than 1e-6 of the larger one. Entries that are
/// nothing beside their diagonals (1e-9 of the geometric mean) may differ: matrices that were computed have
/// such noise.
std::optional<BadEntry> find_asymmetry(const Matrix6& A);

/// The entry that keeps symmetric `A` from being positive definite or, where `semidefinite`, positive
/// semidefinite: judged on A scaled to a unit diagonal, so that lengths and angles need not be compared.
std::optional<BadEntry> find_indefiniteness(const Matrix6& A, bool semidefinite);

/// The inverse of symmetric positive definite `A`, exactly symmetric; scaled before it is inverted.
Matrix6 symmetric_inverse(const Matrix6& A);

}  // namespace counterflex
