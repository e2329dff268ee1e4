// Contour groups under G41 or G42: one rigid motion, so that the operator's offsets of the tool still work.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/emit/emitter.hpp"
#include "compensation/shift/commands.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

namespace {

bool is_in_plane(const Move& move) {
  return move.words[0] || move.words[1] || move.arc;
}

// Where a contour should move to: program coordinates (mm).
struct GroupSample {
  Vector3 p, shift;
};

// What a turn about Z adds to `v`.
Vector3 turned(double turn, const Vector3& v) {
  return turn == 0 ? Vector3::Zero() : Vector3(exp_so3(turn * Vector3::UnitZ()) * v - v);
}

// Sets the shift: per axis the midpoint of the extremes of what the turn leaves. Returns half of the way
// between these.
Vector3 choose_shift(const std::vector<GroupSample>& samples, GroupMotion& motion) {
  Vector3 low = Vector3::Constant(HUGE_VAL), high = -low;
  for (const GroupSample& sample : samples) {
    const Vector3 left = sample.shift - turned(motion.turn, sample.p - motion.about);
    low = low.cwiseMin(left);
    high = high.cwiseMax(left);
  }
  motion.shift = (low + high) / 2;
  return (high - low) / 2;
}

// The largest distance that the motion leaves (mm); in the plane alone where Z is corrected block by block.
double largest_left(const std::vector<GroupSample>& samples, const GroupMotion& motion, bool in_xy) {
  double largest = 0;
  for (const GroupSample& sample : samples) {
    Vector3 left = sample.shift - motion.shift_at(sample.p);
    if (in_xy) left.z() = 0;
    largest = std::max(largest, left.norm());
  }
  return largest;
}

// Turns by the least squares of what is left, about the middle of the samples.
GroupMotion best_turn(const std::vector<GroupSample>& samples) {
  Vector3 p = Vector3::Zero(), shift = Vector3::Zero();
  for (const GroupSample& sample : samples) p += sample.p, shift += sample.shift;
  p /= static_cast<double>(samples.size());
  shift /= static_cast<double>(samples.size());
  double along = 0, square = 0;
  for (const GroupSample& sample : samples) {
    const Vector3 d = sample.p - p, across(-d.y(), d.x(), 0);
    along += across.dot(sample.shift - shift);
    square += across.squaredNorm();
  }
  return {.about = p, .turn = square > 0 ? std::atan2(along, square) : 0};
}

// The largest miss of straight lines between every `stride`th node.
double miss_between(const std::vector<double>& heights, std::size_t stride) {
  double miss = 0;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    const std::size_t begin = std::min(k / stride * stride, heights.size() - 1 - stride);
    const double share = static_cast<double>(k - begin) / static_cast<double>(stride);
    miss =
        std::max(miss, std::abs(heights[k] - (1 - share) * heights[begin] - share * heights[begin + stride]));
  }
  return miss;
}

double middle_of(const std::vector<double>& heights, std::size_t first, std::size_t stride) {
  const auto [low, high] = std::minmax_element(heights.begin() + first, heights.begin() + first + stride + 1);
  return (*low + *high) / 2;
}

// The largest distance of the heights between every `stride`th node from their middle.
double half_range(const std::vector<double>& heights, std::size_t stride) {
  double range = 0;
  for (std::size_t k = 0; k + stride < heights.size(); k += stride)
    for (std::size_t i = k; i <= k + stride; ++i)
      range = std::max(range, std::abs(heights[i] - middle_of(heights, k, stride)));
  return range;
}

}  // namespace

// Whether the contour lies in X Y: a move beside it has a side of the cutter only there. Z does not touch the
// radius of the cutter, and is corrected block by block.
bool Emitter::is_in_xy(std::size_t m) const {
  const auto& moves = job_.program.moves;
  bool has_side = false;
  for (const int group = moves[m].group; m < moves.size() && moves[m].group == group; ++m) {
    if (moves[m].arc && moves[m].arc->normal != 2) return false;
    has_side = has_side || moves[m].cutter_side != CutterSide::none;
  }
  return has_side;
}

