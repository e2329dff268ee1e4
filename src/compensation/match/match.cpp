#include "compensation/match/match.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compensation/match/match_pieces.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// Whether the move's height is a word of a block before it: Q203 of a cycle's definition, MCALL.
bool takes_surface(const Move& move) {
  if (move.called) return !move.called->modal.empty();
  return move.words[2] && move.words[2]->number.begin < move.block.begin;
}

// MCALL with its cycle, without blanks and without the heights.
std::string without_heights(const CalledCycle& cycle) {
  std::string text;
  for (std::size_t i = 0; i < cycle.modal.size(); ++i) {
    const bool height = std::any_of(
        cycle.heights.begin(), cycle.heights.end(),
        [i](const PackedAxisWord& word) { return word && i >= word->number.begin && i < word->number.end; });
    if (!height && cycle.modal[i] != ' ' && cycle.modal[i] != '\t') text += cycle.modal[i];
  }
  return text;
}

class WindowMatcher {
 public:
  WindowMatcher(const Job& job, const PlannedWays& ways, CorrectedMoves& found)
      : job_(job), ways_(ways), found_(found), finder_(job, ways, found) {}

  // The drafts of the window's pieces, up to a failure.
  std::optional<Failure> run(const std::vector<std::size_t>& others) {
    for (std::size_t m = 0; m < job_.program.moves.size(); ++m)
      if (auto failure = match(m, others[m])) return failure;
    return std::nullopt;
  }

  std::vector<DraftPiece> drafts{};

 private:
  using Segments = std::vector<Segment>;

  std::optional<Failure> match(std::size_t m, std::size_t others) {
    const Move& original = job_.program.moves[m];
    const Segments& segments = job_.path.segments;
    std::optional<std::size_t> segment;
    if (next_segment_ < segments.size() && segments[next_segment_].move == m) segment = next_segment_++;
    const MatchedMoves matched{original, segment, finder_.find(m, segment, others)};
    if (matched.found.empty()) return not_found(original, others);
    if (auto failure = frame_failure(matched)) return failure;
    if (auto failure = kind_failure(job_, matched)) return failure;
    if (auto failure = surface_failure(matched)) return failure;
    if (auto failure = call_failure(matched)) return failure;
    if (auto failure = shift_failure(matched, m)) return failure;
    if (auto failure = contour_failure(matched, m)) return failure;
    if (auto failure = corner_failure(matched)) return failure;
    if (auto failure = words_failure(job_, matched)) return failure;
    if (segment && !original.cycle) add_pieces(job_, ways_, matched, drafts);
    add_hole(matched);
    add_position(matched);
    last_line_ = matched.found.back().move->line;
    found_.drop(matched.found.size());
    skipped_ = leaves_doubt(original, skipped_);
    return std::nullopt;
  }

