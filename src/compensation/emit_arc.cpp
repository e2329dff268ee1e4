// Arcs: one where it is good enough, else up to eight, else chords of the corrected curve.
#include <algorithm>
#include <cmath>

#include "counterflex/geometry/units.hpp"
#include "emitter.hpp"

namespace counterflex {
namespace {

constexpr int most_halvings = 3;
constexpr double sampling_share = 0.03;  // of the tolerance: for what happens between samples
constexpr double sliver = 0.05;          // of a piece: corners nearer to its ends do not divide it

// Where a piece that misses is divided: at a corner of the correction, else in the middle.
double division(const std::vector<double>& corners, double u0, double u1, bool& at_corner) {
  const double middle = (u0 + u1) / 2, margin = sliver * (u1 - u0);
  double best = middle;
  at_corner = false;
  for (double corner : corners) {
    if (corner < u0 + margin || corner > u1 - margin) continue;
    if (!at_corner || std::abs(corner - middle) < std::abs(best - middle)) best = corner;
    at_corner = true;
  }
  return best;
}

}  // namespace

void Emitter::emit_arc(const Segment& segment, const PlannedSegment& planned, EmittedMove& emitted,
                       double& unsplit_miss) {
  const Move& move = job_.program.moves[segment.move];
  const Pose X_WM = inverse(frame(move).X_MW);
  const CorrectionCurve& c = planned.arc.front();
  const ArcTask task{move,
                     job_.options.write,
                     curve_of(move),
                     [&](double u) { return Vector3(X_WM * (point_at(segment.wanted, u) + c.at(u)) / mm); },
                     job_.forces.breaks(emitted.segment),
                     (1 - sampling_share) * job_.options.tolerance / planned.gain / mm};
  const HeldPosition start = piece_held_;
  if (!move.may_split) return put_one_arc(task, emitted, unsplit_miss);
  if (planned.arc.size() == 1 && fit_pieces(task, 0, 1, 0, true, emitted)) return;
  piece_held_ = start;
  emitted.edit.inserted.clear();
  emitted.edit.centre_mm.reset();
  emitted.fractions.clear();
  put_chords(segment, planned, task, emitted);
}

bool Emitter::fit_pieces(const ArcTask& task, double u0, double u1, int halvings, bool whole,
                         EmittedMove& emitted) {
  const ArcPiece piece{u0, u1, u1 == 1, piece_held_};
  const FittedArc fit = fit_arc(task, piece);
  const bool changes = !whole || !keeps_words(task, piece, fit);
  if (fit.sound && fit.miss_mm <= task.tolerance_mm &&
      !(whole && changes && must_halve(task.move, task.source))) {
    if (u1 == 1)
      emitted.edit.centre_mm = fit.via.centre_mm;
    else
      emitted.edit.inserted.push_back(fit.via);
    emitted.fractions.push_back(u1);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      piece_held_[static_cast<std::size_t>(axis)] = fit.read.end[axis];
    return true;
  }
  bool at_corner = false;
  const bool leaves_turns = whole && task.move.arc->turns > 0;
  const double middle = leaves_turns ? sweep_beside_turns(task.move, task.source) / 2 / task.source.arc->sweep
                                     : division(task.corners, u0, u1, at_corner);
  if (!at_corner && ++halvings > most_halvings) return false;
  return fit_pieces(task, u0, middle, halvings, false, emitted) &&
         fit_pieces(task, middle, u1, halvings, false, emitted);
}

// Under exact stop: the best single arc there is, and what it misses.
void Emitter::put_one_arc(const ArcTask& task, EmittedMove& emitted, double& unsplit_miss) {
  const FittedArc fit = fit_arc(task, {0, 1, true, piece_held_});
  if (!fit.sound)
    refuse(
        task.move,
        "this arc must stay one block, and none within the control's radius rules follows the corrected one");
  emitted.edit.centre_mm = fit.via.centre_mm;
  emitted.fractions = {1};
  if (fit.miss_mm > task.tolerance_mm) unsplit_miss = std::max(unsplit_miss, fit.miss_mm * mm);
}

void Emitter::put_chords(const Segment& segment, const PlannedSegment& planned, const ArcTask& task,
                         EmittedMove& emitted) {
  const std::optional<double> room = room_between_points(job_, segment, planned.gain);
  if (!room) {
    out_.failure = few_decimals_failure(job_.program.moves[segment.move], job_.options);
    return;
  }
  for (const CorrectionCurve& c : planned.arc) {
    const VectorAt at = [&](double u) { return Vector3(point_at(segment.wanted, u) + c.at(u)); };
    const double begin = c.begin();
    if (begin > 0) {  // a step of the force
      emitted.edit.inserted.push_back({written(task.move, at(begin))});
      emitted.fractions.push_back(begin);
    }
    for (double u : choose_knots(at, begin, c.end(), task.corners, *room)) {
      emitted.fractions.push_back(u);
      if (u < 1) emitted.edit.inserted.push_back({written(task.move, at(u))});
    }
  }
}

}  // namespace counterflex
