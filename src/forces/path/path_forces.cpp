#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <span>

#include "counterflex/forces/forces.hpp"
#include "forces/path/profile/alignment.hpp"
#include "forces/path/raw_forces.hpp"
#include "forces/turning_axes.hpp"

namespace counterflex {
namespace {

constexpr std::size_t no_run = std::numeric_limits<std::size_t>::max();

// Steps below this part of the wrench are rounding.
constexpr double rounding = 1e-9;

// Segments whose ends are closer than this join (m). Shorter blends are ignored.
constexpr double joined_m = 1e-9;

bool moves_rapidly(const Move& move) {
  return move.motion == Motion::rapid && !(all_known(move.known_start) && all_known(move.known_end));
}

/// Whether moves [first, end) include a rapid without a segment.
bool rapid_among(const Program& program, std::size_t first, std::size_t end) {
  const auto moves = program.moves.begin();
  return std::any_of(moves + static_cast<std::ptrdiff_t>(first), moves + static_cast<std::ptrdiff_t>(end),
                     moves_rapidly);
}

bool joins(const Vector3& end, const Segment& segment) {
  return segment.cutting && (segment.wanted.start - end).norm() <= joined_m;
}

/// Whether cutting continues from segment i - 1 to segment i, without a rapid between them, even one without
/// a segment.
bool joins_previous(const Program& program, const Toolpath& path, std::size_t i) {
  const Segment& before = path.segments[i - 1];
  const Segment& segment = path.segments[i];
  return before.cutting && joins(before.wanted.end, segment) &&
         !rapid_among(program, before.move + 1, segment.move);
}

/// From the start of the run to s.
Vector6 integral(const ForcePiece& piece, double s) {
  return piece.integral + (s - piece.s0) * value(piece, (piece.s0 + s) / 2);
}

bool differ(const Vector6& A, const Vector6& B) {
  return (A - B).norm() > rounding * std::max(A.norm(), B.norm());
}

/// Whether the slope changes at the start of a piece, behind one with the slope `before`.
bool bends(const Vector6& before, const ForcePiece& piece) {
  const double change = (slope(piece) - before).norm() * (piece.s1 - piece.s0);
  return change > rounding * std::max(piece.F0.norm(), piece.F1.norm());
}

/// The first index in [first, end) that is not `before` the wanted place, else `end`; `hint` is the previous
/// result.
template <class Before>
std::size_t first_not(std::size_t hint, std::size_t first, std::size_t end, const Before& before) {
  constexpr int steps_beside = 6;
  std::size_t i = std::clamp(hint, first, end);
  for (int step = 0; step < steps_beside; ++step) {
    if (i < end && before(i))
      first = ++i;
    else if (i > first && !before(i - 1))
      end = --i;
    else
      return i;
  }
  while (first < end) {
    const std::size_t half = first + (end - first) / 2;
    before(half) ? first = half + 1 : end = half;
  }
  return first;
}

/// The piece of the run that contains s. Where two meet, the one on `side`.
const ForcePiece& piece_at(const std::vector<ForcePiece>& pieces, const FeedRun& run, double s, Side side,
                           std::size_t& hint) {
  const std::size_t last = run.end_piece - 1;
  hint = side == Side::before
             ? first_not(hint, run.first_piece, last, [&](std::size_t i) { return pieces[i].s1 < s; })
             : first_not(hint, run.first_piece, last, [&](std::size_t i) { return pieces[i].s1 <= s; });
  return pieces[hint];
}

/// 1/b int_(s-b)^s f(u) du, f zero before the run.
Vector6 mean(const std::vector<ForcePiece>& pieces, const FeedRun& run, double s, ForceCursor& cursor) {
  const bool full = s - run.blend >= run.s0;
  const double from = full ? s - run.blend : run.s0, part = full ? 1 : (s - run.s0) / run.blend;
  const ForcePiece& first = piece_at(pieces, run, from, Side::after, cursor.from);
  const ForcePiece& last = piece_at(pieces, run, s, Side::before, cursor.to);
  if (from >= s) return Vector6::Zero();
  // Within one piece the mean is the value in the middle, free of the rounding of long integrals.
  if (&first == &last) return part * value(first, (from + s) / 2);
  return (integral(last, s) - integral(first, from)) / run.blend;
}

/// f at both ends of [a, b], where it is linear between them; zero before the run.
std::optional<std::pair<Vector6, Vector6>> linear_between(const std::vector<ForcePiece>& pieces,
                                                          const FeedRun& run, double a, double b,
                                                          std::size_t& hint) {
  if (b <= run.s0 + joined_m) return std::pair(Vector6::Zero().eval(), Vector6::Zero().eval());
  const double inside = (b - a) / 1000;  // a and b are rounded
  const ForcePiece& first = piece_at(pieces, run, a + inside, Side::after, hint);
  const ForcePiece& last = piece_at(pieces, run, b - inside, Side::before, hint);
  const Vector6 at_b = value(last, b);
  if (differ(value(first, b), at_b)) return std::nullopt;
  return std::pair(value(first, a), at_b);
}

/// Whether the feed run of the previous window continues in this one.
bool continues_run(const std::optional<OpenRun>& before, const Program& window, const Toolpath& path) {
  if (!before || path.segments.empty()) return false;
  const Segment& first = path.segments.front();
  return joins(before->end, first) && !rapid_among(window, 0, first.move);
}

ForceSource settled(ForceSource source, const Program& program, const Toolpath& path) {
  ForceCover cover(source);
  while (cover.needs_pass()) {
    cover.add(program, path);
    cover.end_pass();
  }
  return source;
}

constexpr double unknown_length = std::numeric_limits<double>::quiet_NaN();

/// Steps of a feed run, counted along the run, become path lengths. `places`: where `segments` lie in the
/// run.
template <typename Place>
void to_path_lengths(std::span<const Segment> segments, std::span<Place> places, std::span<double> steps) {
  for (double& step : steps) {
    const auto at = std::ranges::lower_bound(places, step, {}, &Place::s1);
    assert(at != places.end());
    const Segment& segment = segments[static_cast<std::size_t>(at - places.begin())];
    step = std::min(segment.s_start + (step - at->s0), segment.s_end);
  }
}

}  // namespace

PathForces::PathForces(const ForceSource& source, const Program& program, const Toolpath& path,
                       const std::vector<Matrix3>& R_MT)
    : PathForces(settled(source, program, path), program, path, R_MT, {}) {}

PathForces::PathForces(const ForceSource& source, const Program& window, const Toolpath& path,
                       const std::vector<Matrix3>& R_MT, const ForceTail& before,
                       const std::vector<Matrix3>& R_at_holes)
    : at_platform_(acts_at_platform(source)) {
  tail_.block_number = before.block_number;
  if (path.segments.empty() && !rapid_among(window, 0, window.moves.size())) tail_.open = before.open;
  RawForces raw_forces(source, window, path, R_MT, tail_.block_number);
  ForceRemarks remarks;
  std::size_t next_move = 0, hole = 0;
  const auto add_others_to = [&](std::size_t end) {
    for (; next_move < end; ++next_move) {
      if (!drills(window.moves[next_move])) {
        if (std::string why = why_unplaced(window, path, next_move); !why.empty())
          remarks.unforced.push_back({window.moves[next_move].line, unknown_length, std::move(why)});
        continue;
      }
      const Matrix3& R = R_at_holes.empty() ? R_MT.front() : R_at_holes[hole++];
      const Vector6 F = raw_forces.in_hole(next_move, R, remarks);
      if (!F.isZero(0)) holes_.emplace_back(next_move, F);
    }
  };
  places_.reserve(path.segments.size());
  pieces_.reserve(path.segments.size() + (before.open ? before.open->pieces.size() : 0));
  bool open = continues_run(before.open, window, path);
  // Where the run has come. Segments that only turn the tool count: this may be more than the path length.
  double reached = 0;
  std::size_t first_segment = 0;
  if (open) {
    take_up(*before.open);
    reached = before.open->run.s1;
  }
  const auto close = [&] {
    const std::size_t first_step = steps_.size();
    close_run(source.blend);
    to_path_lengths(std::span(path.segments).subspan(first_segment),
                    std::span(places_).subspan(first_segment), std::span(steps_).subspan(first_step));
  };
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    const Segment& segment = path.segments[i];
    add_others_to(segment.move);
    if (i > 0 && open && !joins_previous(window, path, i)) {
      close();
      open = false;
    }
    if (segment.cutting && !open) {
      reached = segment.s_start;
      first_segment = i;
      runs_.push_back({segment.s_start, segment.s_start, 0, pieces_.size(), 0, corners_.size(), 0});
      open = true;
    }
    // A cycle of G-code drills away from the end of its move, one that is called drills there.
    const bool calls = window.moves[segment.move].makes_hole;
    const std::size_t holes_move = calls ? segment.move : no_run;
    if (!open) {
      places_.push_back({segment.s_start, segment.s_end, no_run, holes_move});
      continue;
    }
    const double shift = reached - segment.s_start, end = force_end(segment) + shift;
    places_.push_back({reached, end, runs_.size() - 1, holes_move});
    raw_forces.append_to(i, shift, runs_.back().first_piece, pieces_, remarks);
    reached = end;
  }
  add_others_to(window.moves.size());
  notes_ = std::move(remarks.notes);
  unforced_ = std::move(remarks.unforced);
  if (!open) return;
  close();
  leave_tail(window, path, source.blend);
}