// A turned contour is the same contour for the control: it keeps its distance to it. Every end in the plane
// must be known and written, in words of X and Y.
bool Emitter::group_may_turn(std::size_t m) const {
  const auto& moves = job_.program.moves;
  for (const int group = moves[m].group; m < moves.size() && moves[m].group == group; ++m) {
    const Move& move = moves[m];
    if (!is_in_plane(move)) continue;
    for (const std::size_t axis : {0, 1})
      if (!move.known_end[axis] || !(move.words[axis] || may_insert_word(move, axis))) return false;
    if (move.polar || move.cycle) return false;
  }
  return group_in_xy_;
}

Vector3 GroupMotion::shift_at(const Vector3& p_mm) const {
  return shift + turned(turn, p_mm - about);
}

// An arc stays an arc: its centre goes along.
Vector3 Emitter::shifted_centre(const Move& move, const Vector3& shift) const {
  const bool turns = move.group != 0 && move.group == state_.group && group_motion_;
  return move.arc->centre_mm + shift +
         turned(turns ? group_motion_->turn : 0, move.arc->centre_mm - move.end_mm);
}

// The contour is corrected and judged where it is programmed. The tool's centre is beside it, by a radius
// that the control knows, where the correction is another one. By how much it changes there beyond the motion
// of the group, for the segments `begin` to `end`; empty if that is little for the radius that the program
// states, or for each usual one.
std::string Emitter::words_beside(std::size_t begin, std::size_t end) {
  constexpr double unit_radius_mm = 10, most_radius_mm = 50;
  struct PlaceBeside {
    std::size_t segment;
    const CurveNode* node;
    std::optional<double> radius_mm;  // that the program states
  };
  std::vector<TargetRequest> requests;
  std::vector<PlaceBeside> places;
  ForceCursor cursor;
  for (std::size_t s = begin; s < end; ++s) {
    const Segment& segment = job_.path.segments[s];
    const std::vector<CurveNode>& nodes = plan_.segments[s].group;
    const bool is_beside = job_.program.moves[segment.move].cutter_side != CutterSide::none;
    if (!segment.cutting || !is_beside || nodes.empty()) continue;
    std::optional<double> radius_mm = cutter_diameter_mm(job_.program, segment.move);
    if (radius_mm) *radius_mm /= 2;
    const double beside_mm = radius_mm.value_or(unit_radius_mm);
    for (const CurveNode* node : {&nodes.front(), &nodes[nodes.size() / 2], &nodes.back()}) {
      const Side side = node == &nodes.back() ? Side::before : Side::after;
      const Vector3 p =
          point_at(segment.wanted, node->u) + beside_mm * mm * away_from_contour(job_, s, node->u);
      requests.push_back({&model_of(job_, segment), p, job_.forces.at(s, node->u, side, cursor),
                          orientation_at(segment, node->u),
                          directions_at(job_, segment.move, node->u, side)});
      places.push_back({s, node, radius_mm});
    }
  }
  std::vector<TargetAnswer> answers(requests.size());
  solver_.targets(requests, answers, StopAt::end);
  double usual_mm = 0, stated_mm = 0, stated_radius_mm = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [s, node, radius_mm] = places[i];
    const Move& move = job_.program.moves[job_.path.segments[s].move];
    if (answers[i].status != Status::converged) continue;
    const Vector3 beside = radius_mm.value_or(unit_radius_mm) * frame(move).X_MW.R.transpose() *
                           away_from_contour(job_, s, node->u);
    const Vector3 change =
        shift_mm(move, answers[i].target - requests[i].p_MT) - shift_mm(move, shift_of(node->c));
    const double miss_mm = (change - turned(group_motion_->turn, beside)).norm();
    if (!radius_mm)
      usual_mm = std::max(usual_mm, miss_mm);
    else if (miss_mm > stated_mm)
      stated_mm = miss_mm, stated_radius_mm = *radius_mm;
  }
  std::string words;
  if (stated_mm * mm > small_share * job_.options.tolerance)
    words =
        fmt::format("; the tool's centre is {:g} mm beside the contour and misses by up to {:.4f} mm more",
                    stated_radius_mm, stated_mm);
  if (usual_mm * most_radius_mm / unit_radius_mm * mm > job_.options.tolerance)
    words += fmt::format(
        "; with the tool's radius in D the tool's centre misses by up to {:.4f} mm more for each {:g} mm of "
        "the radius",
        usual_mm, unit_radius_mm);
  return words;
}

