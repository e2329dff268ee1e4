#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compensation/match/match.hpp"
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

// The way that counts as much as a turn (m/rad). At this quotient the default tolerances of place and tilt
// are the same part of a segment.
constexpr double way_of_turn = 0.25 * mm / deg;

// By how much words round an orientation: half a digit of each of three angles (rad).
constexpr double turn_rounding = 3 * 0.5e-4 * deg;

constexpr double rate_step = 1e-4;  // of a fraction: a rate of turn is right to its square

double fraction_on_line(const Curve& line, const Vector3& p) {
  const Vector3 d = line.end - line.start;
  return (p - line.start).dot(d) / d.squaredNorm();
}

// The fraction of `p` on an arc, of all turns the one that is nearest to the angle `expected`.
double fraction_on_arc(const Curve& arc, const Vector3& p, double expected) {
  const double angle = angle_between(*arc.arc, arc.start, p), turn = 2 * std::numbers::pi;
  return (angle + turn * std::round((expected - angle) / turn)) / arc.arc->sweep;
}

// By how much words may round the places of a move (m).
double rounding_of(const Job& job, const Move& move) {
  return roundings * rounding_allowance(move, job.options.write);
}

// What fractions of a segment are parts of (m).
double extent_of(const Segment& segment) {
  return is_found_by_turn(segment) ? way_of_turn * turn_of(segment) : length(segment.wanted);
}

constexpr double not_known = -1;  // a fraction

// Of the words of a move as read; -1 if it has none.
int most_decimals(const Move& move) {
  int most = -1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const auto& word = move.words[axis]) most = std::max<int>(most, word->decimals);
  return most;
}

// By how much the words of inserted points round them (m). A text that was written with other options may
// have fewer digits than the job. Round numbers have few digits, too: no program is written with digits that
// round by the tolerance.
double rounding_of_points(const Job& job, const MatchedMoves& matched) {
  const double written = rounding_allowance(matched.original, job.options.write);
  WriteOptions as_read;
  for (const CorrectedMove& found : matched.found.first(matched.found.size() - 1))
    as_read.decimals = std::max(as_read.decimals, most_decimals(*found.move));
  if (as_read.decimals < 0) return written;
  const double read = rounding_allowance(matched.original, as_read);
  return read < job.options.tolerance ? std::max(read, written) : written;
}

// The pieces of matched moves. The fraction at the end of the last one alone is known.
std::vector<DraftPiece> drafts_of(const Job& job, const MatchedMoves& matched) {
  const Segment& segment = job.path.segments[*matched.segment];
  const Move& original = matched.original;
  const bool own = original.handling == Handling::own;
  std::vector<DraftPiece> drafts;
  Vector3 from = segment.wanted.start;
  for (const CorrectedMove& found : matched.found) {
    const Move& move = *found.move;
    const bool is_last = &found == &matched.found.back();
    const Curve way =
        all_known(move.known_start) ? command_of(job, move) : Curve{from, target_of(job, move), {}};
    drafts.push_back({{.segment = *matched.segment,
                       .move = segment.move,
                       .line = segment.line,
                       .corrected_line = move.line,
                       .u1 = is_last ? 1 : not_known,
                       .frame = segment.frame,
                       .commanded = way,
                       .turn = turn_of(job, move),
                       .end_only = !segment.cutting,
                       .exempt = !own || !original.may_split,
                       .exempt_end = !own || !takes_all_words(original) || (original.corners && !is_last)},
                      is_last});
    from = way.end;
  }
  return drafts;
}

constexpr double least_jump = 1e-9;  // m: of the correction

