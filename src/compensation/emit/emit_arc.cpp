// Arcs: one where it is good enough, else several, and chords of the corrected curve only where no arc fits.
#include <algorithm>

#include "compensation/emit/emitter.hpp"
#include "compensation/plan/arc_pieces.hpp"
#include "compensation/solve/failures.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr double sampling_share = 0.03;  // of the tolerance: for what happens between samples

}  // namespace

void Emitter::emit_arc(const Segment& segment, const PlannedSegment& planned, EmittedMove& emitted,
                       double& unsplit_miss) {
  const Move& move = job_.program.moves[segment.move];
  if (!move.may_split)
    return put_one_arc(arc_task(segment, planned, planned.arc.front()), emitted, unsplit_miss);
  for (const CorrectionCurve& stretch : planned.arc) {
    const ArcTask task = arc_task(segment, planned, stretch);
    const double begin = stretch.begin(), end = stretch.end();
    if (begin > 0) {  // a step of the force
      const Via step{task.commanded(begin)};
      go_through(move, step, piece_held_);
      emitted.edit.inserted.push_back(step);
    }
    ArcPieces pieces = divide_arc(task, begin, end, piece_held_);
    if (pieces.lack_digits) {
      out_.failure = few_decimals_failure(move, job_.options);
      return;
    }
    piece_held_ = pieces.held;
    for (std::size_t i = 0; i < pieces.vias.size(); ++i) {
      const double u = pieces.ends[i];
      pieces.vias[i].orientation =
          turned_words(job_, move, u, command_at(job_, segment, u, stretch.at(u)).turn);
    }
    if (end == 1) {
      emitted.edit.centre_mm = pieces.vias.back().centre_mm;
      pieces.vias.pop_back();
    }
    emitted.edit.inserted.insert(emitted.edit.inserted.end(), pieces.vias.begin(), pieces.vias.end());
  }
}

// `stretch`: of the correction, without a step of the force; borrowed, as are `segment` and the job.
ArcTask Emitter::arc_task(const Segment& segment, const PlannedSegment& planned,
                          const CorrectionCurve& stretch) const {
  const Move& move = job_.program.moves[segment.move];
  const Pose X_WM = inverse(frame(move).X_MW);
  return {.move = move,
          .options = job_.options.write,
          .source = curve_of(move),
          .commanded =
              [&segment, &stretch, X_WM](double u) {
                return Vector3(X_WM * (point_at(segment.wanted, u) + shift_of(stretch.at(u))) / mm);
              },
          .begin = stretch.begin(),
          .end = stretch.end(),
          .corners = job_.forces.breaks(index_of(segment)),
          .tolerance_mm = (1 - sampling_share) * job_.options.tolerance / planned.gain / mm,
          .chord_room_mm = room_between_points(job_, segment, planned.gain).value_or(0) / mm};
}

// Under exact stop: the best single arc there is, and what it misses.
void Emitter::put_one_arc(const ArcTask& task, EmittedMove& emitted, double& unsplit_miss) {
  FittedArc fit = fit_arc(task, {0, 1, true, piece_held_});
  if (task.move.polar) {
    const FittedArc polar = fit_polar_arc(task, piece_held_);
    if (polar.sound && (!fit.sound || polar.miss_mm < fit.miss_mm)) fit = polar;
  }
  if (!fit.sound)
    refuse(
        task.move,
        "this arc must stay one block, and none within the control's radius rules follows the corrected one");
  emitted.edit.centre_mm = fit.via.centre_mm;
  for (std::size_t axis = 0; axis < 3; ++axis)
    piece_held_[axis] = fit.read.end[static_cast<Eigen::Index>(axis)];
  if (fit.miss_mm > task.tolerance_mm) unsplit_miss = std::max(unsplit_miss, fit.miss_mm * mm);
}

}  // namespace counterflex