void PathForces::take_up(const OpenRun& before) {
  pieces_.assign(before.pieces.begin(), before.pieces.end());  // keeps the capacity
  corners_ = before.corners;
  taken_up_ = pieces_.size();
  runs_.push_back(before.run);
}

void PathForces::close_run(double blend) {
  FeedRun& run = runs_.back();
  run.end_piece = pieces_.size();
  run.s1 = pieces_.back().s1;
  run.blend = std::min(blend, (run.s1 - run.s0) / 2);
  if (run.blend < joined_m) run.blend = 0;
  Vector6 sum = pieces_[run.first_piece].integral;
  for (std::size_t i = run.first_piece; i < run.end_piece; ++i) {
    pieces_[i].integral = sum;
    pieces_[i].is_constant = pieces_[i].F0 == pieces_[i].F1;
    is_linear_between_breaks_ = is_linear_between_breaks_ && pieces_[i].is_constant;
    sum = integral(pieces_[i], pieces_[i].s1);
  }
  find_corners(run);
}

// The last run, and whether it can continue: a rapid ends it, even one without a segment.
void PathForces::leave_tail(const Program& window, const Toolpath& path, double blend) {
  const FeedRun& run = runs_.back();
  const Segment& last = path.segments.back();
  if (!last.cutting || rapid_among(window, last.move + 1, window.moves.size())) return;
  const std::optional<Move>& after = window.after;
  const bool ends = !after || (after->motion == Motion::rapid && after->start_mm != after->end_mm);
  is_final_ = ends || run.s1 - run.s0 >= 2 * blend;
  OpenRun open{run, last.wanted.end, {}, {}};
  open.run.first_piece = open.run.first_corner = 0;
  const double acts_from = run.s1 - blend;
  for (std::size_t i = run.first_piece; i < run.end_piece; ++i)
    if (pieces_[i].s1 >= acts_from) open.pieces.push_back(pieces_[i]);
  for (std::size_t i = run.first_corner; i < run.end_corner; ++i)
    if (corners_[i] >= acts_from) open.corners.push_back(corners_[i]);
  tail_.open = std::move(open);
}

