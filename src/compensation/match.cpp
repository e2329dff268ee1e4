// Which moves of a corrected program belong to which of the original: inserted blocks come before the block
// that they split, follow its path, and carry no number.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "counterflex/compensation/compensate.hpp"
#include "counterflex/geometry/units.hpp"
#include "emit.hpp"
#include "same_program.hpp"
#include "skeleton.hpp"

namespace counterflex {
namespace {

constexpr double longest_jump_mm = 1;   // longer first pieces are taken for pieces
constexpr double inner_end = 1 - 1e-9;  // only the last piece ends a move
constexpr double jump_length = 3;       // in allowances for rounding: shorter pieces are jumps

// How far a point on the way of a move is from its end, along the way (mm).
double way_left(const Move& original, const Vector3& p_mm, const Vector3& end_mm, double near_mm) {
  const double straight = (p_mm - end_mm).norm();
  if (!original.arc || straight < near_mm) return straight;
  const Curve curve = curve_of(original);
  const Arc& arc = *curve.arc;
  const Vector3 centre = arc.centre + end_mm - original.end_mm;
  return sweep_between(p_mm, end_mm, centre, arc.normal) * (end_mm - centre).norm();
}

bool makes_doubtful(const Move& move) {
  bool lost = move.block_delete;
  for (std::size_t axis = 0; axis < 3; ++axis)
    lost = lost || move.fixed[axis] || (move.known_start[axis] && !move.known_end[axis]);
  return lost;
}

class Matcher {
 public:
  Matcher(const Job& job, const Program& corrected) : job_(job), corrected_(corrected) {}

  // Stretch by stretch between lines that hold no move: what was inserted for a move lies in its own.
  std::vector<Piece> run() {
    const auto stretch = other_lines_before(job_.program), found = other_lines_before(corrected_);
    const auto& originals = job_.program.moves;
    for (std::size_t m = 0; m < originals.size();) {
      const std::size_t end = std::upper_bound(stretch.begin(), stretch.end(), stretch[m]) - stretch.begin();
      const std::size_t found_end = std::upper_bound(found.begin(), found.end(), stretch[m]) - found.begin();
      if (found_end < next_ + (end - m)) fail(originals[m], "the corrected program has fewer moves here");
      for (; m < end; ++m) {
        const std::size_t surplus = found_end - next_ - (end - m);
        const std::size_t own = m + 1 == end ? next_ + surplus : find(m, surplus);
        take(m, own);
        next_ = own + 1;
      }
    }
    return std::move(pieces_);
  }

 private:
  [[noreturn]] void fail(const Move& move, const std::string& what) const {
    throw InputError(Exit::not_compensated, {job_.program.file, move.line, 1}, what + " (verify)");
  }

  // Index of the corrected move that is original move m: same skeleton, and where its correction continues
  // the last one.
  std::size_t find(std::size_t m, std::size_t surplus) const {
    const Move& original = job_.program.moves[m];
    const std::string wanted = skeleton(job_.program, original);
    const Vector3 end = original.end_mm + correction_at_start(original, surplus);
    std::size_t best = std::numeric_limits<std::size_t>::max();
    double best_miss = std::numeric_limits<double>::infinity();
    for (std::size_t j = next_; j <= next_ + surplus; ++j) {
      const Move& candidate = corrected_.moves[j];
      if (candidate.motion == original.motion && skeleton(corrected_, candidate) == wanted) {
        const double miss = (candidate.end_mm - end).norm();
        if (miss < best_miss - 1e-9) best = j, best_miss = miss;
      }
      if (!is_plain(wanted)) break;  // no piece says the same: it is the first block, or none
      if (candidate.block_number && candidate.block_number == original.block_number) break;
      if (j > next_ && leaves(original, corrected_.moves[j - 1], candidate)) break;
    }
    if (best == std::numeric_limits<std::size_t>::max())
      fail(original,
           "no move of the corrected program continues this one with the same words (motion, F, S, M)");
    return before_jump(m, last_piece(original, end, best, best_miss, next_ + surplus));
  }

  // Where the force steps between this move and the next, the next one's jump stands right behind this one's
  // end, and may look more like it than the end itself.
  std::size_t before_jump(std::size_t m, std::size_t own) const {
    if (!steps_after(m) || own == next_) return own;
    const Vector3 step = corrected_.moves[own].end_mm - corrected_.moves[own - 1].end_mm;
    return step.norm() < longest_jump_mm ? own - 1 : own;
  }

