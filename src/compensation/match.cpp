#include "match.hpp"

#include <fmt/format.h>

#include "counterflex/compensation/compensate.hpp"
#include "counterflex/geometry/units.hpp"
#include "emit.hpp"
#include "match_kind.hpp"
#include "match_pieces.hpp"

namespace counterflex {
namespace {

bool makes_doubtful(const Move& move) {
  bool lost = move.block_delete;
  for (std::size_t axis = 0; axis < 3; ++axis)
    lost = lost || move.fixed[axis] || (move.known_start[axis] && !move.known_end[axis]);
  return lost;
}

class WindowMatcher {
 public:
  WindowMatcher(const Job& job, const NominalTrack& track, const PlannedEnds& ends, CorrectedMoves& found)
      : job_(job), found_(found), finder_(job, ends, found), maker_(job, track) {}

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
    if (auto failure = kind_failure(job_, matched)) return failure;
    if (auto failure = words_failure(job_, matched)) return failure;
    if (segment && !original.cycle) maker_.add(matched, drafts);
    add_hole(matched);
    add_position(matched);
    last_line_ = matched.found.back().move->line;
    found_.drop(matched.found.size());
    skipped_ = makes_doubtful(original) || (skipped_ && !all_known(original.known_end));
    return std::nullopt;
  }

  Failure not_found(const Move& original, std::size_t others) {
    const CorrectedMove* next = found_.at(0);
    if (next == nullptr || next->others != others)
      return {Exit::not_compensated, original.line, "no move follows here that belongs to the original's",
              next != nullptr ? next->move->line : last_line_};
    return {Exit::not_compensated, original.line,
            "the moves from here on do not end where that of the original does, with the same words (motion, F, "
            "S, M)",
            next->move->line};
  }

  void add_hole(const MatchedMoves& matched) {
    const Move &original = matched.original, &found = *matched.found.back().move;
    if (!original.cycle || !original.known_end[0] || !original.known_end[1]) return;
    const WorkFrame& frame = job_.path.frames[original.offset];
    const Vector3 bottom = frame.X_MW * (bottom_of(found) * mm);
    const bool takes_z = original.cycle->bottom_word || original.cycle->may_insert_bottom;
    drafts.push_back({{.segment = no_segment,
                       .line = original.line,
                       .corrected_line = found.line,
                       .frame = original.offset,
                       .commanded = {bottom, bottom, {}},
                       .wanted = wanted_frame(frame) * (bottom_of(original) * mm),
                       .end_only = true,
                       .exempt_end = original.handling != Handling::own || !takes_z,
                       .tool = original.tool}});
  }

  // The end of a move from a position that is not known.
  void add_position(const MatchedMoves& matched) {
    const Move& original = matched.original;
    const bool known = all_known(original.known_end) && !all_known(original.known_start);
    if (!known || matched.segment || original.cycle) return;
    const Vector3 end = target_of(job_, *matched.found.back().move);
    drafts.push_back({{.segment = no_segment,
                       .line = original.line,
                       .corrected_line = matched.found.back().move->line,
                       .frame = original.offset,
                       .commanded = {end, end, {}},
                       .wanted = wanted_of(job_, original),
                       .end_only = true,
                       .exempt_end = original.handling != Handling::own || !original.may_insert_words ||
                                     (skipped_ && original.motion == Motion::feed),
                       .tool = original.tool}});
  }