  // After a word of an axis has been shifted, no word of it is unshifted until the axis has gone to a
  // position of the machine. Where the deviation is judged a correction may be nothing.
  std::optional<Failure> shift_failure(const MatchedMoves& matched, std::size_t m) {
    constexpr double unshifted_mm = 1e-9;
    const Move &original = matched.original, &found = *matched.found.back().move;
    forget_lost_axes(m);
    const bool judged = all_known(original.known_end) &&
                        (original.handling == Handling::own || original.handling == Handling::group);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!original.words[axis] || !found.words[axis] || original.relative || found.relative) continue;
      const auto k = static_cast<Eigen::Index>(axis);
      const double shift = found.end_mm[k] - original.end_mm[k], before = shifts_mm_[axis].value_or(0);
      if (!judged && std::abs(shift) < unshifted_mm && std::abs(before) > job_.options.tolerance / mm)
        return Failure{
            ErrorKind::not_compensated, original.line,
            fmt::format("{} is the same as in the original, but the moves before it are shifted by {:.4f} mm",
                        "XYZ"[axis], before),
            found.line};
      shifts_mm_[axis] = shift;
    }
    return std::nullopt;
  }

  // Contours are shifted and turned in the plane: each way inside keeps its length there.
  std::optional<Failure> contour_failure(const MatchedMoves& matched, std::size_t m) {
    const Move &original = matched.original, &first = *matched.found.front().move,
               &found = *matched.found.back().move;
    const bool inside = m > 0 && original.group != 0 && job_.program.moves[m - 1].group == original.group;
    if (!inside || !all_known(original.known_start) || !all_known(original.known_end) ||
        !all_known(first.known_start))
      return std::nullopt;
    const double rounding_mm = roundings * std::max(rounding_as_read(original), rounding_as_read(found)) / mm;
    const double off = (found.end_mm - first.start_mm).head<2>().norm() -
                       (original.end_mm - original.start_mm).head<2>().norm();
    if (std::abs(off) <= rounding_mm + 1e-6) return std::nullopt;
    return Failure{
        ErrorKind::not_compensated, original.line,
        fmt::format(
            "this move of a contour is {:.4f} mm {} in X and Y than that of the original; contours are "
            "shifted and turned as a whole",
            std::abs(off), off > 0 ? "longer" : "shorter"),
        found.line};
  }

  // What the control takes off a line for its corners is one piece, at one height.
  std::optional<Failure> corner_failure(const MatchedMoves& matched) const {
    const Move& original = matched.original;
    if (!original.corners || original.words[2] || !all_known(original.known_start)) return std::nullopt;
    const double length_mm = (original.end_mm - original.start_mm).norm();
    const auto check = [&](const Move& found, double taken_mm) -> std::optional<Failure> {
      const Vector3 way = found.end_mm - found.start_mm;
      const bool whole = way.norm() > taken_mm || taken_mm >= length_mm;
      if (taken_mm == 0 || !all_known(found.known_start) || (way.z() == 0 && whole)) return std::nullopt;
      const std::string size = std::isfinite(taken_mm) ? fmt::format("{:.4f} mm", taken_mm) : "a part";
      return Failure{
          ErrorKind::not_compensated, original.line,
          fmt::format(
              "the corner takes {} of this block, which is {:.4f} mm long and changes its height by {:.4f} "
              "mm; corners lie in one plane",
              size, way.norm(), way.z()),
          found.line};
    };
    if (auto failure = check(*matched.found.front().move, original.corners->begin_mm)) return failure;
    return check(*matched.found.back().move, original.corners->end_mm);
  }

  // The surface from which the held holes of a Klartext cycle count goes along with them: they keep the shift
  // with which they are entered. The others are judged where they are.
  std::optional<Failure> surface_failure(const MatchedMoves& matched) {
    constexpr double rounding_mm = 1e-3 * (1 + 1e-9);  // of both, to three decimals
    const Move &original = matched.original, &found = *matched.found.back().move;
    const double shift = found.end_mm.z() - original.end_mm.z();
    if (takes_surface(original) != takes_surface(found))
      return Failure{
          ErrorKind::not_compensated, original.line,
          "this hole takes the height of its surface from a cycle's definition in one of both programs only",
          found.line};
    const bool held = original.handling == Handling::held;
    if (takes_surface(original) && held && std::abs(shift - height_shift_mm_) > rounding_mm)
      return Failure{
          ErrorKind::not_compensated, original.line,
          fmt::format("the surface of this hole's cycle is shifted by {:.4f} mm, the hole by {:.4f} mm",
                      shift, height_shift_mm_),
          found.line};
    if (!takes_surface(original) && original.known_end[2] && found.known_end[2]) height_shift_mm_ = shift;
    return std::nullopt;
  }

  // All heights of a called cycle go along with its reference plane, the first of them.
  std::optional<Failure> call_failure(const MatchedMoves& matched) const {
    constexpr double rounding_mm = 1e-3 * (1 + 1e-9);  // of both, to three decimals
    const Move &original = matched.original, &found = *matched.found.back().move;
    const auto fail = [&](std::string what) {
      return Failure{ErrorKind::not_compensated, original.line, std::move(what), found.line};
    };
    if (!original.called != !found.called)
      return fail("a drilling cycle is called here in one of both programs only");
    if (!original.called) return std::nullopt;
    if (without_heights(*original.called) != without_heights(*found.called))
      return fail("the cycle that MCALL calls here is not that of the original");
    const double shift = found.end_mm.z() - original.end_mm.z();
    for (std::size_t i = 0; i < original.called->heights.size(); ++i) {
      if (!original.called->heights[i] != !found.called->heights[i])
        return fail("a height of the cycle is given in one of both programs only");
      const double other = found.called->heights_mm[i] - original.called->heights_mm[i];
      if (original.called->heights[i] && std::abs(other - shift) > rounding_mm)
        return fail(fmt::format(
            "a height of the cycle is shifted by {:.4f} mm, its reference plane by {:.4f} mm", other, shift));
    }
    return std::nullopt;
  }

  void forget_lost_axes(std::size_t m) {
    const Move &move = job_.program.moves[m], *last = move_before(job_.program, m);
    const bool moved_frame = last != nullptr && last->frame != move.frame;
    const std::array<bool, 3> lost = lost_axes(job_.program, m);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (lost[axis] || moved_frame || move.fixed[axis]) shifts_mm_[axis].reset();
  }

  // Both programs must set the coordinates of their moves alike.
  std::optional<Failure> frame_failure(const MatchedMoves& matched) const {
    constexpr double rounding_mm = 1e-6, rounding_rad = 1e-9;
    const CorrectedMove& last = matched.found.back();
    const ProgramFrame &wanted = job_.program.frames[matched.original.frame],
                       &found = last.program->frames[last.move->frame];
    const double off = (found.origin_mm - wanted.origin_mm).norm();
    const bool same = found.work_offset == wanted.work_offset && found.set_mm == wanted.set_mm &&
                      off <= rounding_mm && std::abs(found.turn_rad - wanted.turn_rad) <= rounding_rad;
    if (same) return std::nullopt;
    return Failure{
        ErrorKind::not_compensated, matched.original.line,
        fmt::format(
            "the coordinates of this block are not those of the original: another offset, or {:.4f} mm "
            "off",
            off),
        last.move->line};
  }

  Failure not_found(const Move& original, std::size_t others) {
    const CorrectedMove* next = found_.at(0);
    if (next == nullptr || next->others != others)
      return {ErrorKind::not_compensated, original.line,
              "no move follows here that belongs to the original's",
              next != nullptr ? next->move->line : last_line_};
    return {
        ErrorKind::not_compensated, original.line,
        "the moves from here on do not end where that of the original does, with the same words (motion, F, "
        "S, M)",
        next->move->line};
  }

  void add_hole(const MatchedMoves& matched) {
    const Move &original = matched.original, &found = *matched.found.back().move;
    if (!original.cycle || !original.known_end[0] || !original.known_end[1]) return;
    Piece piece = piece_of_hole(job_, original, found);
    piece.corrected_line = found.line;
    const bool takes_z = original.cycle->bottom_word || original.cycle->may_insert_bottom;
    piece.exempt_end = original.handling != Handling::own || !takes_z;
    drafts.push_back({std::move(piece)});
  }

  // The end of a move from a position that is not known.
  void add_position(const MatchedMoves& matched) {
    const Move& original = matched.original;
    const bool known = all_known(original.known_end) && !all_known(original.known_start);
    if (!known || matched.segment || original.cycle) return;
    const Move& found = *matched.found.back().move;
    Piece piece = piece_of_position(job_, original, found);
    piece.corrected_line = found.line;
    piece.exempt_end = original.handling != Handling::own || !takes_all_words(original) ||
                       (skipped_ && original.motion == Motion::feed);
    drafts.push_back({std::move(piece)});
  }

  const Job& job_;
  const PlannedWays& ways_;
  CorrectedMoves& found_;
  MoveFinder finder_;
  std::size_t next_segment_ = 0;
  int last_line_ = 1;                                 // of the corrected program
  std::array<std::optional<double>, 3> shifts_mm_{};  // by axis, of the last word in these coordinates
  double height_shift_mm_ = 0;                        // of the last height that is known
  bool skipped_ = false;  // a '/' block made the position unknown: feed moves behind it are held, not judged
};

