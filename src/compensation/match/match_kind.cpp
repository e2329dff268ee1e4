// Whether matched moves go as the original: rapid, line or arc, in its plane, sense and number of turns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compensation/match/match.hpp"
#include "compensation/plan/places.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/failures.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr double sweep_room = std::numbers::pi / 2;  // less than any difference of turns or of sense

const char* name_of(const Move& move) {
  if (move.cycle) return "a hole of a cycle";
  if (move.motion == Motion::rapid) return "a rapid";
  return move.arc ? "an arc" : "a line";
}

const char* plane_of(const ArcMove& arc) {
  return arc.normal == 2 ? "X Y" : arc.normal == 1 ? "Z X" : "Y Z";
}

double in_plane(const Vector3& v, int normal) {
  return (v - v[normal] * Vector3::Unit(normal)).norm();
}

// In the plane of the arc, which is any plane if it goes through a point.
double in_plane(const Vector3& v, const ArcMove& arc) {
  const Vector3 normal = normal_of(arc);
  return (v - v.dot(normal) * normal).norm();
}

// How the arc lies and turns otherwise than `wanted`; empty if it does not. A correction may tilt the plane
// of three points: the path of such an arc is judged by its places.
std::string difference_of_planes(const ArcMove& arc, const ArcMove& wanted) {
  if (arc.through && wanted.through) {
    const double cosine = std::clamp(normal_of(arc).dot(normal_of(wanted)), -1.0, 1.0);
    if (cosine > 0) return {};
    return fmt::format(
        "the axis of this arc is {:.1f} degrees off that of the original, less than 90 are allowed",
        std::acos(cosine) / deg);
  }
  if (arc.normal != wanted.normal)
    return fmt::format("this arc lies in the plane {}, that of the original in {}", plane_of(arc),
                       plane_of(wanted));
  if (arc.clockwise == wanted.clockwise) return {};
  return fmt::format("this arc goes {}, that of the original {}",
                     arc.clockwise ? "clockwise" : "counter-clockwise",
                     wanted.clockwise ? "clockwise" : "counter-clockwise");
}

// By how much the correction leaves the straight line between those at its ends, at eighths of an arc (m).
double bend_of(const PlannedSegment& planned) {
  if (planned.arc.empty()) return 0;
  const auto shift_at = [&](double u) {
    const auto later =
        std::ranges::find_if(planned.arc, [&](const auto& stretch) { return stretch.end() > u; });
    return shift_of((later != planned.arc.end() ? *later : planned.arc.back()).at(u));
  };
  const Vector3 first = shift_at(0), last = shift_at(1);
  double largest = 0;
  for (int k = 1; k < eighths; ++k) {
    const double u = static_cast<double>(k) / eighths;
    largest = std::max(largest, (shift_at(u) - (1 - u) * first - u * last).norm());
  }
  return largest;
}

// Compares the moves that command one move of the original.
class KindComparison {
 public:
  KindComparison(const Job& job, const Plan& plan, const MatchedMoves& matched)
      : job_(job), plan_(plan), matched_(matched) {}

  std::optional<Failure> run() {
    for (std::size_t i = 0; i < matched_.found.size() && !failure_; ++i) compare(i);
    if (original_.arc && !failure_) compare_sweeps();
    const Move& last = matched_.last();
    if (!failure_) compare_known(last);
    if (!matched_.segment && !failure_) compare_unjudged(last);
    if (!failure_) compare_shifts(last);
    if (original_.cycle && last.cycle && !failure_) compare_cycle(last);
    if (failure_ && is_lost_behind_piece()) fail_lost_piece();
    return std::move(failure_);
  }

 private:
  void fail(const Move& found, std::string what) {
    failure_ = matched_.failure_at(found.line, std::move(what));
  }

  // Behind a block that '/' may skip its axes are unknown: a piece is known only from words of its own.
  bool is_lost_behind_piece() const {
    if (!original_.block_delete || !all_known(original_.known_start)) return false;
    return std::any_of(matched_.found.begin() + 1, matched_.found.end(), [](const auto& piece) {
      return !all_known(piece.move->known_start) || !all_known(piece.move->known_end);
    });
  }

  void fail_lost_piece() {
    fail(matched_.last(),
         "this block with '/' is divided: behind its first piece the position is unknown, and the other "
         "pieces cannot be verified; remove '/', or give a larger --tolerance-mm");
  }