// Whether a jump precedes a segment, which does not begin where the one before it ends, by more than the
// digits of `first` show. Where the one before is not planned, or is in the window before, `first` alone
// shows it.
bool may_jump(const Job& job, const Plan& plan, std::size_t s, const Move& first) {
  const PlannedSegment& planned = plan.segments[s];
  if (planned.starts_anywhere || planned.knots.empty()) return false;
  const bool planned_before = s > 0 && !plan.segments[s - 1].knots.empty();
  if (planned_before &&
      (plan.segments[s - 1].knots.back().target - planned.start.target).norm() <= least_jump)
    return false;
  if (!all_known(first.known_start)) return true;
  const Move& original = job.program.moves[job.path.segments[s].move];
  const Vector3 off_mm = first.start_mm - in_words_mm(job, original, planned.start.target);
  WriteOptions as_read;
  as_read.decimals = most_decimals(first);
  const double half_digit =
      std::min({rounding_as_read(first), rounding_allowance(original, job.options.write),
                rounding_allowance(original, as_read)}) /
      std::sqrt(3.0);
  return off_mm.cwiseAbs().maxCoeff() * mm > half_digit + least_jump;
}

// Where the curves of the correction of an arc meet, by a step or without one.
void add_borders(const Curve& arc, const PlannedSegment& planned, std::vector<Knot>& knots) {
  for (std::size_t i = 1; i < planned.arc.size(); ++i) {
    const CorrectionCurve &before = planned.arc[i - 1], &behind = planned.arc[i];
    const double u = behind.begin();
    const Vector3 p = point_at(arc, u), ends = shift_of(before.at(before.end())),
                  begins = shift_of(behind.at(u));
    knots.push_back({{p + ends}, u});
    if ((begins - ends).norm() > least_jump) knots.push_back({{p + begins}, u});
  }
}

void settle(DraftPiece& draft, double u) {
  draft.piece.u1 = u;
  draft.settled = true;
}

// How far a piece ends from a knot (m).
double miss_of(const Segment& segment, const Piece& piece, const Knot& knot) {
  const double way = (piece.commanded.end - knot.target).norm();
  if (!is_found_by_turn(segment) || !piece.turn) return way;
  const Matrix3 R = exp_so3(knot.turn) * orientation_at(*segment.turn, knot.u);
  return std::hypot(way, way_of_turn * rotation_between(piece.turn->end, R).norm());
}

// Whether a piece from `next` on ends at a knot; `next` goes behind it.
bool find_knot(const Segment& segment, const Knot& knot, double rounding, std::vector<DraftPiece>& drafts,
               std::size_t& next) {
  std::size_t best = drafts.size();
  double best_miss = rounding;
  for (std::size_t j = next; j + 1 < drafts.size(); ++j) {
    const double miss = miss_of(segment, drafts[j].piece, knot);
    if (miss >= best_miss) continue;
    best = j;
    best_miss = miss;
  }
  if (best == drafts.size()) return false;
  settle(drafts[best], knot.u);
  next = best + 1;
  return true;
}

bool find_jump(const Segment& segment, const Knot& knot, double rounding, std::vector<DraftPiece>& drafts,
               std::size_t& next) {
  if (miss_of(segment, drafts[next].piece, knot) > rounding) return false;
  settle(drafts[next], knot.u);
  ++next;
  return true;
}

// Points that were inserted where the plan has a knot, to the rounding of its words, belong to its fraction.
// Where the force steps, one move ends on this side of the step and the next one on the other. Other points
// are projected: their fraction must not depend on the tolerance. Where the correction jumps, `read_rounding`
// is that of the words as read: a text of fewer digits has the same jumps, and other knots between them.
void find_knots(const Segment& segment, std::span<const Knot> knots, double rounding, double read_rounding,
                std::vector<DraftPiece>& drafts) {
  const auto with_turn = [&](double way) {
    return is_found_by_turn(segment) ? std::hypot(way, way_of_turn * turn_rounding) : way;
  };
  std::size_t next = 0;  // piece
  const Knot* last = nullptr;
  for (std::size_t k = 0; k < knots.size(); ++k) {
    if (next + 1 >= drafts.size()) return;
    const Knot& knot = knots[k];
    const bool jumps_there = knot.u == 0 || (k + 1 < knots.size() && knots[k + 1].u == knot.u) ||
                             (k > 0 && knots[k - 1].u == knot.u);
    const double near = with_turn(jumps_there ? read_rounding : rounding);
    const bool behind = last != nullptr && last->u == knot.u;
    const bool found =
        behind ? find_jump(segment, knot, near, drafts, next) : find_knot(segment, knot, near, drafts, next);
    last = found ? &knot : nullptr;
  }
}

