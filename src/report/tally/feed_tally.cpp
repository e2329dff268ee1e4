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
         all_known(move.known_start) && all_known(move.known_end) && move.start_mm == move.end_mm &&
         !(move.orientation && move.orientation->start != move.orientation->end);
}

// A cycle is called at its end, which is checked.
bool cuts_at_end(const Move& move) {
  return move.makes_hole || move.mills_at_end;
}

/// Number of feed moves and holes of a move.
std::uint32_t count_of(const Move& move, const Program& program) {
  if (cuts_at_end(move)) return 1;
  if (move.cycle) return static_cast<std::uint32_t>(count_of_holes(move));
  if (move.motion == Motion::rapid) return may_cut(move, program) ? 1 : 0;
  return rests(move) ? 0 : 1;
}

}  // namespace

// What one move has more than is expected of it must not make up for another one: unknown ones are counted
// move by move.
void FeedTally::add_unknown(const std::vector<Parts>& window, FeedMoves& moves) {
  for (const Parts& parts : window) {
    const std::uint32_t unknown = parts.count - std::min(parts.count, parts.measured);
    moves.unknown += unknown;
    moves.unknown_length += std::min(unknown, parts.count - std::min(parts.count, parts.known_lengths));
  }
}

void FeedTally::add_window(const Job& window) {
  add_unknown(parts_, moves_);
  parts_.clear();
  std::size_t lost = parts_corner(window.program);
  for (const LeftAlone& block : window.program.left_alone) lost += block.feeds;
  for (const Move& move : window.program.moves) {
    lost += move.mills_at_end;  // the length milled around the end is unknown
    const bool first_known = cuts_at_end(move) && !all_known(move.known_start) && all_known(move.known_end);
    const auto holes = static_cast<std::uint32_t>(fractions_of_holes(move).size());
    parts_.push_back({count_of(move, window.program), holes + first_known});
  }
  moves_.unknown += lost;
  moves_.unknown_length += lost;
  for (const Segment& segment : window.path.segments) {
    if (!segment.cutting && !cuts_at_end(window.program.moves[segment.move])) continue;
    ++parts_[segment.move].known_lengths;
    if (segment.cutting) moves_.length_mm += length(segment.wanted) / mm;
  }
  segment_.reset();
}

void FeedTally::add_measured(std::size_t move, bool is_within) {
  ++parts_[move].measured;
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
  if (hole) return add_measured(w.move, is_within);
  if (segment_ != w.segment) {
    segment_ = w.segment;
    missed_ = !is_within;
    return add_measured(w.move, is_within);
  }
  if (is_within || missed_) return;
  missed_ = true;
  --moves_.within;
  ++moves_.missed;
}

FeedMoves FeedTally::moves() const {
  FeedMoves moves = moves_;
  add_unknown(parts_, moves);
  moves.count = moves.within + moves.missed + moves.unknown;
  return moves;
}

}  // namespace counterflex