  void compare(std::size_t i) {
    const Move& found = *matched_.found[i].move;
    const bool last = i + 1 == matched_.found.size();
    const bool jump = i == 0 && !last && !found.arc && found.motion == Motion::feed;
    const bool same_motion = found.motion == original_.motion && !found.cycle == !original_.cycle;
    if (jump) compare_jump(found);
    if (jump && (!same_motion || !original_.arc)) return;  // what follows it is judged from its end on
    if (!same_motion || (found.arc && !original_.arc)) return fail_kind(found);
    if (!original_.arc) return;
    if (!found.arc) return compare_chord(found, jump);
    const std::string difference = difference_of_planes(*found.arc, *original_.arc);
    if (!difference.empty()) return fail(found, difference);
    if (matched_.found.size() == 1)
      compare_one_arc(found);
    else if (original_.handling == Handling::group)
      compare_contour_piece(found);
    add_sweep(found);
  }

  // About the centre where the correction at the start puts it, and where the first piece puts it if that is
  // a jump to another correction. An arc turns about its own centre: the correction may change along it by as
  // much as the radius of a small one.
  void add_sweep(const Move& found) {
    const Move& first = matched_.first();
    if (!all_known(original_.known_start) || !all_known(first.known_start)) return;
    const Curve curve = curve_of(found);
    const auto angle_from = [&](const Vector3& start_mm) {
      Arc axis = *curve_of(original_).arc;
      axis.centre += start_mm - original_.start_mm;
      return curve.arc ? curve.arc->sweep : angle_about(axis, curve);
    };
    sweep_ += angle_from(first.start_mm);
    if (&found != &first) sweep_behind_jump_ += angle_from(first.end_mm);
  }

  void fail_kind(const Move& found) {
    fail(found,
         fmt::format("this block is {}, that of the original is {}", name_of(found), name_of(original_)));
  }

  double radius_mm() const { return in_plane(original_.end_mm - original_.arc->centre_mm, *original_.arc); }

  // A contour's arc that is divided by its height is one arc in the plane.
  void compare_contour_piece(const Move& found) {
    const ArcMove &wanted = *original_.arc, &arc = *found.arc;
    // A centre that follows from the ends and a radius is known less well than these; the angles are compared
    // besides.
    if (wanted.radius_word && arc.radius_word) {
      const double miss = std::abs(std::abs(arc.radius_mm) - std::abs(wanted.radius_mm));
      if (miss > roundings * rounding_mm_ + 1e-6)
        fail(found, fmt::format("the radius of this arc is off by {:.4f} mm", miss));
      return;
    }
    if (!centre_mm_) centre_mm_ = arc.centre_mm;
    const auto radius_at = [](const ArcMove& a, const Vector3& p) {
      return in_plane(p - a.centre_mm, a.normal);
    };
    const double low = std::min(radius_at(wanted, original_.start_mm), radius_at(wanted, original_.end_mm)),
                 high = std::max(radius_at(wanted, original_.start_mm), radius_at(wanted, original_.end_mm)),
                 room = roundings * rounding_mm_ + 1e-6;
    double miss = in_plane(arc.centre_mm - *centre_mm_, wanted.normal);
    for (const double radius : {radius_at(arc, found.start_mm), radius_at(arc, found.end_mm)})
      miss = std::max({miss, low - radius, radius - high});
    if (miss > room)
      fail(found,
           fmt::format("this piece of an arc of a contour leaves the circle of the original by {:.4f} mm",
                       miss));
  }

  // A chord may replace a part of the arc from which it keeps within the tolerance.
  void compare_chord(const Move& found, bool may_be_jump) {
    const double radius = radius_mm(), chord = in_plane(found.end_mm - found.start_mm, *original_.arc);
    const double half = std::asin(std::min(1.0, chord / 2 / radius)), sagitta = radius * (1 - std::cos(half));
    const double room = tolerance_mm_ + roundings * rounding_mm_;
    const bool known = all_known(found.known_start) && all_known(original_.known_start);
    if (original_.handling == Handling::group && known && chord > roundings * rounding_mm_ + 1e-6)
      return fail_kind(found);
    if (may_be_jump && chord <= 2 * most_shift_mm_ && sagitta <= room) {
      may_begin_with_jump_ = true;
      return add_sweep(found);
    }
    if (!known || (sagitta > room && matched_.found.size() == 1)) return fail_kind(found);
    const bool judged = matched_.segment && original_.handling == Handling::own && original_.may_split;
    if (sagitta > room && !judged)
      return fail(
          found, fmt::format("this chord leaves the arc of the original by {} mm, the tolerance is {:.6g} mm",
                             format_beside(sagitta, tolerance_mm_, 4), tolerance_mm_));
    add_sweep(found);
  }