constexpr double least_jump = 1e-9;  // m: of the correction

// A segment that does not begin where the one before it ends is preceded by a jump.
bool may_jump(const PlannedWays& ways, std::size_t s, const PlannedSegment& planned) {
  if (planned.starts_anywhere || (planned.knots.empty() && !planned.end)) return false;
  return s == 0 || !ways[s - 1].end || (*ways[s - 1].end - planned.start_target).norm() > least_jump;
}

// Where the curves of the correction of an arc meet, by a step or without one.
void add_borders(const Curve& arc, const PlannedSegment& planned, std::vector<Knot>& knots) {
  for (std::size_t i = 1; i < planned.arc.size(); ++i) {
    const CorrectionCurve &before = planned.arc[i - 1], &behind = planned.arc[i];
    const double u = behind.begin();
    const Vector3 p = point_at(arc, u), ends = before.intervals().back().nodes.back().c,
                  begins = behind.at(u);
    knots.push_back({u, p + ends});
    if ((begins - ends).norm() > least_jump) knots.push_back({u, p + begins});
  }
}

// Compares as many lines without a move as both programs have given.
std::optional<Failure> lines_failure(OtherLines& wanted, OtherLines& found) {
  for (; !wanted.lines.empty() && !found.lines.empty(); wanted.lines.pop_front(), found.lines.pop_front())
    if (wanted.lines.front().text != found.lines.front().text)
      return Failure{ErrorKind::not_compensated, wanted.lines.front().line,
                     "this line differs from that of the original; it is not a move and must not change",
                     found.lines.front().line};
  return std::nullopt;
}

}  // namespace