  bool steps_after(std::size_t m) const {
    const auto& segments = job_.path.segments;
    if (job_.options.blend > 0 || segment_ + 1 >= segments.size() || segments[segment_].move != m)
      return false;
    return job_.forces.at(segment_, 1) != job_.forces.at(segment_ + 1, 0);
  }

  // A block whose words act at its beginning is itself the first piece: the others follow it.
  std::size_t last_piece(const Move& original, const Vector3& end_mm, std::size_t own, double miss,
                         std::size_t last) const {
    std::size_t best = own;
    const bool first = original.may_split && !is_plain(skeleton(job_.program, original));
    for (std::size_t j = own + 1; first && j <= last; ++j) {
      const Move& candidate = corrected_.moves[j];
      if (candidate.block_number || candidate.motion != original.motion ||
          !is_plain(skeleton(corrected_, candidate)) || leaves(original, corrected_.moves[j - 1], candidate))
        break;
      const double other = (candidate.end_mm - end_mm).norm();
      if (other < miss - 1e-9) best = j, miss = other;
    }
    return best;
  }

  // The correction with which a move is entered (mm): a first piece that hardly leaves the start is a jump to
  // another one.
  Vector3 correction_at_start(const Move& original, std::size_t surplus) const {
    if (surplus == 0 || original.motion != Motion::feed || !all_known(original.known_start))
      return correction_mm_;
    const Vector3 first = corrected_.moves[next_].end_mm - original.start_mm;
    const double length = counterflex::length(curve_of(original));
    return (first - correction_mm_).norm() < std::min(0.2 * length, longest_jump_mm) ? first : correction_mm_;
  }

  // Whether going on from a to b no longer comes closer to the end of the original move.
  bool leaves(const Move& original, const Move& a, const Move& b) const {
    const Vector3 end = original.end_mm + correction_mm_;
    const double near = job_.options.max_correction / mm;
    return way_left(original, b.end_mm, end, near) > way_left(original, a.end_mm, end, near) + near;
  }

  // Inserted blocks say motion, axes and F, and the F is the one that acts.
  void check_inserted(const Move& original, std::size_t own) const {
    const std::string wanted = skeleton(job_.program, original);
    std::size_t own_blocks = 0;
    for (std::size_t j = next_; j <= own; ++j) {
      const Move& move = corrected_.moves[j];
      const std::string found = skeleton(corrected_, move);
      if (found == wanted) ++own_blocks;
      const bool plain =
          is_plain(found) && found.find_first_of("(;") == std::string::npos && !move.block_number;
      const bool same_motion = move.motion == original.motion || (j < own && move.motion == Motion::feed);
      const bool same_feed = move.motion == Motion::rapid || move.feed_mode == FeedMode::inverse_time ||
                             move.feed_mm_min == original.feed_mm_min;
      if ((found != wanted && !plain) || !same_motion || !same_feed)
        throw InputError(Exit::not_compensated, {corrected_.file, move.line, 1},
                         "an inserted block may state motion, axes and the feed that acts, nothing else");
    }
    if (own_blocks == 0 || (own_blocks > 1 && !is_plain(wanted)))
      fail(original, "its words stand in no block, or in several, of the corrected program");
  }

  void take(std::size_t m, std::size_t own) {
    const Move& original = job_.program.moves[m];
    check_inserted(original, own);
    const bool has_segment = segment_ < job_.path.segments.size() && job_.path.segments[segment_].move == m;
    if (has_segment && original.cycle)
      ++segment_;
    else if (has_segment)
      take_segment(own);
    if (original.cycle && original.known_end[0] && original.known_end[1]) take_hole(original, own);
    const bool known = all_known(original.known_end);
    if (known) correction_mm_ = corrected_.moves[own].end_mm - original.end_mm;
    if (known && !has_segment && !all_known(original.known_start) && !original.cycle)
      pieces_.push_back({.segment = no_segment,
                         .line = original.line,
                         .frame = original.offset,
                         .commanded = {position(own), position(own), {}},
                         .wanted = wanted_of(job_, original),
                         .end_only = true,
                         .exempt_end = !is_own(original) || !original.may_insert_words ||
                                       (skipped_ && original.motion == Motion::feed)});
    skipped_ = makes_doubtful(original) || (skipped_ && !known);
  }

  static bool is_own(const Move& move) { return move.handling == Handling::own; }