// One shift, and one turn about Z where that leaves less than half as much; nothing where no move of the
// group has a known start and end. What it leaves is listed.
bool Emitter::find_group_motion(std::size_t m, std::size_t s) {
  const Move& first = job_.program.moves[m];
  const std::size_t first_segment = s;
  // Samples beside the contour count for the motion only without a cut.
  std::vector<GroupSample> cuts, others, feeds;
  int last_line = first.line;
  for (; s < job_.path.segments.size(); ++s) {
    const Segment& segment = job_.path.segments[s];
    const Move& move = job_.program.moves[segment.move];
    if (move.group != first.group) break;
    last_line = move.line;
    std::vector<GroupSample>& samples = segment.cutting && is_in_plane(move) ? cuts : others;
    for (const CurveNode& node : plan_.segments[s].group) {
      samples.push_back(
          {in_words_mm(job_, move, original_command(job_, segment.frame, point_at(segment.wanted, node.u))),
           shift_mm(move, shift_of(node.c))});
      if (segment.cutting) feeds.push_back(samples.back());
    }
  }
  group_motion_.reset();
  const std::vector<GroupSample>& samples = cuts.empty() ? others : cuts;
  if (samples.empty()) return false;
  GroupMotion motion;
  Vector3 residual = choose_shift(samples, motion);
  if (residual.head<2>().norm() * mm > small_share * job_.options.tolerance && group_may_turn(m)) {
    GroupMotion with_turn = best_turn(samples);
    const Vector3 left = choose_shift(samples, with_turn);
    if (2 * left.head<2>().norm() < residual.head<2>().norm()) motion = with_turn, residual = left;
  }
  group_motion_ = motion;
  const Vector3& shift = motion.shift;
  if (group_in_xy_) residual.z() = 0;
  const auto mm4 = [](double length_mm) { return format_fixed(length_mm, 4); };
  std::string motion_words =
      group_in_xy_ ? fmt::format("({}, {}) mm in X and Y", mm4(shift.x()), mm4(shift.y()))
                   : fmt::format("({}, {}, {}) mm", mm4(shift.x()), mm4(shift.y()), mm4(shift.z()));
  if (motion.turn != 0)
    motion_words += fmt::format(" and one turn by {:.4f} deg about X{} Y{}", motion.turn / deg,
                                format_fixed(motion.about.x(), 3), format_fixed(motion.about.y(), 3));
  motion_words += group_in_xy_ ? " for all, Z block by block" : " for all";
  list(first, fmt::format("contour group of lines {} to {}: one shift of {}; what remains of its corrections "
                          "is up to {:.4f} mm{}",
                          first.line, last_line, motion_words,
                          std::max(residual.norm(), largest_left(feeds, motion, group_in_xy_)),
                          words_beside(first_segment, s)));
  return true;
}

