#include "forces/path/profile/point_grid.hpp"

#include <cmath>

namespace counterflex {
namespace {

// Cell size relative to the searched distance: few cells for a piece, few points in a cell.
constexpr double cell_per_within = 4;

}  // namespace

std::size_t PointGrid::Hash::operator()(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (const std::int64_t k : cell) {
    hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

PointGrid::PointGrid(const std::vector<Vector3>& points, double within)
    : within_(within), cell_(cell_per_within * within), least_(points.front()), most_(points.front()) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    least_ = least_.cwiseMin(points[i]);
    most_ = most_.cwiseMax(points[i]);
    cells_[cell_of(points[i])].push_back(static_cast<std::uint32_t>(i));
  }
}

PointGrid::Cell PointGrid::cell_of(const Vector3& p) const {
  Cell cell;
  for (Eigen::Index k = 0; k < 3; ++k)
    cell[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / cell_));
  return cell;
}

const std::vector<std::uint32_t>& PointGrid::near(const Vector3& a, const Vector3& b) {
  const Vector3 least = (a.cwiseMin(b).array() - within_).matrix().cwiseMax(least_),
                most = (a.cwiseMax(b).array() + within_).matrix().cwiseMin(most_);
  // Also avoids cells far beyond all points.
  if ((least.array() > most.array()).any()) return nothing_;
  const Cell first = cell_of(least), last = cell_of(most);
  if (first == first_ && last == last_) return found_;
  first_ = first;
  last_ = last;
  found_.clear();
  Cell at;
  for (at[0] = first[0]; at[0] <= last[0]; ++at[0])
    for (at[1] = first[1]; at[1] <= last[1]; ++at[1])
      for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) {
        const auto cell = cells_.find(at);
        if (cell != cells_.end()) found_.insert(found_.end(), cell->second.begin(), cell->second.end());
      }
  return found_;
}

}  // namespace counterflex
