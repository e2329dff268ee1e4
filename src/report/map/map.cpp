#include "counterflex/report/map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "counterflex/files/parallel.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/statics/loaded_tips.hpp"
#include "counterflex/statics/tip_stiffness.hpp"

namespace counterflex {
namespace {

constexpr std::size_t chunk = 64;  // places of one call of the kernel; of no effect on results

MapPlace deviation_place(const Vector3& actual, const Vector3& wanted) {
  return {Status::converged, (actual - wanted).norm(), actual - wanted};
}

MapPlace stiffness_place(const Matrix6& compliance, const std::optional<Vector3>& direction) {
  if (direction) return {Status::converged, stiffness_along(compliance, *direction), *direction};
  const SoftestDirection softest = softest_direction(compliance);
  return {Status::converged, softest.stiffness, softest.direction};
}

/// Solves the places from index `first` on.
void solve_chunk(const MapRequest& request, const StartTable& table, std::size_t first,
                 std::vector<MapPlace>& places) {
  const std::size_t count = std::min(chunk, places.size() - first);
  const Vector3 turn = log_so3(request.R_turn);
  std::vector<BatchRequest> poses;
  for (std::size_t i = 0; i < count; ++i)
    poses.push_back({{request.grid.place(first + i), turn}, request.load.F});
  if (request.quantity == MapQuantity::stiffness) {
    const std::vector<LoadedCompliance> found = loaded_compliances(table, poses);
    for (std::size_t i = 0; i < count; ++i)
      places[first + i] = found[i].status == Status::converged
                              ? stiffness_place(found[i].C, request.direction)
                              : MapPlace{found[i].status};
    return;
  }
  const std::vector<LoadedTip> found = loaded_tips(table, poses);
  for (std::size_t i = 0; i < count; ++i)
    places[first + i] = found[i].status == Status::converged ? deviation_place(found[i].X_MT.p, poses[i].at.p)
                                                             : MapPlace{found[i].status};
}

}  // namespace

std::vector<MapPlace> map_places(const Model& model, const MapRequest& request) {
  std::vector<MapPlace> places(request.grid.size());
  const StartTable table(model, false);
  for_each_index((places.size() + chunk - 1) / chunk, request.threads,
                 [&](std::size_t i) { solve_chunk(request, table, i * chunk, places); });
  return places;
}

MapRange range_of(const WorkspaceMap& map) {
  MapRange range;
  std::vector<double> values;
  const bool larger_is_better = map.request.quantity == MapQuantity::stiffness;
  for (std::size_t i = 0; i < map.places.size(); ++i) {
    if (map.places[i].status != Status::converged) continue;
    ++range.solved;
    const double value = map.places[i].value;
    if (!std::isfinite(value)) {
      ++range.rigid;
      continue;
    }
    constexpr double same = 1e-7;  // of a value
    const auto better = [&](double a, double b) {
      return (larger_is_better ? a - b : b - a) > same * std::max(std::abs(a), std::abs(b));
    };
    if (values.empty() || better(value, map.places[range.best].value)) range.best = i;
    if (values.empty() || better(map.places[range.worst].value, value)) range.worst = i;
    values.push_back(value);
  }
  if (values.empty()) return range;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  range.median = *middle;
  return range;
}

}  // namespace counterflex