  // An arc that is only shifted keeps its centre relative to its start, and its radius.
  void compare_one_arc(const Move& found) {
    const ArcMove &wanted = *original_.arc, &arc = *found.arc;
    const double room = roundings * rounding_mm_ + 1e-6;
    if (arc.turns != wanted.turns)
      return fail(found, fmt::format("this arc makes {} full turns more than the way to its end, that of the "
                                     "original {}",
                                     arc.turns, wanted.turns));
    const bool rigid = original_.handling != Handling::own || !all_known(original_.known_start);
    if (!rigid) return compare_middle(found);
    const Vector3 from = wanted.absolute_centre ? original_.end_mm : original_.start_mm,
                  found_from = arc.absolute_centre ? found.end_mm : found.start_mm;
    const Vector3 centre = arc.centre_mm - found_from, wanted_centre = wanted.centre_mm - from;
    const bool by_radius = wanted.radius_word && arc.radius_word;
    double miss = in_plane(centre - wanted_centre, wanted.normal);
    if (by_radius) miss = std::abs(arc.radius_mm - wanted.radius_mm);
    // A contour may turn.
    if (!by_radius && original_.handling == Handling::group)
      miss = std::abs(in_plane(centre, wanted.normal) - in_plane(wanted_centre, wanted.normal));
    if (miss > room)
      fail(found,
           fmt::format("the {} of this arc is off by {:.4f} mm", by_radius ? "radius" : "centre", miss));
  }

  // The inside of an arc that is not split is not judged by its deviation. It is shifted as its ends are, and
  // by what the correction bends between them: the best arc is beside both by at most that.
  void compare_middle(const Move& found) {
    if (original_.may_split || !arc_has_point(found)) return;
    const Vector3 at_start = found.start_mm - original_.start_mm, at_end = found.end_mm - original_.end_mm;
    const Vector3 shift = point_at(curve_of(found), 0.5) - point_at(curve_of(original_), 0.5);
    const double off = (shift - (at_start + at_end) / 2).norm();
    const double bend_mm = matched_.segment ? bend_of(plan_.segments[*matched_.segment]) / mm : 0;
    const double room = (at_end - at_start).norm() + 2 * bend_mm + tolerance_mm_ + roundings * rounding_mm_;
    if (off > room)
      fail(found,
           fmt::format("the middle of this arc is off by {:.4f} mm, between its ends {:.4f} mm are allowed",
                       off, room));
  }

  bool arc_has_point(const Move& found) const {
    return found.arc->through && original_.arc->through && all_known(found.known_start);
  }

  void compare_sweeps() {
    const Move& found = matched_.last();
    if (!all_known(original_.known_start) || !all_known(found.known_start)) return;
    const double wanted = curve_of(original_).arc->sweep;
    double off = std::abs(sweep_ - wanted);
    if (may_begin_with_jump_) off = std::min(off, std::abs(sweep_behind_jump_ - wanted));
    if (off <= sweep_room || off * radius_mm() <= roundings * tolerance_mm_) return;
    fail(found, fmt::format("the arcs up to here turn by {:.1f} degrees, the arc of the original by {:.1f}",
                            sweep_ / deg, wanted / deg));
  }

  // A place that the original states is stated.
  void compare_known(const Move& found) {
    for (std::size_t axis = 0; axis < 3 && !failure_; ++axis)
      if (original_.known_end[axis] && !found.known_end[axis])
        fail(found, fmt::format("the position in {} is not known here: no move before has a word for it",
                                "XYZ"[axis]));
  }

  // Moves that give no segment keep a correction: what stays where it is does so in both programs.
  void compare_unjudged(const Move& found) {
    const bool known = all_known(original_.known_start) && all_known(original_.known_end);
    const bool steps = original_.handling == Handling::group;  // to the shift of its contour
    if (!known || original_.cycle || steps || !all_known(found.known_start)) return;
    if (original_.orientation && found.orientation) {
      const Turn turn = turn_of(*found.orientation), wanted = turn_of(*original_.orientation);
      const double angle = rotation_between(turn.end, turn.start).norm();
      if (angle > job_.options.tilt_tolerance + rotation_between(wanted.end, wanted.start).norm())
        return fail(found,
                    fmt::format("this move turns the tool by {:.4f} degrees, that of the original does not",
                                angle / deg));
    }
    const double way = (found.end_mm - found.start_mm).norm();
    if (way > tolerance_mm_ + roundings * rounding_mm_)
      fail(found, fmt::format("this move goes {:.4f} mm, that of the original stays where it is", way));
  }