// Targets at the corners of the force along an arc.
std::vector<Knot> corner_knots(const Job& job, const Plan& plan, std::size_t s) {
  std::vector<Knot> knots;
  const Curve& wanted = job.path.segments[s].wanted;
  if (!wanted.arc) return knots;
  for (const double u : job.forces.breaks(s))
    for (const CorrectionCurve& curve : plan.segments[s].arc)
      if (curve.begin() < u && u < curve.end())
        knots.push_back({{point_at(wanted, u) + shift_of(curve.at(u))}, u});
  return knots;
}

// How far a turn has come with the rotation `to`, as a vector: as the control counts it.
Vector3 turned_to(const Turn& turn, const Turn& to, bool at_end) {
  if (turn.angles && to.angles)
    return (at_end ? to.angles->end_deg : to.angles->start_deg) - turn.angles->start_deg;
  return log_so3(turn.start.transpose() * (at_end ? to.end : to.start));
}

// The correction of the turn changes evenly enough for a first guess.
void project_turn(const Turn& wanted, std::vector<DraftPiece>& drafts) {
  const Vector3 whole = turned_to(wanted, wanted, true),
                c0 = turned_to(wanted, *drafts.front().piece.turn, false),
                c1 = turned_to(wanted, *drafts.back().piece.turn, true) - whole;
  double last = 0;
  for (DraftPiece& draft : drafts) {
    draft.piece.u0 = last;
    if (!draft.settled) {
      const Vector3 to = turned_to(wanted, *draft.piece.turn, true);
      const double u = (to - c0).dot(whole) / (whole + c1 - c0).dot(whole);
      draft.piece.u1 = std::clamp(u, last, inner_end);
    }
    last = draft.piece.u1;
  }
}

// The correction changes evenly enough from one end of the segment to the other for a first guess. But along
// a ramp of the force that is shorter than what it deflects the tip along the feed: where its end rounds to
// an end of a move, within `rounding` (m), this is it.
void project(const Curve& wanted, std::span<const Knot> corners, double rounding,
             std::vector<DraftPiece>& drafts) {
  const Vector3 c0 = drafts.front().piece.commanded.start - wanted.start,
                c1 = drafts.back().piece.commanded.end - wanted.end;
  double last = 0;  // fraction
  for (DraftPiece& draft : drafts) {
    const Curve& way = draft.piece.commanded;
    draft.piece.u0 = last;
    if (!draft.settled) {
      double expected = 0;
      if (wanted.arc) {
        Arc shifted = *wanted.arc;
        shifted.centre += (1 - last) * c0 + last * c1;
        expected = last * wanted.arc->sweep + angle_about(shifted, way);
      }
      double u = wanted.arc ? expected / wanted.arc->sweep : last;
      for (int k = 0; k < 2; ++k) {
        const Vector3 p = way.end - (1 - u) * c0 - u * c1;
        u = wanted.arc ? fraction_on_arc(wanted, p, expected) : fraction_on_line(wanted, p);
      }
      draft.piece.u1 = std::clamp(u, last, inner_end);
      for (const Knot& corner : corners)
        if (corner.u > last && std::abs(corner.u - u) * wanted.arc->sweep < std::numbers::pi &&
            (way.end - corner.target).norm() <= rounding)
          settle(draft, corner.u);
    }
    last = draft.piece.u1;
  }
}

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

