#include <algorithm>
#include <cmath>
#include <numbers>

#include "compensation/match/match_moves.hpp"
#include "compensation/plan/arc_angles.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/failures.hpp"
#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {
namespace {

constexpr double inner_end = 1 - 1e-9;    // only the last piece ends a move
constexpr int most_refinements = 20;      // three suffice but at kinks of the force
constexpr double longest_secant = 4;      // of the plain step
constexpr double refined_enough = 1e-10;  // m

double fraction_on_line(const Curve& line, const Vector3& p) {
  const Vector3 d = line.end - line.start;
  return (p - line.start).dot(d) / d.squaredNorm();
}

// The fraction of `p` on an arc, of all turns the one that is nearest to the angle `expected`.
double fraction_on_arc(const Curve& arc, const Vector3& p, double expected) {
  const double angle = angle_between(*arc.arc, arc.start, p), turn = 2 * std::numbers::pi;
  return (angle + turn * std::round((expected - angle) / turn)) / arc.arc->sweep;
}

// A move of the corrected program, and the fraction at which it ends.
struct Step {
  Curve way;
  BoxedOptional<Turn> turn{};
  int line = 0;
  double u = -1;  // not yet known
  bool settled = false;
  bool jump = false;
};

std::vector<Step> steps_of(const Job& job, const MatchedMoves& matched) {
  std::vector<Step> steps;
  Vector3 from = job.path.segments[*matched.segment].wanted.start;
  for (const CorrectedMove& found : matched.found) {
    const Move& move = *found.move;
    Step& step = steps.emplace_back();
    step.way = all_known(move.known_start) ? command_of(job, move) : Curve{from, target_of(job, move), {}};
    step.turn = turn_of(job, move);
    step.line = move.line;
    from = step.way.end;
  }
  steps.back().u = 1;
  steps.back().settled = true;
  return steps;
}

// Whether a step from `next` on ends at a knot; `next` goes behind it.
bool find_knot(const Knot& knot, double tolerance, std::vector<Step>& steps, std::size_t& next) {
  std::size_t best = steps.size();
  double best_miss = tolerance;
  for (std::size_t j = next; j + 1 < steps.size(); ++j) {
    const double miss = (steps[j].way.end - knot.target).norm();
    if (miss >= best_miss) continue;
    best = j;
    best_miss = miss;
  }
  if (best == steps.size()) return false;
  steps[best].u = knot.u;
  steps[best].settled = true;
  next = best + 1;
  return true;
}

bool find_jump(const Knot& knot, double tolerance, std::vector<Step>& steps, std::size_t& next) {
  const Vector3 end = steps[next].way.end;
  if ((end - knot.target).norm() > tolerance) return false;
  // What is left of the way behind the jump may be less than a digit.
  if (next + 1 == steps.size())
    steps.push_back({{end, end, {}}, steps.back().turn, steps.back().line, 1, true});
  steps[next].u = knot.u;
  steps[next].settled = steps[next].jump = true;
  ++next;
  return true;
}

// Points that were inserted where the plan has a knot belong to its fraction. Where the force steps, one move
// ends on this side of the step and the next one on the other.
void find_knots(std::span<const Knot> knots, double tolerance, std::vector<Step>& steps) {
  std::size_t next = 0;  // step
  const Knot* last = nullptr;
  for (const Knot& knot : knots) {
    if (next + 1 >= steps.size()) return;
    const bool behind = last != nullptr && last->u == knot.u;
    const bool found =
        behind ? find_jump(knot, tolerance, steps, next) : find_knot(knot, tolerance, steps, next);
    last = found ? &knot : nullptr;
  }
}

// The correction changes evenly enough from one end of the segment to the other for a first guess.
void project(const Curve& wanted, std::vector<Step>& steps) {
  const Vector3 c0 = steps.front().way.start - wanted.start, c1 = steps.back().way.end - wanted.end;
  double last = 0;  // fraction
  for (Step& step : steps) {
    if (step.u < 0) {
      double expected = 0;
      if (wanted.arc) {
        Arc shifted = *wanted.arc;
        shifted.centre += (1 - last) * c0 + last * c1;
        expected = last * wanted.arc->sweep + angle_about(shifted, step.way);
      }
      double u = wanted.arc ? expected / wanted.arc->sweep : last;
      for (int k = 0; k < 2; ++k) {
        const Vector3 p = step.way.end - (1 - u) * c0 - u * c1;
        u = wanted.arc ? fraction_on_arc(wanted, p, expected) : fraction_on_line(wanted, p);
      }
      step.u = std::clamp(u, last, inner_end);
    }
    last = step.u;
  }
}

}  // namespace

