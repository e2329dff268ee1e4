#pragma once
/// How near the points of a written robot program are to each other, where points are inserted.
#include <cmath>
#include <map>
#include <vector>

#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// The edit of a move, or nullptr.
const MoveEdit* edit_of(const std::vector<MoveEdit>& edits, std::size_t move);

/// The points that are written for `move`: inserted ones and its end, rounded to their digits. `edit`:
/// nullptr for a move that stays.
std::vector<Vector3> written_points(const Move& move, const MoveEdit* edit, const WriteOptions& options);

/// Distance from `from` to the first of `points` that differs from it; infinite without one.
template <typename Points>
double distance_to_next(const Vector3& from, const Points& points) {
  for (const Vector3& point : points)
    if (const double distance_mm = (point - from).norm(); distance_mm > 1e-9) return distance_mm;
  return HUGE_VAL;
}

/// Keeps the smaller one of `distance_mm` and the distance that is there for `move`.
void limit_spacing(std::map<std::size_t, double>& spacings_mm, std::size_t move, double distance_mm);

/// By index of the move: distance (mm) from its target to the nearest point that is inserted beside it,
/// before it or behind it. Only targets with such a point.
std::map<std::size_t, double> spacing_at_targets(const Program& program, const std::vector<MoveEdit>& edits,
                                                 const WriteOptions& options);

}  // namespace counterflex
