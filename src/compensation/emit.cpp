#include "emit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/units.hpp"
#include "path_solver.hpp"

namespace counterflex {
namespace {

constexpr std::size_t look_ahead = 64;  // blocks
constexpr double jump_share = 0.1;      // of the tolerance

// Goes through the moves in order and keeps the correction (M, m) that holds where the tool is.
class Emitter {
 public:
  Emitter(const Job& job, const Plan& plan) : job_(job), plan_(plan) {}

  Emission run() {
    for (std::size_t m = 0; m < job_.program.moves.size() && !out_.failure; ++m) {
      const Move& move = job_.program.moves[m];
      const bool has_segment =
          next_segment_ < job_.path.segments.size() && job_.path.segments[next_segment_].move == m;
      const bool holds = skipped_ && correction_known_;
      if (has_segment)
        emit_segment(next_segment_++);
      else if (all_known(move.known_start) && all_known(move.known_end))
        emit_shifted(m);
      else if (holds && (move.motion == Motion::feed || !all_known(move.known_end)))
        emit_held(m);
      else if (all_known(move.known_end))
        emit_first_known(m);
      else
        pending_.push_back(m);
      skipped_ = move.block_delete || (skipped_ && !all_known(move.known_end));
    }
    leave_pending_alone();
    return std::move(out_);
  }

 private:
  using Kind = EmittedMove::Kind;

  const WorkFrame& frame(const Move& move) const { return job_.path.frames[move.offset]; }
  Vector3 written(const Move& move, const Vector3& target) const { return inverse(frame(move).X_MW) * target / mm; }

  void emit_segment(std::size_t s) {
    const Segment& segment = job_.path.segments[s];
    const PlannedSegment& planned = plan_.segments[s];
    const Move& move = job_.program.moves[segment.move];
    EmittedMove emitted{.edit = {.move = segment.move}, .kind = Kind::segment, .segment = s};
    const Vector3 start_c = planned.start_target - segment.wanted.start;
    const double jump = planned.starts_anywhere || !correction_known_ ? 0 : (start_c - correction_).norm();
    const bool jumps = jump > jump_share * job_.options.tolerance;
    if (jumps && move.may_jump) emitted.edit.jump_mm = written(move, planned.start_target);
    for (std::size_t k = 0; k + 1 < planned.knots.size(); ++k)
      emitted.edit.inserted.push_back({written(move, planned.knots[k].target)});
    for (const Knot& knot : planned.knots) emitted.fractions.push_back(knot.u);
    const Vector3 correction = planned.knots.back().target - segment.wanted.end;
    const Vector3 kept = correction_that_can_be_written(move, correction);
    emitted.exempt_end = emitted.in_part = kept != correction;
    emitted.edit.end_mm = written(move, segment.wanted.end + kept);
    correction_ = kept;
    correction_known_ = true;
    // A block that must stay one begins where the last one ended.
    const double unsplit_miss =
        planned.unsplit_miss + (jumps && segment.cutting && !move.may_split ? jump : 0);
    emitted.exempt = unsplit_miss > 0 || emitted.exempt_end;
    if (emitted.exempt_end)
      list_held_words(move, correction - kept);
    else if (emitted.exempt)
      list(move,
           fmt::format("not split, its end is corrected: between its ends the deviation may reach {:.4f} mm",
                       unsplit_miss / mm));
    out_.moves.push_back(std::move(emitted));
  }

  // Where no axis words may be inserted, absent axes keep the correction that they have.
  Vector3 correction_that_can_be_written(const Move& move, const Vector3& correction) const {
    if (move.may_insert_words || !correction_known_) return correction;
    const Matrix3& R_MW = frame(move).X_MW.R;
    Vector3 c_W = R_MW.transpose() * correction;
    const Vector3 held_W = R_MW.transpose() * correction_;
    const double rounding = rounding_allowance(move, job_.options.write);
    bool all_written = true;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (move.words[static_cast<std::size_t>(axis)] || std::abs(c_W[axis] - held_W[axis]) < rounding)
        continue;
      c_W[axis] = held_W[axis];
      all_written = false;
    }
    return all_written ? correction : Vector3(R_MW * c_W);
  }