  void take_hole(const Move& original, std::size_t own) {
    const Move& found = corrected_.moves[own];
    if (!found.cycle) fail(original, "this cycle is none in the corrected program");
    const WorkFrame& frame = job_.path.frames[original.offset];
    const Vector3 bottom = frame.X_MW * (bottom_of(found) * mm);
    const bool takes_z = original.cycle->bottom_word || original.cycle->may_insert_bottom;
    pieces_.push_back({.segment = no_segment,
                       .line = original.line,
                       .frame = original.offset,
                       .commanded = {bottom, bottom, {}},
                       .wanted = wanted_frame(frame) * (bottom_of(original) * mm),
                       .end_only = true,
                       .exempt_end = !is_own(original) || !takes_z});
  }

  // The fraction of an inserted point, by its place along the segment: on a line
  // position = start + u along + (1 - u) c0 + u c1.
  static double fraction_at(const Curve& wanted, const Vector3& p, const Vector3& c0, const Vector3& c1) {
    if (wanted.arc) {
      const Vector3 about = wanted.arc->centre + (c0 + c1) / 2;
      return sweep_between(wanted.start + c0, p, about, wanted.arc->normal) / wanted.arc->sweep;
    }
    const Vector3 shift = wanted.end - wanted.start + c1 - c0;
    return (p - wanted.start - c0).dot(shift) / shift.squaredNorm();
  }

  Curve commanded(std::size_t j, const Vector3& from) const {
    const Move& move = corrected_.moves[j];
    return all_known(move.known_start) ? command_of(job_, move) : Curve{from, position(j), {}};
  }

  // First fractions of inserted points: by their place along the segment, the correction there interpolated.
  void take_segment(std::size_t own) {
    const Segment& segment = job_.path.segments[segment_];
    const Move& original = job_.program.moves[segment.move];
    const Move& first = corrected_.moves[next_];
    const Vector3 start = all_known(first.known_start) ? command_of(job_, first).start : segment.wanted.start;
    const Vector3 c0 = start - segment.wanted.start, c1 = position(own) - segment.wanted.end;
    double u0 = 0;
    for (std::size_t j = next_; j <= own; ++j) {
      double u = 1;
      if (j < own) u = std::clamp(fraction_at(segment.wanted, position(j), c0, c1), u0, inner_end);
      Piece piece{.segment = segment_,
                  .line = segment.line,
                  .u0 = u0,
                  .u1 = u,
                  .frame = segment.frame,
                  .commanded = commanded(j, j == next_ ? start : position(j - 1)),
                  .end_only = !segment.cutting,
                  .exempt = !is_own(original) || !original.may_split,
                  .exempt_end = !is_own(original) || !original.may_insert_words};
      const std::optional<double> step = j + 1 < own ? step_at(j, u) : std::nullopt;
      if (step) piece.u1 = u = std::max(*step, u0);
      if (u > u0) pieces_.push_back(piece);
      u0 = u;
      if (step) ++j;  // the jump itself: what follows begins at its end
    }
    ++segment_;
  }

  // The fraction of the force's step that the moves j and j + 1, near fraction u, stand on both sides of.
  std::optional<double> step_at(std::size_t j, double u) const {
    const Segment& segment = job_.path.segments[segment_];
    const double longest = longest_jump_mm * mm, length = counterflex::length(segment.wanted);
    if (job_.options.blend > 0 || (position(j + 1) - position(j)).norm() > longest) return std::nullopt;
    for (const double step : job_.forces.breaks(segment_))
      if (std::abs(step - u) * length < longest) return step;
    return std::nullopt;
  }

  Vector3 position(std::size_t j) const { return target_of(job_, corrected_.moves[j]); }

  const Job& job_;
  const Program& corrected_;
  std::vector<Piece> pieces_;
  std::size_t next_ = 0, segment_ = 0;
  Vector3 correction_mm_ = Vector3::Zero();
  bool skipped_ = false;  // a '/' block made the position unknown: feed moves behind it are held, not judged
};

// Whether the fraction of a piece's end is known: an end of a segment, or a step of the force.
bool is_settled(const Job& job, const Piece& piece) {
  if (piece.u1 >= 1 || piece.segment == no_segment) return true;
  const std::vector<double> breaks = job.forces.breaks(piece.segment);
  return job.options.blend == 0 && std::find(breaks.begin(), breaks.end(), piece.u1) != breaks.end();
}

// An inserted point stands where it puts the tip: its fraction is that of the tip's place along the segment.
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

// A jump of the correction goes nowhere along the path: what it passes through is judged by nobody.
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

}  // namespace

std::vector<Piece> match_programs(const Job& job, const Program& corrected) {
  check_other_lines(job.program, corrected);
  std::vector<Piece> pieces = Matcher(job, corrected).run();
  refine_fractions(job, pieces);
  drop_jumps(job, pieces);
  check_all_moves(job, corrected, pieces);
  return pieces;
}

}  // namespace counterflex