  // Before a move that is not split only a correction is inserted, where the move begins.
  void compare_jump(const Move& found) {
    const bool is_split = original_.may_split || changes_height_inside(original_);
    if (is_split || !all_known(original_.known_start)) return;
    for (Eigen::Index axis = 0; axis < 3 && !failure_; ++axis)
      compare_shift(found, fmt::format("{} at the start", "XYZ"[axis]),
                    found.end_mm[axis] - original_.start_mm[axis]);
  }

  // No word is shifted by more than the limit of corrections.
  void compare_shifts(const Move& found) {
    const Vector3& start = matched_.first().start_mm;
    for (std::size_t axis = 0; axis < 3 && !failure_; ++axis) {
      if (!original_.words[axis] || !found.words[axis] || original_.fixed[axis]) continue;
      double shift = found.end_mm[axis] - original_.end_mm[axis];
      if (is_relative(original_, axis) && is_relative(found, axis))
        shift -= start[axis] - original_.start_mm[axis];
      compare_shift(found, std::string(1, "XYZ"[axis]), shift);
    }
  }

  // Depth and retract plane, also where an earlier hole has given them. Words of one block are shifted alike.
  void compare_cycle(const Move& found) {
    const CycleMove &wanted = *original_.cycle, &cycle = *found.cycle;
    const double bottom = cycle.bottom_mm - wanted.bottom_mm, retract = cycle.retract_mm - wanted.retract_mm;
    if (wanted.retract_word && !cycle.retract_word)
      return fail(found, "the R of the original's hole is missing");
    compare_shift(found, "the bottom of the hole", bottom);
    if (!failure_) compare_shift(found, "the retract plane R", retract);
    const bool added = cycle.retract_word && !wanted.retract_word,
               both = added || (wanted.retract_word && wanted.bottom_word && cycle.bottom_word);
    const bool chooses = chooses_height_by_retract(job_.program, original_) && found.known_start[2];
    if (!failure_ && chooses) compare_height_of_way(found);
    double height = found.start_mm.z();
    if (leaves_at_high_retract(original_)) height = std::max(height, cycle.initial_mm);
    const bool raised = found.known_start[2] && keeps_retract_above_tool(job_.program, original_) &&
                        cycle.retract_mm - height <= roundings * rounding_mm_;
    if (!failure_ && both && !raised && std::abs(retract - bottom) > tolerance_mm_ + roundings * rounding_mm_)
      fail(found,
           fmt::format("the retract plane R is shifted by {:.4f} mm, the bottom of the hole by {:.4f} mm",
                       retract, bottom));
  }

  static bool is_above_tool(const Move& hole) { return hole.cycle->retract_mm >= hole.start_mm.z(); }

  // Both go to the hole at the height where the series began, or at that of the tool.
  void compare_height_of_way(const Move& found) {
    if (is_above_tool(found) == is_above_tool(original_)) return;
    fail(found,
         fmt::format("R{:.4f} is {} the tool, which is at Z{:.4f}, that of the original is {} it: LinuxCNC "
                     "goes to this hole at another height; write R{:.4f} or {}",
                     found.cycle->retract_mm, is_above_tool(found) ? "not below" : "below",
                     found.start_mm.z(), is_above_tool(found) ? "below" : "not below", found.start_mm.z(),
                     is_above_tool(found) ? "less" : "more"));
  }

  void compare_shift(const Move& found, const std::string& what, double shift) {
    if (std::abs(shift) > most_shift_mm_ + roundings * rounding_mm_)
      fail(found, fmt::format("{} is shifted by {:.4f} mm, the limit of a correction is {:.4f} mm", what,
                              shift, most_shift_mm_));
  }

  const Job& job_;
  const Plan& plan_;
  const MatchedMoves& matched_;
  const Move& original_ = matched_.original;
  const double rounding_mm_ = rounding_allowance(original_, job_.options.write) / mm;
  const double tolerance_mm_ = job_.options.tolerance / mm;
  const double most_shift_mm_ =
      (job_.options.max_correction + job_.path.frames[original_.frame].datum_shift.norm()) / mm;
  std::optional<Vector3> centre_mm_{};  // of the first piece of a contour's arc
  double sweep_ = 0;                    // of the arcs and chords so far
  double sweep_behind_jump_ = 0;        // the same, if the first is a jump
  bool may_begin_with_jump_ = false;
  std::optional<Failure> failure_;
};

}  // namespace

std::optional<Failure> kind_failure(const Job& job, const Plan& plan, const MatchedMoves& matched) {
  return KindComparison(job, plan, matched).run();
}

}  // namespace counterflex