void PathForces::find_corners(FeedRun& run) {
  std::size_t& steps = run.blend > 0 ? ramps_ : jumps_;
  // Corners of pieces of an earlier window were reported there.
  for (std::size_t i = std::max(run.first_piece, taken_up_); i < run.end_piece; ++i) {
    if (pieces_[i].goes_on) continue;
    const bool entry = i == run.first_piece;
    const Vector6 before = entry ? Vector6::Zero() : pieces_[i - 1].F1;
    const bool step = differ(before, pieces_[i].F0);
    const bool bend = bends(entry ? Vector6::Zero() : slope(pieces_[i - 1]), pieces_[i]);
    if (step) {
      ++steps;
      steps_.push_back(pieces_[i].s0);
      largest_step_N_ = std::max(largest_step_N_, (pieces_[i].F0 - before).head<3>().norm());
    }
    if (step || bend) corners_.push_back(pieces_[i].s0);
  }
  run.end_corner = corners_.size();
}

Vector6 PathForces::in_hole(std::size_t move) const {
  const auto found = std::ranges::lower_bound(holes_, move, {}, [](const auto& hole) { return hole.first; });
  return found == holes_.end() || found->first != move ? Vector6::Zero() : found->second;
}

bool PathForces::begins_run(std::size_t segment) const {
  const std::size_t run = places_[segment].run;
  if (run == no_run) return false;
  return segment == 0 ? taken_up_ == 0 : places_[segment - 1].run != run;
}

bool PathForces::follows(std::size_t segment) const {
  if (segment == 0 || places_[segment].run == no_run) return false;
  const Place &place = places_[segment], &before = places_[segment - 1];
  return place.run == before.run && place.s0 == before.s1 && runs_[place.run].blend > 0;
}

bool PathForces::begins_with_step(std::size_t segment) const {
  const Place& place = places_[segment];
  if (place.run == no_run || runs_[place.run].blend > 0 || begins_run(segment)) return false;
  const FeedRun& run = runs_[place.run];
  ForceCursor cursor;
  const ForcePiece &before = piece_at(pieces_, run, place.s0, Side::before, cursor.from),
                   &after = piece_at(pieces_, run, place.s0, Side::after, cursor.to);
  return differ(value(before, place.s0), value(after, place.s0));
}

