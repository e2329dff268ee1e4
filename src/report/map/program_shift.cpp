#include <algorithm>
#include <cmath>

#include "counterflex/report/map.hpp"

namespace counterflex {
namespace {

/// Where a coordinate is between two steps of a grid's axis; `step` is -1 outside.
struct BetweenSteps {
  int step = -1;
  double part = 0;  ///< of the next step
};

BetweenSteps between_steps(const MapGrid& grid, int axis, double value) {
  const int steps = grid.count[static_cast<std::size_t>(axis)] - 1;
  const double width = grid.box.most[axis] - grid.box.least[axis];
  constexpr double slack = 1e-9;  // m
  if (value < grid.box.least[axis] - slack || value > grid.box.most[axis] + slack) return {};
  if (steps == 0) return {0, 0};
  const double u = std::clamp((value - grid.box.least[axis]) / width, 0.0, 1.0) * steps;
  const int step = std::min(static_cast<int>(u), steps - 1);
  const double part = u - step;
  constexpr double whole = 1e-9;  // rounding must not need a neighbour
  return part < whole       ? BetweenSteps{step, 0}
         : part > 1 - whole ? BetweenSteps{step + 1, 0}
                            : BetweenSteps{step, part};
}

/// Of what the mean is taken: deviation (m) or compliance (m/N).
double averaged(const MapPlace& place, MapQuantity quantity) {
  return quantity == MapQuantity::deviation ? place.value : 1 / place.value;
}

/// Means over boxes in a map. Mean compliances are compared, so that less is better for both quantities.
class BoxMeans {
 public:
  BoxMeans(const MapRequest& request, const std::vector<MapPlace>& places)
      : grid_(request.grid), quantity_(request.quantity), places_(places) {}

  /// Empty if a part of the box is outside the grid or among places without a value.
  std::optional<double> mean(const MapBox& box) const {
    constexpr int points = 6;  // of a side
    std::array<std::vector<BetweenSteps>, 3> sides;
    for (int axis = 0; axis < 3; ++axis) {
      const double width = box.most[axis] - box.least[axis];
      for (int i = 0; i < (width > 0 ? points : 1); ++i) {
        const BetweenSteps at = between_steps(grid_, axis, box.least[axis] + width * i / (points - 1));
        if (at.step < 0) return std::nullopt;
        sides[static_cast<std::size_t>(axis)].push_back(at);
      }
    }
    double sum = 0;
    for (const BetweenSteps& z : sides[2])
      for (const BetweenSteps& y : sides[1])
        for (const BetweenSteps& x : sides[0]) sum += value({x, y, z});
    if (!std::isfinite(sum)) return std::nullopt;
    return sum / static_cast<double>(sides[0].size() * sides[1].size() * sides[2].size());
  }

 private:
  /// Interpolated; not a number beside a place without a value.
  double value(const std::array<BetweenSteps, 3>& at) const {
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::size_t index = 0;
      for (int axis = 2; axis >= 0; --axis) {
        const auto k = static_cast<std::size_t>(axis);
        const bool next = (corner >> axis & 1) != 0;
        weight *= next ? at[k].part : 1 - at[k].part;
        index = index * static_cast<std::size_t>(grid_.count[k]) +
                static_cast<std::size_t>(at[k].step + (next && at[k].part > 0 ? 1 : 0));
      }
      if (weight == 0) continue;
      const MapPlace& place = places_[index];
      if (place.status != Status::converged) return NAN;
      sum += weight * averaged(place, quantity_);
    }
    return sum;
  }

  const MapGrid& grid_;
  MapQuantity quantity_;
  const std::vector<MapPlace>& places_;
};

/// The shifts along an axis that are tried, the present place first: the lower side of the box on each place
/// of the grid, and the upper side on the last one.
std::vector<double> shifts_along(const MapGrid& grid, int axis, const MapBox& box) {
  std::vector<double> shifts{0};
  const int count = grid.count[static_cast<std::size_t>(axis)];
  if (count == 1) return shifts;
  for (int step = 0; step < count; ++step) shifts.push_back(grid.coordinate(axis, step) - box.least[axis]);
  shifts.push_back(grid.coordinate(axis, count - 1) - box.most[axis]);
  return shifts;
}

double shown_mean(double mean, MapQuantity quantity) {
  return quantity == MapQuantity::deviation ? mean : 1 / mean;
}

std::optional<MapShift> best_shift(const MapRequest& request, const BoxMeans& means, const MapBox& box,
                                   bool in_plane) {
  std::optional<MapShift> best;
  constexpr double same = 1e-7;  // a part is not moved for rounding errors
  double least = 0;
  const std::vector<double> along_z = in_plane ? std::vector<double>{0} : shifts_along(request.grid, 2, box);
  for (const double z : along_z)
    for (const double y : shifts_along(request.grid, 1, box))
      for (const double x : shifts_along(request.grid, 0, box)) {
        const Vector3 shift(x, y, z);
        const std::optional<double> mean = means.mean({box.least + shift, box.most + shift});
        if (!mean || (best && !(*mean < (1 - same) * least))) continue;
        least = *mean;
        best = MapShift{shift, shown_mean(*mean, request.quantity)};
      }
  return best;
}

}  // namespace

MappedProgram place_program(const MapRequest& request, const std::vector<MapPlace>& places,
                            const std::string& name, const MapBox& box) {
  const BoxMeans means(request, places);
  MappedProgram program{name, box, {}, {}, {}};
  if (const std::optional<double> mean = means.mean(box))
    program.present = shown_mean(*mean, request.quantity);
  program.in_plane = best_shift(request, means, box, true);
  program.best = best_shift(request, means, box, false);
  return program;
}

}  // namespace counterflex
