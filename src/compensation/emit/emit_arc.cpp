// Arcs: one where it is good enough, else several, and chords of the corrected curve only where no arc fits.
#include <algorithm>
#include <cmath>

#include "compensation/emit/emitter.hpp"
#include "compensation/solve/failures.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
void Emitter::emit_arc(const Segment& segment, const PlannedSegment& planned, MoveEdit& edit,
                       UnsplitMiss& miss) {
  const Move& move = job_.program.moves[segment.move];
  if (!move.may_split) return put_one_arc(arc_task(segment, planned, planned.arc.front()), edit, miss);
  for (const CorrectionCurve& stretch : planned.arc) {
    const ArcTask task = arc_task(segment, planned, stretch);
    if (const double begin = stretch.begin(); begin > 0) {  // a step of the force
      const Via step = via_of(move, command_at(job_, segment, begin, stretch.at(begin)), begin);
      go_through(move, step, piece_held_);
      edit.inserted.push_back(step);
    }
    ArcPieces pieces = divide_arc(task, piece_held_);
    if (pieces.lack_digits) {
      out_.failure = few_decimals_failure(move, job_.options);
      return;
    }
    piece_held_ = pieces.held;
    if (task.end == 1) {
      edit.centre_mm = pieces.vias.back().centre_mm;
      pieces.vias.pop_back();
    }
    edit.inserted.insert(edit.inserted.end(), pieces.vias.begin(), pieces.vias.end());
  }
}

// `stretch`: of the correction, without a step of the force; borrowed, as are `segment` and the job. The move
// begins with the orientation that the text holds.
ArcTask Emitter::arc_task(const Segment& segment, const PlannedSegment& planned,
                          const CorrectionCurve& stretch) const {
  const Move& move = job_.program.moves[segment.move];
  return {.move = move,
          .options = job_.options.write,
          .source = curve_of(move),
          .commanded =
              [&job = job_, &move, &segment, &stretch](double u) {
                return in_words_mm(job, move, command_at(job, segment, u, stretch.at(u)).target);
              },
          .turned =
              [&job = job_, &move, &segment, &stretch, start = start_turn_, end = end_turn_](double u) {
                const Vector3 inside = command_at(job, segment, u, stretch.at(u)).turn;
                return *turned_words(job, move, u, u == 0 ? start : u == 1 ? end : inside);
              },
          .begin = stretch.begin(),
          .end = stretch.end(),
          .corners = job_.forces.breaks(index_of(segment)),
          .waves = may_wave(model_of(job_, segment).mechanism) ? stretch.nodes() : std::vector<double>{},
          .tolerance_mm = (1 - curve_share) * job_.options.tolerance / planned.gain / mm,
          .chord_room_mm = room_between_points(job_, segment, planned.gain).value_or(0) / mm};
}

namespace {

/// The numbers of the orientation at the end of `task` with `share` of its turn about other axes than
/// `normal`.
OrientationNumbers end_with_share(const ArcTask& task, const Vector3& normal, double share) {
  const OrientationForm form = task.move.orientation->form;
  const OrientationNumbers end = task.turned(1);
  const Matrix3 R_start = rotation_of(form, task.turned(0));
  const Vector3 phi = rotation_between(rotation_of(form, end), R_start);
  const Vector3 about_normal = phi.dot(normal) * normal;
  return numbers_of(form, exp_so3(about_normal + share * (phi - about_normal)) * R_start, end);
}

/// The end of a whole arc with as much of its turn about other axes as the control allows; empty if it allows
/// the arc with none.
std::optional<OrientationNumbers> allowed_end(const ArcTask& task, const ArcPiece& whole, const Curve& read) {
  constexpr int halvings = 10;
  const auto end_at = [&](double share) { return end_with_share(task, read.arc->normal, share); };
  const auto is_allowed = [&](double share) {
    ArcTask other = task;
    other.turned = [start = task.turned(0), end = end_at(share)](double u) { return u == 0 ? start : end; };
    return keeps_turn_limits(other, whole, read);
  };
  if (!is_allowed(0)) return std::nullopt;
  double share = 0;
  for (double step = 0.5; step > std::ldexp(1.0, -halvings); step /= 2)
    if (is_allowed(share + step)) share += step;
  return end_at(share);
}

}  // namespace

// Under exact stop: the best single arc there is, and what it misses.
void Emitter::put_one_arc(const ArcTask& task, MoveEdit& edit, UnsplitMiss& miss) {
  const ArcPiece whole{0, 1, piece_held_};
  FittedArc fit = fit_arc(task, whole);
  if (task.move.polar) {
    const FittedArc polar = fit_polar_arc(task, piece_held_);
    if (polar.sound && (!fit.sound || polar.miss_mm < fit.miss_mm)) fit = polar;
  }
  if (!fit.sound)
    refuse(
        task.move,
        "this arc must stay one block, and none within the control's radius rules follows the corrected one");
  if (fit.sound && !keeps_turn_limits(task, whole, fit.read)) keep_turn_limits(task, fit, miss);
  edit.centre_mm = fit.via.centre_mm;
  piece_held_.set(fit.read.end);
  if (fit.miss_mm > task.tolerance_mm) miss.position = std::max(miss.position, fit.miss_mm * mm);
}

// The control would not turn the tool about one axis: the end keeps as much of its turn as it allows.
void Emitter::keep_turn_limits(const ArcTask& task, const FittedArc& fit, UnsplitMiss& miss) {
  const Move& move = task.move;
  const OrientationForm form = move.orientation->form;
  const auto end = allowed_end(task, {0, 1, piece_held_}, fit.read);
  const Matrix3 R_wanted = rotation_of(form, task.turned(1)),
                R_end = rotation_of(form, end.value_or(task.turned(1)));
  const double off = rotation_between(R_end, R_wanted).norm();
  if (!end || off > job_.options.tilt_tolerance)
    return refuse(
        move,
        "this arc must stay one block, and along the corrected one the control turns the tool with the "
        "path, not about one axis; let it pass the end of the arc in a zone, or replace the arc by lines");
  miss.turn = off;
  end_turn_ = frame(move).X_MW.R * rotation_between(R_end, rotation_of(form, move.orientation->end));
}

}  // namespace counterflex