  const Job& job_;
  CorrectedMoves& found_;
  MoveFinder finder_;
  PieceMaker maker_;
  std::size_t next_segment_ = 0;
  int last_line_ = 1;     // of the corrected program
  bool skipped_ = false;  // a '/' block made the position unknown: feed moves behind it are held, not judged
};

// Compares as many lines without a move as both programs have given.
std::optional<Failure> lines_failure(OtherLines& wanted, OtherLines& found) {
  for (; !wanted.lines.empty() && !found.lines.empty(); wanted.lines.pop_front(), found.lines.pop_front())
    if (wanted.lines.front().text != found.lines.front().text)
      return Failure{Exit::not_compensated, wanted.lines.front().line,
                     "this line differs from that of the original; it is no move and must stay as it is",
                     found.lines.front().line};
  return std::nullopt;
}

// The surface from which the holes of a Klartext cycle count, where the first of them is met.
struct Surface {
  int line;
  double z_mm, before_mm;  // itself, and the last Z before it that is known
};

std::vector<Surface> surfaces_of(const Program& program) {
  std::vector<Surface> surfaces;
  double before_mm = 0;
  for (const Move& move : program.moves) {
    if (move.words[2] && move.words[2]->number.begin < move.block.begin)
      surfaces.push_back({move.line, move.end_mm.z(), before_mm});
    else if (move.known_end[2])
      before_mm = move.end_mm.z();
  }
  return surfaces;
}

// A surface goes along with the holes, which keep the shift with which they are entered.
std::optional<Failure> surfaces_failure(const Program& original, const Program& corrected) {
  constexpr double rounding_mm = 1e-3 * (1 + 1e-9);  // of both, to three decimals
  const auto wanted = surfaces_of(original), found = surfaces_of(corrected);
  for (std::size_t i = 0; i < std::min(found.size(), wanted.size()); ++i) {
    const double shift = found[i].z_mm - wanted[i].z_mm, held = found[i].before_mm - wanted[i].before_mm;
    if (std::abs(shift - held) > rounding_mm)
      return Failure{Exit::not_compensated, wanted[i].line,
                     fmt::format("the surface of this hole's cycle is shifted by {:.4f} mm, the hole by {:.4f} mm",
                                 shift, held),
                     found[i].line};
  }
  if (found.size() == wanted.size()) return std::nullopt;
  return Failure{Exit::not_compensated, wanted.empty() ? 0 : wanted.back().line,
                 fmt::format("{} surfaces of cycles are used, in the original {}", found.size(), wanted.size()),
                 found.empty() ? 1 : found.back().line};
}

}  // namespace

PlannedEnds planned_ends(const Plan& plan) {
  PlannedEnds ends(plan.segments.size());
  for (std::size_t s = 0; s < ends.size(); ++s) {
    const PlannedSegment& planned = plan.segments[s];
    if (planned.end)
      ends[s] = planned.end;
    else if (!planned.knots.empty())
      ends[s] = planned.knots.back().target;
  }
  return ends;
}

Matching match_window(const Job& job, const NominalTrack& track, const PlannedEnds& ends, OtherLines& lines,
                      CorrectedMoves& found) {
  Matching result;
  const std::vector<std::size_t> others = lines.add(job.program);
  // A Klartext program is one window: surfaces are those of all.
  if (const CorrectedMove* first = found.at(0); first != nullptr && job.program.dialect == "heidenhain")
    result.failure = surfaces_failure(job.program, *first->program);
  WindowMatcher matcher(job, track, ends, found);
  if (!result.failure) result.failure = matcher.run(others);
  if (auto failure = lines_failure(lines, found.other_lines())) result.failure = failure;
  if (!result.failure) result.pieces = refined(job, track, std::move(matcher.drafts));
  return result;
}

std::optional<Failure> match_end(OtherLines& lines, CorrectedMoves& found) {
  if (const CorrectedMove* left = found.at(0))
    return Failure{Exit::not_compensated, 0, "this move has no counterpart in the original", left->move->line};
  OtherLines& others = found.other_lines();
  if (auto failure = lines_failure(lines, others)) return failure;
  if (!others.lines.empty())
    return Failure{Exit::not_compensated, 0, "the original has no such line", others.lines.front().line};
  if (!lines.lines.empty())
    return Failure{Exit::not_compensated, lines.lines.front().line,
                   "this line of the original is missing at the end of the corrected program"};
  return std::nullopt;
}

}  // namespace counterflex
