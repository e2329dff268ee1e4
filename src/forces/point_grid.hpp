#pragma once
/// Points that are near a piece of a path, found without a look at all of them.
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// Cells of equal size, each with the points in it. Lengths in m.
class PointGrid {
 public:
  /// Finds points that lie within `within` of a piece.
  PointGrid(const std::vector<Vector3>& points, double within);

  /// Pieces should not be longer.
  double cell() const { return cell_; }

  /// Indices of points, among them all that are near the line from `a` to `b`; until the next call.
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
  Cell first_{1, 1, 1}, last_{0, 0, 0};  ///< of the last answer
  std::vector<std::uint32_t> found_, nothing_;
};

}  // namespace counterflex