// The group's first move has to make the step: nothing may be inserted after it.
void Emitter::check_step(const Move& move, const Vector3& before_mm) {
  const Vector3 after_mm = shift_mm(move, state_.correction);
  const bool in_plane = is_in_plane(move);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = after_mm[axis] - before_mm[axis];
    const bool flat = move.arc && move.arc->flat && static_cast<int>(axis) == move.arc->normal;
    const bool writes = move.words[axis] || (in_plane && may_insert_word(move, axis) && !flat);
    if (!move.known_end[axis] || writes || rounds_to_nothing(move, axis, step)) continue;
    return refuse(
        move, fmt::format("the shift of this contour group differs by {:.4f} mm in {} from the correction "
                          "before it, and the block takes no {} word",
                          step, "XYZ"[axis], "XYZ"[axis]));
  }
}

// The shift at the end of a move of the group. In Z that of one that stays or comes from an unknown position
// is the one where the next begins; `height` where Z goes with the group.
Vector3 Emitter::group_shift_mm(const Move& move, Index s, double height) const {
  Vector3 shift = group_motion_->shift_at(move.end_mm);
  shift.z() = height;
  const std::size_t next = s.value_or(next_segment_);
  const bool known = next < plan_.segments.size() && !plan_.segments[next].group.empty() &&
                     job_.program.moves[job_.path.segments[next].move].group == move.group;
  if (!group_in_xy_ || !known) return shift;
  const std::vector<CurveNode>& nodes = plan_.segments[next].group;
  shift.z() = shift_mm(move, shift_of(s ? nodes.back().c : nodes.front().c)).z();
  return shift;
}

// The height of a contour's arc need not change in proportion to its angle, and a flat arc has one height: it
// is divided into 2, 4 or 8 arcs then, which are one in the plane. Lines along Z lead to those that are flat.
void Emitter::divide_by_height(const Move& move, std::size_t s, MoveEdit& edit) const {
  const std::vector<CurveNode>& nodes = plan_.segments[s].group;
  if (!move.may_split || !group_in_xy_ || nodes.size() < 3 || move.arc->turns > 0) return;
  const bool flat = stays_flat(move);
  std::vector<double> heights;
  for (const CurveNode& node : nodes) heights.push_back(shift_mm(move, shift_of(node.c)).z());
  const double room_mm = height_share * job_.options.tolerance / mm;
  std::size_t stride = nodes.size() - 1;
  while (stride > 1 && (flat ? half_range(heights, stride) : miss_between(heights, stride)) > room_mm)
    stride /= 2;
  const Curve curve = curve_of(move);
  const auto place = [&](std::size_t k, double height) {
    const Vector3 p = point_at(curve, nodes[k].u);
    Vector3 shift = group_motion_->shift_at(p);
    shift.z() = height;
    return Vector3(p + shift);
  };
  const Vector3 centre = shifted_centre(move, group_motion_->shift_at(move.end_mm));
  for (std::size_t k = 0; k + 1 < nodes.size(); k += stride) {
    const double middle = flat ? middle_of(heights, k, stride) : heights[k + stride];
    if (flat && stride + 1 < nodes.size()) edit.inserted.push_back({place(k, middle)});
    if (k + stride + 1 < nodes.size()) edit.inserted.push_back({place(k + stride, middle), centre});
    edit.end_mm.z() = place(k + stride, middle).z();
  }
}

bool Emitter::begin_group(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  state_.group = move.group;
  group_in_xy_ = is_in_xy(m);
  if (!find_group_motion(m, s.value_or(next_segment_))) return state_.correction_known;
  leave_far_pending_alone(move);
  const Vector3 before_mm = held_shift_mm(move);
  hold(correction_of(move, group_shift_mm(move, s, group_motion_->shift.z())));
  check_step(move, before_mm);
  give_to_pending();
  return true;
}

void Emitter::emit_group(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  if (move.group != state_.group && !begin_group(m, s)) return pending_.push_back(m);
  if (out_.failure) return;
  if (group_motion_)
    state_.correction = correction_of(move, group_shift_mm(move, s, held_shift_mm(move).z()));
  emit_rigid(m, s);
}

}  // namespace counterflex