  Vector3 shifted(const Move& move) const {
    return move.end_mm + frame(move).X_MW.R.transpose() * (correction_ + frame(move).datum_shift) / mm;
  }

  void add_shifted(std::size_t m, Kind kind) {
    out_.moves.push_back({.edit = {.move = m, .end_mm = shifted(job_.program.moves[m])}, .kind = kind});
  }

  void emit_shifted(std::size_t m) {
    if (correction_known_) add_shifted(m, Kind::shifted);
  }

  // After a block that '/' may skip the position is not known: the correction with which it was entered
  // holds.
  void emit_held(std::size_t m) {
    list(job_.program.moves[m],
         "held: a block before it may be skipped ('/'), so its start is not known; it keeps the correction "
         "that holds "
         "there");
    add_shifted(m, Kind::shifted);
    out_.moves.back().in_part = true;
  }

  // The first position that is known in all axes: its correction serves the words before it as well.
  void emit_first_known(std::size_t m) {
    const Move& move = job_.program.moves[m];
    const Vector3 wanted = wanted_of(job_, move);
    PathSolver solver(job_, job_.model.home);
    const TargetSolution solution = solver.target(wanted, {});
    if (solution.status != Status::converged) {
      out_.failure = status_failure(solution.status, move.line);
      return;
    }
    const Vector3 correction = solution.target - wanted,
                  kept = correction_that_can_be_written(move, correction);
    out_.failure = limit_failure(job_, correction + frame(move).datum_shift, move.line);
    if (out_.failure) return;
    correction_ = kept;
    correction_known_ = true;
    for (std::size_t p : pending_) {
      const Move& earlier = job_.program.moves[p];
      if (move.block_index - earlier.block_index <= look_ahead)
        add_shifted(p, Kind::shifted);
      else
        leave_alone(earlier);
    }
    pending_.clear();
    if (kept != correction)
      list_held_words(move, correction - kept);
    else if (move.motion == Motion::feed)
      list(move, "a feed move from a position that is not known: its end is corrected without cutting force");
    add_shifted(m, Kind::first_known);
    out_.moves.back().exempt_end = kept != correction;
    out_.moves.back().in_part = kept != correction || move.motion == Motion::feed;
  }

  void list_held_words(const Move& move, const Vector3& miss) {
    list(move, fmt::format(
                   "a block with G43, G44 or G49 takes no further axis words: its end stays off by {:.4f} mm",
                   miss.norm() / mm));
  }

  void list(const Move& move, std::string why) { out_.left_alone.push_back({move.line, std::move(why)}); }

  void leave_alone(const Move& move) {
    list(move, "an axis has no known position here, and none follows within 64 blocks");
  }

  void leave_pending_alone() {
    for (std::size_t p : pending_) leave_alone(job_.program.moves[p]);
  }

  const Job& job_;
  const Plan& plan_;
  Emission out_;
  std::size_t next_segment_ = 0;
  std::vector<std::size_t> pending_;
  Vector3 correction_ = Vector3::Zero();
  bool correction_known_ = false;
  bool skipped_ = false;  // a '/' block made the position unknown, and it still is
};

}  // namespace

Vector3 target_of(const Job& job, const Move& move) {
  return job.path.frames[move.offset].X_MW * (move.end_mm * mm);
}

Vector3 wanted_of(const Job& job, const Move& move) {
  return wanted_frame(job.path.frames[move.offset]) * (move.end_mm * mm);
}

Emission emit(const Job& job, const Plan& plan) {
  return Emitter(job, plan).run();
}

std::vector<MoveEdit> edits_of(const Emission& emission) {
  std::vector<MoveEdit> edits;
  for (const EmittedMove& move : emission.moves) edits.push_back(move.edit);
  return edits;
}

}  // namespace counterflex
