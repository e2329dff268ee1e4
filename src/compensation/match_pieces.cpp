#include "match_pieces.hpp"

#include <algorithm>

#include "counterflex/compensation/compensate.hpp"
#include "emit.hpp"

namespace counterflex {
namespace {

constexpr double inner_end = 1 - 1e-9;  // only the last piece ends a move
constexpr double jump_length = 3;       // in allowances for rounding: shorter pieces are jumps

// Goes through the moves that command one segment.
class SegmentReader {
 public:
  SegmentReader(const Job& job, const Program& corrected, const MatchedMoves& found,
                ExpectedTargets& expected)
      : job_(job),
        corrected_(corrected),
        found_(found),
        expected_(expected),
        segment_(job.path.segments[found.segment]),
        near_(job.options.tolerance) {}

  void run(std::vector<Piece>& pieces) {
    read_ways();
    find_jump_at_start();
    find_steps();
    settle_fractions();
    add(pieces);
  }

 private:
  // A move of the corrected program, and the fraction at which it ends.
  struct Step {
    Curve way;
    double u = -1;  // not yet known
    bool jump = false;
  };

  void read_ways() {
    Vector3 from = segment_.wanted.start;
    for (std::size_t j = found_.first; j <= found_.last; ++j) {
      steps_.push_back({commanded_by(job_, corrected_, j, from)});
      from = steps_.back().way.end;
    }
    steps_.back().u = 1;
  }

  void find_jump_at_start() {
    if (steps_.size() < 2) return;
    const auto start = expected_.at(found_.segment, 0, Side::after);
    if (!start || (steps_[0].way.end - *start).norm() > near_) return;
    steps_[0].u = 0;
    steps_[0].jump = true;
  }

  // Where the force steps, one move ends on this side of the step and the next one on the other.
  void find_steps() {
    if (job_.options.blend > 0 || !segment_.cutting) return;
    std::size_t next = 0;
    for (const double u : job_.forces.breaks(found_.segment)) {
      if (next + 1 >= steps_.size()) return;
      const auto before = expected_.at(found_.segment, u, Side::before),
                 after = expected_.at(found_.segment, u, Side::after);
      if (before && after) next = find_step(u, *before, *after, next);
    }
  }

  std::size_t find_step(double u, const Vector3& before, const Vector3& after, std::size_t next) {
    std::size_t best = steps_.size();
    double best_miss = near_;
    for (std::size_t j = next; j + 1 < steps_.size(); ++j) {
      const double miss = (steps_[j].way.end - before).norm();
      if (steps_[j].jump || miss >= best_miss) continue;
      best = j;
      best_miss = miss;
    }
    if (best == steps_.size()) return next;
    steps_[best].u = u;
    const Vector3 next_end = steps_[best + 1].way.end;
    if ((next_end - after).norm() > near_) return best + 1;
    // What is left of the way behind the jump may be less than the digits tell.
    if (best + 2 == steps_.size()) steps_.push_back({{next_end, next_end, {}}, 1});
    steps_[best + 1].u = u;
    steps_[best + 1].jump = true;
    return best + 2;
  }

  // Between places that are known by the length of the way.
  void settle_fractions() {
    double u0 = 0;
    for (std::size_t begin = 0, end = 0; begin < steps_.size(); begin = end + 1) {
      end = begin;
      double whole = length(steps_[begin].way);
      while (steps_[end].u < 0) whole += length(steps_[++end].way);
      const double u1 = steps_[end].u;
      double gone = 0;
      for (std::size_t j = begin; j < end; ++j) {
        gone += length(steps_[j].way);
        steps_[j].u = std::min(whole > 0 ? u0 + (u1 - u0) * gone / whole : u1, inner_end);
      }
      u0 = u1;
    }
  }

  void add(std::vector<Piece>& pieces) const {
    const Move& original = job_.program.moves[segment_.move];
    const bool own = original.handling == Handling::own;
    double u0 = 0;
    for (const Step& step : steps_) {
      if (step.jump) continue;
      if (step.u > u0)
        pieces.push_back({.segment = found_.segment,
                          .line = segment_.line,
                          .u0 = u0,
                          .u1 = step.u,
                          .frame = segment_.frame,
                          .commanded = step.way,
                          .end_only = !segment_.cutting,
                          .exempt = !own || !original.may_split,
                          .exempt_end = !own || !original.may_insert_words});
      u0 = step.u;
    }
  }

  const Job& job_;
  const Program& corrected_;
  const MatchedMoves& found_;
  ExpectedTargets& expected_;
  const Segment& segment_;
  double near_;  // to an expected target (m)
  std::vector<Step> steps_;
};

// Whether the fraction of a piece's end is known: an end of a segment, or a step of the force.
bool is_settled(const Job& job, const Piece& piece) {
  if (piece.u1 >= 1 || piece.segment == no_segment) return true;
  const std::vector<double> breaks = job.forces.breaks(piece.segment);
  return job.options.blend == 0 && std::find(breaks.begin(), breaks.end(), piece.u1) != breaks.end();
}

}  // namespace

std::optional<Vector3> ExpectedTargets::at(std::size_t segment, double u, Side side) {
  const Model& model = model_of(job_, job_.path.segments[segment]);
  const Load load{job_.forces.at(segment, u, side), job_.forces.at_platform()};
  const TargetSolution found =
      solvers_.of(model, model.home).target(point_at(job_.path.segments[segment].wanted, u), load);
  if (found.status != Status::converged) return std::nullopt;
  return found.target;
}

Curve commanded_by(const Job& job, const Program& corrected, std::size_t move, const Vector3& from) {
  const Move& found = corrected.moves[move];
  return all_known(found.known_start) ? command_of(job, found) : Curve{from, target_of(job, found), {}};
}

void add_pieces(const Job& job, const Program& corrected, const MatchedMoves& found,
                ExpectedTargets& expected, std::vector<Piece>& pieces) {
  SegmentReader(job, corrected, found, expected).run(pieces);
}

void refine_fractions(const Job& job, std::vector<Piece>& pieces) {
  for (int iteration = 0; iteration < 3; ++iteration) {
    const ForwardRun run =
        solve_forward_along(job, pieces, {.before = false, .attribution = false, .inside = false});
    if (run.failure) return;  // said again by whoever solves the pieces
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      if (is_settled(job, pieces[i])) continue;
      const Segment& segment = job.path.segments[pieces[i].segment];
      const double length = counterflex::length(segment.wanted);
      const double u =
          pieces[i].u1 + run.waypoints[i].after.head<3>().dot(run.waypoints[i].direction) / length;
      pieces[i].u1 = pieces[i + 1].u0 = std::clamp(u, pieces[i].u0, inner_end);
    }
  }
}

void drop_jumps(const Job& job, std::vector<Piece>& pieces) {
  std::vector<Piece> kept;
  std::optional<double> u0;  // where the piece after a dropped one begins
  for (Piece piece : pieces) {
    if (u0) piece.u0 = *u0;
    u0.reset();
    if (piece.segment != no_segment && !piece.end_only && piece.u1 < 1) {
      const Segment& segment = job.path.segments[piece.segment];
      const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
      const double length = (piece.u1 - piece.u0) * counterflex::length(segment.wanted);
      if (length < jump_length * rounding) {
        u0 = piece.u0;
        continue;
      }
    }
    kept.push_back(piece);
  }
  pieces = std::move(kept);
}

}  // namespace counterflex
