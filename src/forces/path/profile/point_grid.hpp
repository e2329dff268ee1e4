#pragma once
/// Finds the points near a piece of a path in a grid of cells.
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// Cells of equal size, each with the points in it. Lengths in m.
class PointGrid {
 public:
  /// For points within `within` of a piece.
  PointGrid(const std::vector<Vector3>& points, double within);

  /// Recommended largest length of a piece.
  double cell() const { return cell_; }

  /// Indices of points that include all points near the line from `a` to `b`; valid until the next call.
  const std::vector<std::uint32_t>& near(const Vector3& a, const Vector3& b);

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const;
  };
  Cell cell_of(const Vector3& p) const;

  double within_, cell_;
  Vector3 least_, most_;  ///< of all points
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells_;
  Cell first_{1, 1, 1}, last_{0, 0, 0};  ///< of the last call
  std::vector<std::uint32_t> found_, nothing_;
};

}  // namespace counterflex
