#include "emit.hpp"

#include <algorithm>

#include "counterflex/geometry/units.hpp"
#include "path_solver.hpp"

namespace counterflex {
namespace {

constexpr std::size_t look_ahead = 64;  // blocks
constexpr double jump_share = 0.1;      // of the tolerance

bool all(const std::array<bool, 3>& known) { return known[0] && known[1] && known[2]; }

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

  void add(MoveEdit edit, std::size_t segment, std::vector<double> fractions, bool first_known = false) {
    out_.first_known.push_back(first_known);
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
    const bool jumps = !planned.starts_anywhere && correction_known_ && move.may_jump &&
                       (start_c - correction_).norm() > jump_share * job_.options.tolerance;
    if (jumps) edit.jump_mm = written(planned.start_target);
    for (std::size_t k = 0; k + 1 < planned.knots.size(); ++k) edit.inserted_mm.push_back(written(planned.knots[k].target));
    for (const Knot& knot : planned.knots) fractions.push_back(knot.u);
    edit.end_mm = written(planned.knots.back().target);
    correction_ = planned.knots.back().target - segment.p_MT_end;
    correction_known_ = true;
    if (planned.unsplit_miss > 0)
      out_.left_alone.push_back({segment.line, "not split, its end is corrected: between its ends the deviation may reach " +
                                                   std::to_string(planned.unsplit_miss / mm) + " mm"});
    add(std::move(edit), s, std::move(fractions));
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
    out_.left_alone.push_back({move.line, "an axis has no known position here, and none follows within 64 blocks"});
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

// Where the commands of a program stand, move by move.
class PieceReader {
 public:
  PieceReader(const Job& job, const Program& corrected) : job_(job), corrected_(corrected) {}

  // The next `count` moves command a segment's parts that end at `fractions`; a jump may come first.
  void read(std::size_t segment, const std::vector<double>& fractions, std::size_t count, bool exempt,
            std::vector<Piece>& pieces) {
    if (fractions.empty()) return skip(count);
    const Segment& wanted = job_.path.segments[segment];
    if (count > fractions.size()) skip(count - fractions.size());
    const std::size_t dropped = fractions.size() - std::min(count, fractions.size());
    double u0 = 0;
    for (std::size_t k = dropped; k < fractions.size(); ++k) {
      const Vector3 from = here();
      skip(1);
      Piece piece{.segment = segment, .line = wanted.line, .u0 = u0, .u1 = fractions[k], .from = from, .to = here(),
                  .end_only = !wanted.cutting, .exempt = exempt};
      if (piece.u1 > piece.u0 || !wanted.cutting) pieces.push_back(piece);
      u0 = fractions[k];
    }
  }

  // A single position: the next `count` moves end at it.
  void read_position(const Move& original, std::size_t count, std::vector<Piece>& pieces) {
    skip(count);
    pieces.push_back({.segment = no_segment, .line = original.line, .from = here(), .to = here(),
                      .wanted = target_of(job_, original.end_mm) + job_.datum_shift, .end_only = true});
  }

  void skip(std::size_t count) { next_ += count; }

 private:
  Vector3 here() const { return next_ == 0 ? Vector3::Zero() : target_of(job_, corrected_.moves[next_ - 1].end_mm); }

  const Job& job_;
  const Program& corrected_;
  std::size_t next_ = 0;
};

}  // namespace

Vector3 target_of(const Job& job, const Vector3& p_mm) { return job.X_MW * (p_mm * mm); }

Emission emit(const Job& job, const Plan& plan) { return Emitter(job, plan).run(); }

std::vector<Piece> emitted_pieces(const Job& job, const Plan& plan, const Emission& emission, const Rewritten& rewritten,
                                  const Program& corrected) {
  std::vector<Piece> pieces;
  PieceReader reader(job, corrected);
  std::size_t move = 0;
  for (std::size_t e = 0; e < emission.edits.size(); ++e) {
    reader.skip(emission.edits[e].move - move);
    const std::size_t segment = emission.segment[e];
    const bool exempt = segment != no_segment && plan.segments[segment].unsplit_miss > 0;
    const std::size_t count = rewritten.blocks_of_edit[e] + 1;
    if (emission.first_known[e])
      reader.read_position(job.program.moves[emission.edits[e].move], count, pieces);
    else
      reader.read(segment, emission.fractions[e], count, exempt, pieces);
    move = emission.edits[e].move + 1;
  }
  return pieces;
}

}  // namespace counterflex