PlannedWays planned_ways(const Job& job, const Plan& plan) {
  PlannedWays ways(plan.segments.size());
  for (std::size_t s = 0; s < ways.size(); ++s) {
    const PlannedSegment& planned = plan.segments[s];
    PlannedWay& way = ways[s];
    way.end = planned.end;
    if (!way.end && !planned.knots.empty()) way.end = planned.knots.back().target;
    if (may_jump(ways, s, planned)) way.inner.push_back({0, planned.start_target});
    if (planned.knots.size() > 1)
      way.inner.insert(way.inner.end(), planned.knots.begin(), planned.knots.end() - 1);
    add_borders(job.path.segments[s].wanted, planned, way.inner);
  }
  return ways;
}

Matching match_window(const Job& job, const PlannedWays& ways, OtherLines& lines, CorrectedMoves& found) {
  Matching result;
  const std::vector<std::size_t> others = lines.add(job.program);
  WindowMatcher matcher(job, ways, found);
  result.failure = matcher.run(others);
  if (auto failure = lines_failure(lines, found.other_lines())) result.failure = failure;
  if (!result.failure) result.pieces = refined(job, std::move(matcher.drafts));
  return result;
}

std::optional<Failure> match_end(OtherLines& lines, CorrectedMoves& found) {
  if (const CorrectedMove* left = found.at(0))
    return Failure{ErrorKind::not_compensated, 0, "this move has no counterpart in the original",
                   left->move->line};
  OtherLines& others = found.other_lines();
  if (auto failure = lines_failure(lines, others)) return failure;
  if (!others.lines.empty())
    return Failure{ErrorKind::not_compensated, 0, "the original has no such line", others.lines.front().line};
  if (!lines.lines.empty())
    return Failure{ErrorKind::not_compensated, lines.lines.front().line,
                   "this line of the original is missing at the end of the corrected program"};
  return std::nullopt;
}

}  // namespace counterflex
