#include "compensation/emit/contour_radius.hpp"

#include <algorithm>
#include <cmath>

#include "compensation/solve/corner_way.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr double tangent = 1e-6;  // rad: the control shortens lines by less than their rounding

Vector3 to_tool(const ContourWay& way, double u) {
  const Vector3 left = Vector3::UnitZ().cross(direction_at(way.curve, u));
  return way.side == CutterSide::left ? left : Vector3(-left);
}

double radius_of(const ContourWay& way) {
  return radius_at(*way.curve.arc, way.curve.start);
}

bool is_inner_arc(const ContourWay& way) {
  return way.curve.arc && to_tool(way, 0).dot(way.curve.arc->centre - way.curve.start) > 0;
}

// The circle on the tool's side of q, with the normal n there, that touches `other` or its continuation:
// |q + r n - c| = R - r where the tool is inside of a circle, R + r outside, and a distance of r from a line.
double touching_radius(const Vector3& q, const Vector3& n, const ContourWay& other) {
  double above = 0, below = 0;
  if (!other.curve.arc) {
    const Vector3 m = to_tool(other, 0);
    above = (q - other.curve.start).dot(m);
    below = 1 - n.dot(m);
  } else {
    const Vector3 w = q - other.curve.arc->centre;
    const double R = radius_of(other), sign = is_inner_arc(other) ? -1 : 1;
    above = sign * (w.squaredNorm() - R * R);
    below = 2 * (R - sign * w.dot(n));
  }
  return below > 0 ? std::min(above / below, largest_tool_radius_mm) : largest_tool_radius_mm;
}

// One side of an inner corner: `way` ends (or begins) there, and `other` is behind (or before) it.
struct CornerSide {
  const ContourWay* way = nullptr;
  const ContourWay* other = nullptr;
  bool at_end = false;

  // Of the tool that touches the way this far from the corner, and the other one.
  double touching_at(double along_mm) const {
    const double share = along_mm / length(way->curve), u = at_end ? 1 - share : share;
    return touching_radius(point_at(way->curve, u), to_tool(*way, u), *other);
  }
};

// Of the largest value of a function that rises to it and falls behind it.
double largest_between(const CornerSide& side, double low, double high) {
  constexpr int thirds = 30;
  for (int k = 0; k < thirds; ++k) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (side.touching_at(a) < side.touching_at(b))
      low = a;
    else
      high = b;
  }
  return side.touching_at((low + high) / 2);
}

// The largest radius that shortens the way by `room_mm` at most.
double radius_within(const CornerSide& side, double room_mm) {
  if (side.way == nullptr) return largest_tool_radius_mm;
  if (room_mm <= 0) return 0;
  if (!side.way->curve.arc && !side.other->curve.arc) return side.touching_at(room_mm);
  constexpr int halvings = 20;
  double at = std::ldexp(room_mm, -halvings), next = at, best = side.touching_at(at);
  while (next < room_mm) {
    next = std::min(2 * at, room_mm);
    const double radius = side.touching_at(next);
    if (radius < best) break;
    at = next;
    best = radius;
  }
  return std::max(best, largest_between(side, at / 2, next));
}

// The largest radius that shortens the way at both ends by no more than its length.
double radius_of_whole(const CornerSide& begin, const CornerSide& end, double length_mm) {
  if (begin.way == nullptr) return radius_within(end, length_mm);
  if (end.way == nullptr) return radius_within(begin, length_mm);
  constexpr int halvings = 40;
  double low = 0, high = length_mm;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    (radius_within(begin, middle) < radius_within(end, length_mm - middle) ? low : high) = middle;
  }
  return std::max(radius_within(begin, low), radius_within(end, length_mm - high));
}

constexpr double same_place_mm = 1e-6;

Curve in_plane(Curve curve) {
  curve.start.z() = curve.end.z() = 0;
  if (curve.arc) curve.arc->centre.z() = 0;
  return curve;
}

// How far before the end of a move a point is that is inserted into it.
double before_end_mm(const Curve& curve, const MoveEdit& edit, const Vector3& p_mm) {
  const Vector3 left = (edit.end_mm - p_mm).cwiseProduct(Vector3(1, 1, 0));
  if (!curve.arc || !edit.centre_mm || left.norm() < same_place_mm) return left.norm();
  const double sweep = sweep_between(p_mm, edit.end_mm, *edit.centre_mm, curve.arc->normal, 0);
  return sweep / curve.arc->sweep * length(curve);
}

// Sets the lengths of the pieces at its ends.
void divide_way(const MoveEdit& edit, ContourWay& way) {
  const double length_mm = length(way.curve);
  way.first_mm = way.last_mm = length_mm;
  for (const Via& via : edit.inserted) {
    const double left_mm = before_end_mm(way.curve, edit, via.end_mm);
    if (left_mm < same_place_mm || left_mm > length_mm - same_place_mm) continue;
    way.first_mm = std::min(way.first_mm, length_mm - left_mm);
    way.last_mm = std::min(way.last_mm, left_mm);
    way.is_divided = true;
  }
}

// Takes what a corner between two lines takes, and puts its rounding or chamfer between them.
void put_corner(const CornerSize& size, std::vector<ContourWay>& ways, ContourWay& after) {
  ContourWay& before = ways.back();
  const auto between = corner_way(before.curve, after.curve, size.kind, size.mm);
  if (!between) return;  // hardly a corner
  before.last_mm -= (before.curve.end - between->start).norm();
  after.first_mm -= (between->end - after.curve.start).norm();
  before.curve.end = between->start;
  after.curve.start = between->end;
  ways.push_back({.curve = *between, .side = before.side, .move = before.move});
}