void add_pieces(const Job& job, const PlannedWays& ways, const MatchedMoves& matched,
                std::vector<DraftPiece>& pieces) {
  const std::size_t s = *matched.segment;
  const Segment& segment = job.path.segments[s];
  const Move& original = matched.original;
  const bool own = original.handling == Handling::own;
  std::vector<Step> steps = steps_of(job, matched);
  if (s < ways.size()) find_knots(ways[s].inner, job.options.tolerance, steps);
  if (steps.size() > 1) project(segment.wanted, steps);
  double u0 = 0;
  for (const Step& step : steps) {
    if (!step.jump)
      pieces.push_back(
          {{.segment = s,
            .line = segment.line,
            .corrected_line = step.line,
            .u0 = u0,
            .u1 = step.u,
            .frame = segment.frame,
            .commanded = step.way,
            .turn = step.turn,
            .end_only = !segment.cutting,
            .exempt = !own || !original.may_split,
            .exempt_end = !own || !takes_all_words(original) || (original.corners && &step != &steps.back())},
           step.settled});
    u0 = step.u;
  }
}

namespace {

// An end that is searched, and what the step before was.
struct OpenEnd {
  std::size_t piece = 0;
  double u = 0, step = 0;  // fractions; no step yet: 0
};

// The step to where the plain steps of a secant vanish: under a force that grows along the way each plain
// step leaves a part of the way.
double secant_step(const OpenEnd& last, double u, double step) {
  if (last.step == 0 || last.step == step) return step;
  const double secant = step * (u - last.u) / (last.step - step);
  return secant * step > 0 && std::abs(secant) < longest_secant * std::abs(step) ? secant : step;
}

// Moves the ends of the pieces in `open` to where they put the tip; whether none has moved far.
bool refine(const Job& job, PlaceSolver& solver, std::vector<OpenEnd>& open,
            std::vector<DraftPiece>& drafts) {
  std::vector<ForwardRequest> requests;
  std::vector<ForwardAnswer> answers(open.size());
  for (const OpenEnd& end : open) {
    const Piece& piece = drafts[end.piece].piece;
    const Model& model = model_of(job, job.path.segments[piece.segment]);
    ForwardRequest& request = requests.emplace_back(
        ForwardRequest{&model, piece.commanded.end, job.forces.at(piece.segment, piece.u1, Side::before)});
    if (piece.turn) request.R = piece.turn->end;
    request.directions = directions_at(job, job.path.segments[piece.segment].move, piece.u1, Side::before);
  }
  solver.forwards(requests, answers);
  const auto fails = [](const ForwardAnswer& answer) { return answer.status != Status::converged; };
  if (std::ranges::any_of(answers, fails)) return true;  // found again where the pieces are solved
  double largest = 0;
  for (std::size_t k = 0; k < open.size(); ++k) {
    Piece &piece = drafts[open[k].piece].piece, &next = drafts[open[k].piece + 1].piece;
    const Curve& wanted = job.path.segments[piece.segment].wanted;
    const Vector3 miss = answers[k].X_MT.p - point_at(wanted, piece.u1);
    const double whole = length(wanted), step = miss.dot(direction_at(wanted, piece.u1)) / whole;
    const double u = std::clamp(piece.u1 + secant_step(open[k], piece.u1, step), 0.0, inner_end);
    open[k].u = piece.u1;
    open[k].step = step;
    largest = std::max(largest, std::abs(u - piece.u1) * whole);
    piece.u1 = next.u0 = u;
  }
  return largest < refined_enough;
}

// A first piece is one if it is shorter than what rounding may leave of it.
bool is_jump(const Job& job, const Piece& piece) {
  if (piece.u1 <= piece.u0) return true;
  if (piece.u0 > 0 || piece.u1 == 1) return false;
  const Move& move = job.program.moves[job.path.segments[piece.segment].move];
  const double way = (piece.u1 - piece.u0) * length(job.path.segments[piece.segment].wanted);
  return way < roundings * rounding_allowance(move, job.options.write);
}

}  // namespace

std::vector<Piece> refined(const Job& job, std::vector<DraftPiece> drafts) {
  std::vector<OpenEnd> open;
  for (std::size_t i = 0; i < drafts.size(); ++i)
    if (!drafts[i].settled) open.push_back({i});
  PlaceSolver solver(job);
  for (int k = 0; k < most_refinements && !open.empty(); ++k)
    if (refine(job, solver, open, drafts)) break;
  std::vector<Piece> pieces;
  pieces.reserve(drafts.size());
  std::optional<double> u0;  // where the piece after a jump begins
  for (DraftPiece& draft : drafts) {
    Piece& piece = draft.piece;
    if (u0) piece.u0 = *u0;
    u0.reset();
    if (piece.segment != no_segment && !piece.end_only && is_jump(job, piece))
      u0 = std::max(piece.u0, piece.u1);
    else
      pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace counterflex