Vector6 PathForces::at(std::size_t segment, double fraction, Side side) const {
  ForceCursor cursor;
  return at(segment, fraction, side, cursor);
}

Vector6 PathForces::at(std::size_t segment, double fraction, Side side, ForceCursor& cursor) const {
  const Place& place = places_[segment];
  if (place.run == no_run) return fraction >= 1 ? in_hole(place.move) : Vector6::Zero();
  const FeedRun& run = runs_[place.run];
  if (fraction <= 0) side = Side::after;
  if (fraction >= 1) side = Side::before;
  const double inside = place.s0 + fraction * (place.s1 - place.s0);
  const double s = fraction >= 1 ? place.s1 : std::clamp(inside, place.s0, place.s1);
  if (run.blend > 0) return mean(pieces_, run, s, cursor);
  // A fraction from `breaks` may round to the other side of its step.
  const double margin = (side == Side::before ? -1 : 1) * same_fraction * (place.s1 - place.s0);
  const double beside = std::clamp(s + margin, place.s0, place.s1);
  const ForcePiece& piece = piece_at(pieces_, run, beside, side, cursor.to);
  return value(piece, std::clamp(s, piece.s0, piece.s1));
}

std::vector<double> PathForces::breaks(std::size_t segment) const {
  ForceCursor cursor;
  std::vector<double> fractions;
  breaks(segment, cursor, fractions);
  return fractions;
}

void PathForces::breaks(std::size_t segment, ForceCursor& cursor, std::vector<double>& fractions) const {
  fractions.clear();
  const Place& place = places_[segment];
  if (place.run == no_run) return;
  const FeedRun& run = runs_[place.run];
  const auto add = [&](double s) {
    const double fraction = (s - place.s0) / (place.s1 - place.s0);
    if (fraction > same_fraction && fraction < 1 - same_fraction) fractions.push_back(fraction);
  };
  const auto add_shifted = [&](double shift, std::size_t& hint) {
    hint = first_not(hint, run.first_corner, run.end_corner,
                     [&](std::size_t i) { return corners_[i] < place.s0 - shift; });
    for (std::size_t i = hint; i < run.end_corner && corners_[i] + shift < place.s1; ++i)
      add(corners_[i] + shift);
  };
  // A step at p changes the slope of the mean at p and at p + b, a bend changes its curvature there.
  add_shifted(0, cursor.corner);
  if (run.blend > 0) add_shifted(run.blend, cursor.ramp_corner);
  const auto same = [](double a, double b) { return b - a < same_fraction; };
  std::sort(fractions.begin(), fractions.end());
  fractions.erase(std::unique(fractions.begin(), fractions.end(), same), fractions.end());
  if (run.blend == 0 || is_linear_between_breaks_) return;
  add_extremes(place, cursor, fractions);
  std::sort(fractions.begin(), fractions.end());
}

// Between corners the mean is a parabola of the path length. Adds the fractions where a component is larger
// or less there than at both ends by what reports show.
void PathForces::add_extremes(const Place& place, ForceCursor& cursor, std::vector<double>& fractions) const {
  const FeedRun& run = runs_[place.run];
  const auto path_length = [&](double u) { return place.s0 + u * (place.s1 - place.s0); };
  const std::size_t corners = fractions.size();
  for (std::size_t k = 0; k <= corners; ++k) {
    const double u0 = k == 0 ? 0 : fractions[k - 1], u1 = k == corners ? 1 : fractions[k];
    const double a = path_length(u0), b = path_length(u1);
    const auto enters = linear_between(pieces_, run, a, b, cursor.to);
    const auto leaves = linear_between(pieces_, run, a - run.blend, b - run.blend, cursor.from);
    if (!enters || !leaves) continue;  // axes that turn: places are at angles
    const Vector6 slope_a = (enters->first - leaves->first) / run.blend,
                  slope_b = (enters->second - leaves->second) / run.blend;
    for (int i = 0; i < 6; ++i) {
      if (slope_a[i] * slope_b[i] >= 0) continue;
      const double t = slope_a[i] / (slope_a[i] - slope_b[i]);
      const double beyond = std::min(std::abs(slope_a[i]) * t, std::abs(slope_b[i]) * (1 - t)) * (b - a) / 2;
      if (beyond > (i < 3 ? shown_force : shown_moment)) fractions.push_back(u0 + t * (u1 - u0));
    }
  }
}

}  // namespace counterflex
