#include "program/text/corners.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace counterflex {
namespace {

constexpr double sharpest =
    170.0 / 180 * std::numbers::pi;  // rad: a rounding of a sharper corner is too long

bool is_flat_line(const Move& move) {
  return move.motion == Motion::feed && !move.arc && !move.cycle && !move.words[2] &&
         all_known(move.known_start) && all_known(move.known_end) && (move.words[0] || move.words[1]);
}

CornerEnds& ends_of(Move& move) {
  return move.corners ? *move.corners : move.corners.emplace();
}

constexpr double unknown_size = std::numeric_limits<double>::infinity();

}  // namespace

void expect_corner_behind(Move& move) {
  ends_of(move).end_mm = unknown_size;
  move.takes_no_z = !move.words[2];
}

void expect_corner_before(Move& move) {
  ends_of(move).begin_mm = unknown_size;
  move.takes_no_z = !move.words[2];
}

void place_corner(const CornerSize& size, Move& before, Move& after) {
  ends_of(before).end_size = size;
  if (!(size.mm >= 0) || !is_flat_line(before) || !is_flat_line(after)) return;
  const Vector3 a = before.end_mm - before.start_mm, b = after.end_mm - after.start_mm;
  const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
  if (a.isZero(0) || b.isZero(0) || turn > sharpest) return;
  before.corners->end_mm = ends_of(after).begin_mm = taken_by_corner(size.kind, size.mm, turn);
  // Behind its first, flat part the block may have another height.
  if (after.corners->end_mm == 0) after.takes_no_z = !changes_height_inside(after);
}

double taken_by_corner(CornerKind kind, double size, double turn) {
  if (kind == CornerKind::round) return size * std::tan(turn / 2);
  return kind == CornerKind::chamfer ? size / (2 * std::cos(turn / 2)) : size;
}

}  // namespace counterflex
