#include "compensation/match/match.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/solve/commands.hpp"
#include "counterflex/compensation/offset_window.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/program/kept_words.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {
namespace {

Failure not_found(const Move& original, std::size_t others, CorrectedMoves& found, int last_line) {
  const CorrectedMove* next = found.at(0);
  if (next == nullptr || next->others != others)
    return {ErrorKind::not_compensated, original.line, "no move follows here that belongs to the original's",
            next != nullptr ? next->move->line : last_line};
  return {
      ErrorKind::not_compensated, original.line,
      "the moves from here on do not end where that of the original does, with the same words (motion, F, "
      "S, M)",
      next->move->line};
}

void add_holes(const Job& job, const MatchedMoves& matched, std::vector<DraftPiece>& drafts) {
  const Move &original = matched.original, &found = matched.last();
  for (const double u : fractions_of_holes(original)) {
    Piece piece = piece_of_hole(job, original, found, u);
    piece.corrected_line = found.line;
    const bool takes_z = original.cycle->bottom_word || original.cycle->may_insert_bottom;
    piece.exempt_end = original.handling != Handling::own || !takes_z;
    drafts.push_back({std::move(piece)});
  }
}

// The end of a move from a position that is not known.
void add_position(const Job& job, const MatchedMoves& matched, bool skipped,
                  std::vector<DraftPiece>& drafts) {
  const Move& original = matched.original;
  const bool known = all_known(original.known_end) && !all_known(original.known_start);
  if (!known || matched.segment || original.cycle) return;
  const Move& found = matched.last();
  Piece piece = piece_of_end(job, original, found);
  piece.corrected_line = found.line;
  piece.exempt_end = original.handling != Handling::own || !takes_all_words(original) ||
                     (skipped && original.motion == Motion::feed);
  drafts.push_back({std::move(piece)});
}

/// What the moves of a window have left for those behind them.
struct MatchState {
  std::size_t next_segment = 0;
  int last_line = 1;  ///< of the corrected program
  CarriedShifts shifts{};
  ZoneBefore zone{};
  bool skipped = false;  ///< a '/' block made the position unknown: feed moves behind it are held, not judged
  std::vector<DraftPiece> drafts{};
  std::size_t changed_without_piece = 0;
};

/// Whether a move that is corrected on its own ends elsewhere, along an axis that both programs know.
bool ends_elsewhere(const MatchedMoves& matched) {
  constexpr double indistinct_mm = 1e-9;
  const Move &original = matched.original, &found = matched.last();
  if (original.handling != Handling::own || any_axis(original.fixed)) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (original.known_end[axis] && found.known_end[axis] &&
        std::abs(found.end_mm[axis] - original.end_mm[axis]) > indistinct_mm)
      return true;
  }
  return false;
}

/// Matches move `m` of the window and adds its drafts. Returns the failure if it has no counterpart.
std::optional<Failure> match_move(const Job& job, const Plan& plan, std::size_t m,
                                  const PlaceAmongLines& place, MoveFinder& finder, CorrectedMoves& found,
                                  MatchState& state) {
  const Move& original = job.program.moves[m];
  const std::vector<Segment>& segments = job.path.segments;
  std::optional<std::size_t> segment;
  if (state.next_segment < segments.size() && segments[state.next_segment].move == m)
    segment = state.next_segment++;
  const MatchedMoves matched = finder.find(m, segment, place);
  if (matched.found.empty()) return not_found(original, place.others, found, state.last_line);
  if (auto failure = frame_failure(job, matched)) return failure;
  if (auto failure = kind_failure(job, plan, matched)) return failure;
  if (auto failure = shift_failure(job, m, matched, state.shifts)) return failure;
  if (auto failure = words_failure(job, matched)) return failure;
  if (auto failure = zone_failure(job, matched, state.zone)) return failure;
  const std::size_t pieces_before = state.drafts.size();
  if (segment && !original.cycle) add_pieces(job, plan, matched, state.drafts);
  add_holes(job, matched, state.drafts);
  add_position(job, matched, state.skipped, state.drafts);
  state.changed_without_piece +=
      state.drafts.size() == pieces_before && ends_elsewhere(matched) && moves_tool(original);
  state.last_line = matched.last().line;
  found.drop(matched.found.size());
  state.skipped = leaves_doubt(original, state.skipped);
  return std::nullopt;
}

// Compares as many lines without a move as both programs have given.
std::optional<Failure> lines_failure(OtherLines& wanted, OtherLines& found) {
  for (; !wanted.lines.empty() && !found.lines.empty(); wanted.lines.pop_front(), found.lines.pop_front())
    if (!are_equal(wanted.lines.front(), found.lines.front()))
      return Failure{ErrorKind::not_compensated, wanted.lines.front().line,
                     "this line differs from that of the original; it is not a move and must not change",
                     found.lines.front().line};
  return std::nullopt;
}

// The lines of a guard are those that are written for the machine, the work offset and the tool of the run,
// with one of the windows.
std::optional<Failure> guard_failure(const Job& job, const std::vector<OtherLine>& found) {
  if (found.empty()) return std::nullopt;
  const std::optional<Guard>& guard = job.options.write.guard;
  if (!guard)
    return Failure{
        ErrorKind::not_compensated, 0,
        "the checks from here on cannot be compared with those of --guard, as the numbers of the work "
        "offset on the control are not known: state offset_mm in the machine file",
        found.front().line};
  for (const double window_mm : window_steps_mm) {
    Guard written = *guard;
    written.window_mm = window_mm;
    if (std::ranges::equal(found, lines_of_guard(job.program.dialect, written), {}, &OtherLine::text))
      return std::nullopt;
  }
  return Failure{
      ErrorKind::not_compensated, 0,
      "the checks from here on are not those that --guard writes for this machine, work offset and tool",
      found.front().line};
}

}  // namespace

Matching match_window(const Job& job, const Plan& plan, OtherLines& lines, CorrectedMoves& found) {
  Matching result;
  const std::vector<PlaceAmongLines> places = lines.add(job.program);
  MoveFinder finder(job, plan, found);
  MatchState state;
  for (std::size_t m = 0; m < job.program.moves.size() && !result.failure; ++m)
    result.failure = match_move(job, plan, m, places[m], finder, found, state);
  if (!result.failure) result.failure = state.zone.smaller;
  if (auto failure = lines_failure(lines, found.other_lines())) result.failure = failure;
  if (!result.failure && found.other_lines().has_passed_guard())
    result.failure = guard_failure(job, found.other_lines().take_guard());
  result.changed_without_piece = state.changed_without_piece;
  if (!result.failure) result.pieces = refined(job, std::move(state.drafts));
  return result;
}

std::optional<Failure> match_end(OtherLines& lines, CorrectedMoves& found) {
  if (const CorrectedMove* left = found.at(0))
    return Failure{ErrorKind::not_compensated, 0, "this move has no counterpart in the original",
                   left->move->line};
  OtherLines& others = found.other_lines();
  if (auto failure = lines_failure(lines, others)) return failure;
  if (const auto guard = others.take_guard(); !guard.empty())
    return Failure{ErrorKind::not_compensated, 0, "no cut follows these checks", guard.front().line};
  if (!others.lines.empty())
    return Failure{ErrorKind::not_compensated, 0, "the original has no such line", others.lines.front().line};
  if (!lines.lines.empty())
    return Failure{ErrorKind::not_compensated, lines.lines.front().line,
                   "this line of the original is missing at the end of the corrected program"};
  return std::nullopt;
}

}  // namespace counterflex