// Collects the ways of one contour after the other.
class ContourReader {
 public:
  ContourReader(const Job& job, const std::vector<MoveEdit>& edits) : job_(job), edits_(edits) {}

  std::vector<NarrowedContour> run() {
    for (std::size_t m = 0; m < job_.program.moves.size(); ++m) read(m);
    finish();
    return std::move(found_);
  }

 private:
  void read(std::size_t m) {
    const Move& move = job_.program.moves[m];
    if (is_known(move) && stays_in_plane(move)) return;
    if (move.cutter_side == CutterSide::none || !is_known(move)) return finish();
    ContourWay way = way_of(m, move.cutter_side);
    if (!ways_.empty() && !follows(way)) finish();
    if (ways_.empty()) begin(m, way);
    if (!ways_.empty() && job_.program.moves[ways_.back().move].corners) put_corner_before(way);
    is_divided_ = is_divided_ || way.is_divided;
    ways_.push_back(way);
  }

  static bool is_known(const Move& move) { return all_known(move.known_start) && all_known(move.known_end); }

  static bool stays_in_plane(const Move& move) {
    return !move.arc && (move.end_mm - move.start_mm).head<2>().norm() < same_place_mm;
  }

  bool follows(const ContourWay& way) const {
    const double off = (ways_.back().curve.end - way.curve.start).norm();
    return ways_.back().side == way.side && off < same_place_mm;
  }

  ContourWay way_of(std::size_t m, CutterSide side) const {
    ContourWay way{.curve = in_plane(curve_of(job_.program.moves[m])), .side = side, .move = m};
    const auto edit = std::lower_bound(edits_.begin(), edits_.end(), m,
                                       [](const MoveEdit& e, std::size_t move) { return e.move < move; });
    if (edit != edits_.end() && edit->move == m) divide_way(*edit, way);
    return way;
  }

  // LinuxCNC treats the block that approaches a contour as a part of it. Other controls end it square to the
  // contour.
  void begin(std::size_t m, const ContourWay& first) {
    const std::vector<Move>& moves = job_.program.moves;
    if (job_.program.dialect != "linuxcnc") return;
    std::size_t a = m;
    while (a > 0 && is_known(moves[a - 1]) && stays_in_plane(moves[a - 1])) --a;
    if (a == 0 || !is_known(moves[a - 1])) return;
    const ContourWay way = way_of(a - 1, first.side);
    if ((way.curve.end - first.curve.start).norm() < same_place_mm) ways_.push_back(way);
  }

  // Ends the contour at a corner of unknown size, and at one that is larger than its sides.
  void put_corner_before(ContourWay& way) {
    const CornerEnds& corner = *job_.program.moves[ways_.back().move].corners;
    if (corner.end_mm == 0) return;
    if (corner.end_mm < std::min(length(ways_.back().curve), length(way.curve)))
      put_corner(corner.end_size, ways_, way);
    else
      finish();
  }

  void finish() {
    constexpr double noticed_mm = 0.01;
    if (is_divided_) {
      const ContourRadius programmed = largest_radius(ways_, false), written = largest_radius(ways_, true);
      const Move& move = job_.program.moves[ways_[written.way].move];
      if (written.mm < programmed.mm - noticed_mm)
        found_.push_back({move.line, move.tool, programmed.mm, written.mm,
                          cutter_diameter_mm(job_.program, ways_.back().move)});
    }
    ways_.clear();
    is_divided_ = false;
  }

  const Job& job_;
  const std::vector<MoveEdit>& edits_;
  std::vector<ContourWay> ways_;
  bool is_divided_ = false;
  std::vector<NarrowedContour> found_;
};

}  // namespace

bool is_inner_corner(const Curve& before, const Curve& after, CutterSide side) {
  const double turn = direction_at(before, 1).cross(direction_at(after, 0)).z();
  return (side == CutterSide::left ? turn : -turn) > tangent;
}

ContourRadius largest_radius(const std::vector<ContourWay>& ways, bool by_pieces) {
  ContourRadius least{largest_tool_radius_mm, 0};
  const auto has_corner = [&](std::size_t i) {  // behind way i
    return i + 1 < ways.size() && is_inner_corner(ways[i].curve, ways[i + 1].curve, ways[i].side);
  };
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const ContourWay& way = ways[i];
    const double length_mm = length(way.curve);
    CornerSide begin, end;
    if (i > 0 && has_corner(i - 1)) begin = {&way, &ways[i - 1], false};
    if (has_corner(i)) end = {&way, &ways[i + 1], true};
    double radius = is_inner_arc(way) ? radius_of(way) : largest_tool_radius_mm;
    if (by_pieces && way.is_divided)
      radius = std::min({radius, radius_within(begin, way.first_mm), radius_within(end, way.last_mm)});
    else if (std::min(radius_within(begin, length_mm / 2), radius_within(end, length_mm / 2)) < least.mm)
      radius = std::min(radius, radius_of_whole(begin, end, length_mm));
    if (radius < least.mm) least = {radius, i};
  }
  return least;
}

std::vector<NarrowedContour> narrowed_contours(const Job& job, const std::vector<MoveEdit>& edits) {
  return ContourReader(job, edits).run();
}

}  // namespace counterflex