// By how much the tip is ahead of the fraction `u` (fraction), by the turn or by the place.
double lead_of(const Segment& segment, double u, const Pose& X_MT) {
  if (!is_found_by_turn(segment)) {
    const Vector3 miss = X_MT.p - point_at(segment.wanted, u);
    return miss.dot(direction_at(segment.wanted, u)) / length(segment.wanted);
  }
  const Turn& turn = *segment.turn;
  const Vector3 rate =
      rotation_between(orientation_at(turn, u + rate_step), orientation_at(turn, u - rate_step)) /
      (2 * rate_step);
  if (rate.isZero(0)) return 0;
  return rotation_between(X_MT.R, orientation_at(turn, u)).dot(rate) / rate.squaredNorm();
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
    const Segment& segment = job.path.segments[piece.segment];
    const double step = lead_of(segment, piece.u1, answers[k].X_MT);
    const double u = std::clamp(piece.u1 + secant_step(open[k], piece.u1, step), 0.0, inner_end);
    open[k].u = piece.u1;
    open[k].step = step;
    largest = std::max(largest, std::abs(u - piece.u1) * extent_of(segment));
    piece.u1 = next.u0 = u;
  }
  return largest < refined_enough;
}

// A first piece is one if its way is shorter than what rounding may leave of it.
bool is_jump(const Job& job, const Piece& piece) {
  if (piece.u1 <= piece.u0) return true;
  if (piece.u0 > 0 || piece.u1 == 1) return false;
  const Segment& segment = job.path.segments[piece.segment];
  const double rounding = is_found_by_turn(segment) ? way_of_turn * turn_rounding
                                                    : rounding_of(job, job.program.moves[segment.move]);
  return (piece.u1 - piece.u0) * extent_of(segment) < rounding;
}

}  // namespace

bool is_found_by_turn(const Segment& segment) {
  return segment.turn && length(segment.wanted) <= way_of_turn * turn_of(segment);
}

std::vector<Knot> inner_knots(const Job& job, const Plan& plan, std::size_t s, const Move& first) {
  const PlannedSegment& planned = plan.segments[s];
  std::vector<Knot> knots;
  if (may_jump(job, plan, s, first)) knots.push_back({planned.start, 0});
  if (planned.knots.size() > 1) knots.insert(knots.end(), planned.knots.begin(), planned.knots.end() - 1);
  add_borders(job.path.segments[s].wanted, planned, knots);
  return knots;
}

void add_pieces(const Job& job, const Plan& plan, const MatchedMoves& matched,
                std::vector<DraftPiece>& pieces) {
  std::vector<DraftPiece> drafts = drafts_of(job, matched);
  if (drafts.size() > 1) {
    const std::size_t s = *matched.segment;
    const Segment& segment = job.path.segments[s];
    find_knots(segment, inner_knots(job, plan, s, matched.first()),
               rounding_allowance(matched.original, job.options.write), rounding_of_points(job, matched),
               drafts);
    const bool turns = std::ranges::all_of(drafts, [](const DraftPiece& d) { return bool(d.piece.turn); });
    if (turns && is_found_by_turn(segment))
      project_turn(*segment.turn, drafts);
    else
      project(segment.wanted, corner_knots(job, plan, s), rounding_of(job, matched.original), drafts);
  }
  for (DraftPiece& draft : drafts) pieces.push_back(std::move(draft));
}

std::vector<Piece> refined(const Job& job, std::vector<DraftPiece> drafts) {
  std::vector<OpenEnd> open;
  for (std::size_t i = 0; i < drafts.size(); ++i)
    if (!drafts[i].settled) open.push_back({i});
  PlaceSolver solver(job);
  for (int k = 0; k < most_refinements && !open.empty(); ++k)
    if (refine(job, solver, open, drafts)) break;
  std::vector<Piece> pieces;
  pieces.reserve(drafts.size());
  std::optional<double> u0;       // where the piece behind a jump begins
  bool begins_as_planned = true;  // a jump may begin there
  for (DraftPiece& draft : drafts) {
    Piece& piece = draft.piece;
    if (u0) piece.u0 = *u0;
    u0.reset();
    if (piece.segment != no_segment && !piece.end_only && is_jump(job, piece)) {
      u0 = std::max(piece.u0, piece.u1);
      const bool is_left_out = std::exchange(begins_as_planned, draft.settled);
      if (is_left_out) continue;
      piece.u0 = piece.u1 = *u0;
    } else {
      begins_as_planned = true;
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace counterflex
