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

bool all(const std::array<bool, 3>& known) {
  return known[0] && known[1] && known[2];
}

// Goes through the moves in order and keeps the correction (M, m) that holds where the tool is.
class Emitter {
 public:
  Emitter(const Job& job, const Plan& plan) : job_(job), plan_(plan), X_WM_(inverse(job.X_MW)) {}

  Emission run() {
    for (std::size_t m = 0; m < job_.program.moves.size() && !out_.failure; ++m) {
      const Move& move = job_.program.moves[m];
      const bool has_segment =
          next_segment_ < job_.path.segments.size() && job_.path.segments[next_segment_].move == m;
      if (has_segment)
        emit_segment(next_segment_++);
      else if (all(move.known_start) && all(move.known_end))
        emit_shifted(m);
      else if (all(move.known_end))
        emit_first_known(m);
      else
        pending_.push_back(m);
    }
    leave_pending_alone();
    return std::move(out_);
  }

 private:
  Vector3 written(const Vector3& target) const { return X_WM_ * target / mm; }

  void add(MoveEdit edit, std::size_t segment, std::vector<double> fractions, bool first_known = false,
           bool exempt = false) {
    out_.first_known.push_back(first_known);
    out_.exempt.push_back(exempt);
    out_.edits.push_back(std::move(edit));
    out_.segment.push_back(segment);
    out_.fractions.push_back(std::move(fractions));
  }

  void emit_segment(std::size_t s) {
    const Segment& segment = job_.path.segments[s];
    const PlannedSegment& planned = plan_.segments[s];
    const Move& move = job_.program.moves[segment.move];
    MoveEdit edit{.move = segment.move};
    std::vector<double> fractions;
    const Vector3 start_c = planned.start_target - segment.p_MT_start;
    const double jump = planned.starts_anywhere || !correction_known_ ? 0 : (start_c - correction_).norm();
    const bool jumps = jump > jump_share * job_.options.tolerance;
    if (jumps && move.may_jump) edit.jump_mm = written(planned.start_target);
    // A block that must stay one begins where the last one ended.
    const double unsplit_miss =
        planned.unsplit_miss + (jumps && segment.cutting && !move.may_split ? jump : 0);
    for (std::size_t k = 0; k + 1 < planned.knots.size(); ++k)
      edit.inserted_mm.push_back(written(planned.knots[k].target));
    for (const Knot& knot : planned.knots) fractions.push_back(knot.u);
    edit.end_mm = written(planned.knots.back().target);
    correction_ = planned.knots.back().target - segment.p_MT_end;
    correction_known_ = true;
    if (unsplit_miss > 0)
      out_.left_alone.push_back(
          {segment.line,
           fmt::format("not split, its end is corrected: between its ends the deviation may reach {:.4f} mm",
                       unsplit_miss / mm)});
    add(std::move(edit), s, std::move(fractions), false, unsplit_miss > 0);
  }

  Vector3 shifted(const Move& move) const {
    return move.end_mm + X_WM_.R * (correction_ + job_.datum_shift) / mm;
  }

  void emit_shifted(std::size_t m) {
    if (correction_known_) add({.move = m, .end_mm = shifted(job_.program.moves[m])}, no_segment, {});
  }

  // The first position that is known in all axes: its correction serves the words before it as well.
  void emit_first_known(std::size_t m) {
    const Move& move = job_.program.moves[m];
    const Vector3 wanted = target_of(job_, move.end_mm) + job_.datum_shift;
    PathSolver solver(job_, job_.model.home);
    const TargetSolution solution = solver.target(wanted, {});
    if (solution.status != Status::converged) {
      out_.failure = status_failure(solution.status, move.line);
      return;
    }
    correction_ = solution.target - wanted;
    correction_known_ = true;
    out_.failure = limit_failure(job_, correction_, move.line);
    if (out_.failure) return;
    for (std::size_t p : pending_) {
      const Move& earlier = job_.program.moves[p];
      if (move.block_index - earlier.block_index <= look_ahead)
        add({.move = p, .end_mm = shifted(earlier)}, no_segment, {});
      else
        leave_alone(earlier);
    }
    pending_.clear();
    add({.move = m, .end_mm = shifted(move)}, no_segment, {}, true);
  }

  void leave_alone(const Move& move) {
    out_.left_alone.push_back(
        {move.line, "an axis has no known position here, and none follows within 64 blocks"});
  }

  void leave_pending_alone() {
    for (std::size_t p : pending_) leave_alone(job_.program.moves[p]);
  }

  const Job& job_;
  const Plan& plan_;
  Pose X_WM_;
  Emission out_;
  std::size_t next_segment_ = 0;
  std::vector<std::size_t> pending_;
  Vector3 correction_ = Vector3::Zero();
  bool correction_known_ = false;
};

