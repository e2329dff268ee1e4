#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/map.hpp"

namespace counterflex {
namespace {

/// Whether the perfect machine has its tip at `X_MT` in its travel.
bool reaches(const Model& model, const Pose& X_MT) {
  constexpr double near = 1e-9;  // m: components that the machine does not control stay at home
  const NominalResult nominal = follow(model, model.home, X_MT);
  return nominal.status == Status::converged &&
         (tip(model.mechanism, nominal.configuration).p - X_MT.p).norm() < near &&
         within_travel(model.mechanism, actuator_values(model.mechanism, nominal.configuration));
}

/// The corners of the travel of three linear axes whose travel has limits; empty for other machines.
std::vector<Eigen::VectorXd> corners_of_travel(const Model& model) {
  const std::vector<Travel>& travel = model.mechanism.travel;
  std::vector<Eigen::Index> linear;
  for (std::size_t i = 0; i < travel.size(); ++i)
    if (travel[i].kind == JointKind::prismatic) linear.push_back(static_cast<Eigen::Index>(i));
  if (linear.size() != 3) return {};
  const Eigen::VectorXd home =
      shown_values(model.mechanism.shown, actuator_values(model.mechanism, model.home));
  std::vector<Eigen::VectorXd> corners;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::VectorXd shown = home;
    for (int k = 0; k < 3; ++k) {
      const Travel& axis = travel[static_cast<std::size_t>(linear[static_cast<std::size_t>(k)])];
      shown[linear[static_cast<std::size_t>(k)]] = (corner >> k & 1) != 0 ? axis.max : axis.min;
    }
    if (!shown.allFinite()) return {};
    corners.push_back(joint_values(model.mechanism.shown, shown));
  }
  return corners;
}

/// The places of the tip at the corners, if they are those of a parallelepiped that the tip crosses without
/// turning.
std::optional<MapBox> box_of_linear_axes(const Model& model) {
  const std::vector<Eigen::VectorXd> corners = corners_of_travel(model);
  if (corners.empty()) return std::nullopt;
  constexpr double straight = 1e-9;  // m, and rad
  const Pose X_home = tip(model.mechanism, model.home);
  std::vector<Vector3> p;
  for (const Eigen::VectorXd& rho : corners) {
    const NominalResult there = nominal_forward(model, model.home, rho);
    if (there.status != Status::converged) return std::nullopt;
    const Pose X = tip(model.mechanism, there.configuration);
    if (rotation_between(X.R, X_home.R).norm() > straight) return std::nullopt;
    p.push_back(X.p);
  }
  MapBox box{p[0], p[0]};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Vector3 linear = p[0];
    for (int k = 0; k < 3; ++k)
      if ((corner >> k & 1) != 0) linear += p[std::size_t{1} << k] - p[0];
    if ((p[corner] - linear).norm() > straight) return std::nullopt;
    box.least = box.least.cwiseMin(p[corner]);
    box.most = box.most.cwiseMax(p[corner]);
  }
  return box;
}

/// How far the tip gets from home along `direction` (m), to a whole mm downwards; infinite without an end.
double way_from_home(const Model& model, const Vector3& direction) {
  const Pose X_home = tip(model.mechanism, model.home);
  const auto gets = [&](double way_mm) {
    return reaches(model, {X_home.R, X_home.p + way_mm * mm * direction});
  };
  constexpr double endless_mm = 1e5;
  double reached = 0, missed = 1;
  for (; missed < endless_mm && gets(missed); missed *= 2) reached = missed;
  if (missed >= endless_mm) return HUGE_VAL;
  while (missed - reached > 1) {
    const double middle = std::floor((reached + missed) / 2);
    (gets(middle) ? reached : missed) = middle;
  }
  return reached * mm;
}

/// The box around home with that share of the ways from home, its faces at whole mm.
MapBox box_of_ways(const Model& model, const MapBox& ways, double share) {
  const Vector3 p = tip(model.mechanism, model.home).p;
  MapBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double least = std::ceil((p[axis] + share * ways.least[axis]) / mm) * mm,
                 most = std::floor((p[axis] + share * ways.most[axis]) / mm) * mm;
    const bool is_flat = !(most > least);
    box.least[axis] = is_flat ? p[axis] : least;
    box.most[axis] = is_flat ? p[axis] : most;
  }
  return box;
}

bool reaches_corners(const Model& model, const MapBox& box) {
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  const MapGrid corners{box, {2, 2, 2}};
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (!reaches(model, {R_home, corners.place(i)})) return false;
  return true;
}

}  // namespace

std::size_t MapGrid::size() const {
  return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
         static_cast<std::size_t>(count[2]);
}

double MapGrid::coordinate(int axis, int step) const {
  const int steps = count[static_cast<std::size_t>(axis)] - 1;
  const double u = steps == 0 ? 0.5 : static_cast<double>(step) / steps;
  return (1 - u) * box.least[axis] + u * box.most[axis];
}

Vector3 MapGrid::place(std::size_t index) const {
  const auto nx = static_cast<std::size_t>(count[0]), ny = static_cast<std::size_t>(count[1]);
  return {coordinate(0, static_cast<int>(index % nx)), coordinate(1, static_cast<int>(index / nx % ny)),
          coordinate(2, static_cast<int>(index / nx / ny))};
}

double MapGrid::spacing(int axis) const {
  return (box.most[axis] - box.least[axis]) / std::max(1, count[static_cast<std::size_t>(axis)] - 1);
}

MapGrid grid_of(const MapBox& box, const std::array<int, 3>& count) {
  MapGrid grid{box, count};
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.most[axis] > box.least[axis])) grid.count[static_cast<std::size_t>(axis)] = 1;
  return grid;
}

std::optional<MapBox> reached_box(const Model& model) {
  if (const std::optional<MapBox> box = box_of_linear_axes(model)) return box;
  MapBox ways;  // from home
  for (int axis = 0; axis < 3; ++axis) {
    ways.least[axis] = -way_from_home(model, -Vector3::Unit(axis));
    ways.most[axis] = way_from_home(model, Vector3::Unit(axis));
  }
  if (!ways.least.allFinite() || !ways.most.allFinite()) return std::nullopt;
  constexpr int parts = 16;
  for (int part = parts; part > 1; --part) {
    const MapBox box = box_of_ways(model, ways, static_cast<double>(part) / parts);
    if (reaches_corners(model, box)) return box;
  }
  return box_of_ways(model, ways, 1.0 / parts);
}

}  // namespace counterflex
