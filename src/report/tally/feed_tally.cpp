#include <algorithm>

#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/report/statistics.hpp"
#include "counterflex/toolpath/reach.hpp"
#include "report/tally/may_cut.hpp"

namespace counterflex {
namespace {

bool rests(const Move& move) {
  return move.handling != Handling::held && !move.arc && !any_axis(move.fixed) &&
         all_known(move.known_start) && all_known(move.known_end) && move.start_mm == move.end_mm;
}

// A cycle is called at its end, which is checked.
bool cuts_at_end(const Move& move) {
  return move.makes_hole || move.mills_at_end;
}

/// Number of feed moves and holes of a move.
std::size_t count_of(const Move& move, const Program& program) {
  if (cuts_at_end(move)) return 1;
  if (move.cycle) return static_cast<std::size_t>(count_of_holes(move));
  if (move.motion == Motion::rapid) return may_cut(move, program) ? 1 : 0;
  return rests(move) ? 0 : 1;
}

}  // namespace

void FeedTally::add_window(const Job& window) {
  for (const LeftAlone& block : window.program.left_alone) moves_.count += block.feeds;
  for (const Move& move : window.program.moves) {
    if (move.mills_at_end) ++moves_.count;  // the length milled around the end is unknown
    moves_.count += count_of(move, window.program);
    const bool first_known = cuts_at_end(move) && !all_known(move.known_start) && all_known(move.known_end);
    known_lengths_ += fractions_of_holes(move).size() + first_known;
  }
  moves_.count += parts_corner(window.program);
  for (const Segment& segment : window.path.segments) {
    if (!segment.cutting && !cuts_at_end(window.program.moves[segment.move])) continue;
    ++known_lengths_;
    if (segment.cutting) moves_.length_mm += length(segment.wanted) / mm;
  }
  segment_.reset();
}

void FeedTally::add_measured(bool is_within) {
  ++(is_within ? moves_.within : moves_.missed);
}

void FeedTally::add(const Waypoint& w, double miss, const Job& window) {
  if (w.status != Status::converged) return;
  const bool is_within = is_within_tolerance(window.options, miss) || w.insignificant;
  const bool hole = is_place_of_cycle(window.program, w);
  if (!w.cutting && !hole) {
    const bool feed = w.segment == no_segment && window.program.moves[w.move].motion == Motion::feed;
    ++(feed ? moves_.known_ends : moves_.rapid_ends);
    return;
  }
  if (!w.insignificant && (moves_.worst_line == 0 || miss / mm > moves_.worst_mm)) {
    moves_.worst_mm = miss / mm;
    moves_.worst_line = w.line;
  }
  if (hole) return add_measured(is_within);
  if (segment_ != w.segment) {
    segment_ = w.segment;
    missed_ = !is_within;
    return add_measured(is_within);
  }
  if (is_within || missed_) return;
  missed_ = true;
  --moves_.within;
  ++moves_.missed;
}

FeedMoves FeedTally::moves() const {
  FeedMoves moves = moves_;
  const std::size_t measured = moves.within + moves.missed;
  moves.unknown = moves.count - std::min(moves.count, measured);
  moves.unknown_length = std::min(moves.unknown, moves.count - std::min(moves.count, known_lengths_));
  return moves;
}

}  // namespace counterflex