// A point that an edit asks the text to come to.
struct Stop {
  Vector3 p_mm;
  std::array<int, 3> decimals;
  double u;
  bool jump;
};

std::vector<Stop> stops_of(const Job& job, const MoveEdit& edit, const std::vector<double>& fractions) {
  const Decimals decimals = decimals_of(job.program.moves[edit.move], job.options.write);
  const std::array<int, 3> inside{decimals.inserted, decimals.inserted, decimals.inserted};
  std::vector<Stop> stops;
  if (edit.jump_mm) stops.push_back({*edit.jump_mm, inside, 0, true});
  for (std::size_t k = 0; k < edit.inserted_mm.size(); ++k)
    stops.push_back({edit.inserted_mm[k], inside, fractions[k], false});
  stops.push_back({edit.end_mm, decimals.end, fractions.back(), false});
  return stops;
}

// Where the commands of a program stand, move by move.
class PieceReader {
 public:
  PieceReader(const Job& job, const Program& corrected) : job_(job), corrected_(corrected) {}

  // The next `count` moves command a segment's stops; rewriting gave no block to those that rounding
  // swallowed.
  void read(std::size_t segment, const std::vector<Stop>& stops, std::size_t count, bool exempt,
            std::vector<Piece>& pieces) {
    const Segment& wanted = job_.path.segments[segment];
    std::size_t swallowed = stops.size() - count;
    double u0 = 0;
    for (const Stop& stop : stops) {
      const Vector3 from = here();
      const bool dropped = swallowed > 0 && is_held(stop, job_.program.moves[wanted.move].unit);
      if (dropped)
        --swallowed;
      else
        skip(1);
      if (stop.jump || (dropped && stop.u < 1)) continue;
      if (stop.u > u0 || !wanted.cutting)
        pieces.push_back({.segment = segment,
                          .line = wanted.line,
                          .u0 = u0,
                          .u1 = stop.u,
                          .from = from,
                          .to = here(),
                          .end_only = !wanted.cutting,
                          .exempt = exempt});
      u0 = stop.u;
    }
  }

  // A single position: the next `count` moves end at it.
  void read_position(const Move& original, std::size_t count, std::vector<Piece>& pieces) {
    skip(count);
    pieces.push_back({.segment = no_segment,
                      .line = original.line,
                      .from = here(),
                      .to = here(),
                      .wanted = target_of(job_, original.end_mm) + job_.datum_shift,
                      .end_only = true});
  }

  void skip(std::size_t count) { next_ += count; }

 private:
  // Whether the text holds the stop already, and the next move does not say it again.
  bool is_held(const Stop& stop, LengthUnit unit) const {
    if (next_ == 0) return false;
    const Vector3& held_mm = corrected_.moves[next_ - 1].end_mm;
    if (next_ < corrected_.moves.size() && corrected_.moves[next_].end_mm == held_mm) return false;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double digit = std::pow(10.0, -stop.decimals[static_cast<std::size_t>(axis)]) *
                           (unit == LengthUnit::inch ? inch / mm : 1);
      if (std::abs(stop.p_mm[axis] - held_mm[axis]) > 0.5 * digit * (1 + 1e-9)) return false;
    }
    return true;
  }

  Vector3 here() const {
    return next_ == 0 ? Vector3::Zero() : target_of(job_, corrected_.moves[next_ - 1].end_mm);
  }

  const Job& job_;
  const Program& corrected_;
  std::size_t next_ = 0;
};

}  // namespace

Vector3 target_of(const Job& job, const Vector3& p_mm) {
  return job.X_MW * (p_mm * mm);
}

Emission emit(const Job& job, const Plan& plan) {
  return Emitter(job, plan).run();
}

std::vector<Piece> emitted_pieces(const Job& job, const Emission& emission, const Rewritten& rewritten,
                                  const Program& corrected) {
  std::vector<Piece> pieces;
  PieceReader reader(job, corrected);
  std::size_t move = 0;
  for (std::size_t e = 0; e < emission.edits.size(); ++e) {
    const MoveEdit& edit = emission.edits[e];
    reader.skip(edit.move - move);
    const std::size_t count = rewritten.blocks_of_edit[e] + 1;
    if (emission.first_known[e])
      reader.read_position(job.program.moves[edit.move], count, pieces);
    else if (emission.segment[e] == no_segment)
      reader.skip(count);
    else
      reader.read(emission.segment[e], stops_of(job, edit, emission.fractions[e]), count, emission.exempt[e],
                  pieces);
    move = edit.move + 1;
  }
  return pieces;
}

}  // namespace counterflex
