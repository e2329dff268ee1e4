#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/match/match.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/failures.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/kept_words.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex {
namespace {

constexpr double length_share = 0.1;  // a difference of lengths counts for less than one of places
constexpr double nearer_mm = 1e-9;
constexpr double same_turn_deg = short_turn_deg / 80;  // a quarter of the shortest last turn

// The pieces of a robot's statement are copies of it.
bool are_copies(const CorrectedMove& found) {
  return is_robot_dialect(found.program->dialect);
}

bool may_end(const Move& original, const std::string& words, const CorrectedMove& found, std::size_t j) {
  if (found.move->motion != original.motion) return false;
  if (are_copies(found)) return are_alike(found.words, words);
  return j > 0 && is_first_piece(original, words) ? is_plain(found.words) : found.words == words;
}

// Whether another piece of the same move may follow.
bool may_go_on(const Move& original, const std::string& words, const CorrectedMove& found, std::size_t j) {
  if (found.move->motion != Motion::feed && !(original.may_position && j == 0)) return false;
  if (are_copies(found)) return are_alike(found.words, words);
  return j == 0 && is_first_piece(original, words) ? found.words == words : is_plain(found.words);
}

// A feed move before a rapid has the F of the cut that it ends: F in the block of the rapid acts behind it.
bool ends_cut_before(const Move& original, const Move& found, const std::string& words) {
  return original.motion == Motion::rapid && found.feed_mm_min > 0 && feed_word(words).empty();
}

std::size_t most_moves(const Move& original, bool has_segment) {
  if (!has_segment || original.handling == Handling::held || original.cycle) return 1;
  if (original.motion == Motion::feed && (original.may_split || changes_height_inside(original)))
    return std::numeric_limits<std::size_t>::max();
  return original.may_jump || original.may_position ? 2 : 1;
}

constexpr double same_time = 1e-3;  // of the time of a block: F is rounded

// Each piece takes as much of the time as it goes of the way (mm) and turns (deg).
std::optional<Failure> share_failure(const MatchedMoves& matched) {
  const auto share_of = [](const Move& move) { return std::hypot(length(curve_of(move)), turned_deg(move)); };
  double whole = 0, minutes = 0;
  for (const CorrectedMove& found : matched.found) {
    if (!all_known(found.move->known_start) || !all_known(found.move->known_end)) return std::nullopt;
    whole += share_of(*found.move);
    minutes += 1 / found.move->feed_per_min;
  }
  for (const CorrectedMove& found : matched.found) {
    const Move& move = *found.move;
    const double of_way = share_of(move) / whole, of_time = 1 / move.feed_per_min / minutes;
    const double rounding = roundings * rounding_as_read(move) / mm / whole;
    if (whole > 0 && std::abs(of_way - of_time) > same_time + rounding)
      return matched.failure_at(move.line, fmt::format("this piece goes {:.1f} % of the way of its block in "
                                                       "{:.1f} % of the time",
                                                       100 * of_way, 100 * of_time));
  }
  return std::nullopt;
}

// G93: the pieces of a block take its time together. A block without F keeps it so.
std::optional<Failure> time_failure(const MatchedMoves& matched) {
  const Move& original = matched.original;
  if (original.motion != Motion::feed || original.feed_mode != FeedMode::inverse_time) return std::nullopt;
  double minutes = 0;
  for (const CorrectedMove& found : matched.found) minutes += 1 / found.move->feed_per_min;
  const double wanted = 1 / original.feed_per_min;
  const bool same = minutes == wanted || std::abs(minutes - wanted) <= same_time * wanted;
  if (same) return std::isfinite(wanted) ? share_failure(matched) : std::nullopt;
  return matched.failure(
      fmt::format("this block takes {:.6g} min here, in the original {:.6g} min", minutes, wanted));
}

// G94: whether the pieces of a block that only turns the tool have its time, and F behind them is that of the
// block.
std::optional<Failure> turn_failure(const MatchedMoves& matched) {
  const Move& original = matched.original;
  if (!only_turns(original) || original.feed_mode != FeedMode::length) return std::nullopt;
  for (const CorrectedMove& found : matched.found) {
    const Move& move = *found.move;
    const double turn = turned_deg(move), way_mm = length(curve_of(move));
    const bool hurries = way_mm > 0 && way_mm / mm_per(move.unit) < turn && turn > short_turn_deg;
    if (!hurries && move.feed_mm_min == original.feed_mm_min) continue;
    if (!hurries)
      return matched.failure_at(move.line, fmt::format("the feed is {:g} deg/min here, in the original {:g}",
                                                       move.feed_mm_min / mm_per(move.unit),
                                                       original.feed_mm_min / mm_per(original.unit)));
    const double minutes = way_mm / move.feed_mm_min,
                 wanted = turn / (original.feed_mm_min / mm_per(original.unit));
    if (!(std::abs(minutes - wanted) <= same_time * wanted))
      return matched.failure_at(
          move.line,
          fmt::format("this piece turns the tool by {:.4g} degrees in {:.3g} s, the block that it "
                      "belongs to does so in {:.3g} s: F is along X, Y and Z as soon as one of them "
                      "moves",
                      turn, 60 * minutes, 60 * wanted));
  }
  if (matched.last().feed_mm_min == original.feed_mm_min) return std::nullopt;
  return matched.failure(
      "the last piece of a block that only turns the tool must have the F of the block, "
      "which acts in the blocks behind it");
}

// Of axes, of the centre and the radius of an arc, of the heights of a cycle.
std::array<PackedAxisWord, 9> length_words(const Move& move) {
  std::array<PackedAxisWord, 9> words;
  std::ranges::copy(move.words, words.begin());
  if (move.arc) {
    std::ranges::copy(move.arc->centre_words, words.begin() + 3);
    words[6] = move.arc->radius_word;
  }
  if (move.cycle) words[7] = move.cycle->bottom_word, words[8] = move.cycle->retract_word;
  return words;
}

// Zero needs no point.
bool lacks_point(const Program& program, const PackedAxisWord& word) {
  if (!word) return false;
  const Span number = word->number;
  const std::string_view text =
      std::string_view(program.text).substr(number.begin, number.end - number.begin);
  return text.find('.') == std::string_view::npos &&
         text.find_first_of("123456789") != std::string_view::npos;
}

// Fanuc and Haas may read a length without a point in units of 0.001 mm.
std::optional<Failure> point_failure(const Job& job, const MatchedMoves& matched) {
  const bool counts_units = job.program.dialect == "fanuc" || job.program.dialect == "haas";
  if (!counts_units || job.program.integer_words != IntegerWords::unspecified) return std::nullopt;
  const auto originals = length_words(matched.original);
  for (const CorrectedMove& found : matched.found) {
    const auto words = length_words(*found.move);
    for (std::size_t k = 0; k < words.size(); ++k)
      if (lacks_point(*found.program, words[k]) && !lacks_point(job.program, originals[k]))
        return matched.failure_at(found.move->line,
                                  "a length of this block has no point, that of the original has one: the "
                                  "control may read it in units of 0.001 mm");
  }
  return std::nullopt;
}

// The angle between two orientations (deg). Angles that the control interpolates differ by full turns, too.
double angle_deg(const MoveOrientation& of, const OrientationNumbers& a, const OrientationNumbers& b) {
  if (of.by_angles) return turned_deg(a, b);
  return rotation_between(rotation_of(of.form, a), rotation_of(of.form, b)).norm() / deg;
}

}  // namespace

std::optional<Vector3> MoveFinder::planned_shift_mm(const Move& original,
                                                    std::optional<std::size_t> segment) const {
  if (!segment || plan_.segments[*segment].knots.empty()) return std::nullopt;
  return in_words_mm(job_, original, plan_.segments[*segment].knots.back().target) - original.end_mm;
}

// The shift of the move before, changed as planned: right for what was written as planned, and nearly right
// for what was corrected otherwise, or not at all.
Vector3 MoveFinder::expected_end_mm(const Move& original, const std::optional<Vector3>& planned_mm) const {
  const Vector3 held = shift_mm_.value_or(Vector3::Zero());
  if (!planned_mm) return original.end_mm + held;
  if (!shift_mm_ || !planned_shift_mm_) return original.end_mm + *planned_mm;
  return original.end_mm + held + *planned_mm - *planned_shift_mm_;
}

// The orientation at the end of a feed move that is found by its turn; nothing for other moves.
std::optional<OrientationNumbers> MoveFinder::expected_turn(const MatchedMoves& matched) const {
  const Move& original = matched.original;
  if (!matched.segment || original.motion != Motion::feed) return std::nullopt;
  const std::size_t s = *matched.segment;
  if (!is_found_by_turn(job_.path.segments[s])) return std::nullopt;
  if (plan_.segments[s].knots.empty()) return original.orientation->end;
  return turned_words(job_, original, 1, plan_.segments[s].knots.back().turn);
}

// How many more moves from `first` on end there, too, as the plan has it: a jump of the correction may be
// less than a digit before the end.
std::size_t MoveFinder::count_behind(const MatchedMoves& matched, std::size_t first, std::size_t others,
                                     const Vector3& end_mm, double near_mm) {
  const Move& original = matched.original;
  const PlannedSegment& planned = plan_.segments[*matched.segment];
  if (planned.knots.empty()) return 0;
  const std::vector<Knot> knots = inner_knots(job_, plan_, *matched.segment, *found_.at(0)->move);
  if (knots.empty()) return 0;
  const double length_mm = length(curve_of(original));
  // Both ends of the text are rounded.
  const auto is_planned_there = [&](const Knot& knot) {
    const double before_mm = (1 - knot.u) * length_mm,
                 off_mm = (knot.target - planned.knots.back().target).norm() / mm;
    return length_mm > 0 && std::max(before_mm, off_mm) <= 2 * near_mm;
  };
  const auto planned_before = std::find_if_not(knots.rbegin(), knots.rend(), is_planned_there);
  // The moves before `first` that end at one of these have it.
  const Vector3 planned_end_mm = in_words_mm(job_, original, planned.knots.back().target);
  const auto has_knot = [&](const CorrectedMove& found) {
    return std::any_of(knots.rbegin(), planned_before, [&](const Knot& knot) {
      const Vector3 there_mm = end_mm + in_words_mm(job_, original, knot.target) - planned_end_mm;
      return (found.move->end_mm - there_mm).norm() <= near_mm;
    });
  };
  std::ptrdiff_t most = planned_before - knots.rbegin();
  for (std::size_t i = 0; i + 1 < first; ++i) most -= has_knot(*found_.at(i));
  std::size_t j = first;
  for (; most > 0; --most, ++j) {
    const CorrectedMove* found = found_.at(j);
    if (found == nullptr || found->others != others) break;
    if (next_number_ && found->move->block_number == next_number_) break;
    if (!may_go_on(original, matched.words, *found_.at(j - 1), j - 1)) break;
    if (!may_end(original, matched.words, *found, j) || (found->move->end_mm - end_mm).norm() > near_mm)
      break;
  }
  return j - first;
}

// The first moves that end where the original should, after a way that is about as long.
std::size_t MoveFinder::count(const MatchedMoves& matched, std::size_t most, std::size_t others) {
  const Move& original = matched.original;
  const Vector3 end_mm = expected_end_mm(original, planned_shift_mm(original, matched.segment));
  const Curve curve = curve_of(original);
  const double length_mm = length(curve);
  double slack_mm = 2 * job_.options.max_correction / mm;
  // Every turn of a circle ends at the same place. An angle distinguishes them, also where corrections are
  // larger than the radius.
  Arc axis;
  if (curve.arc) {
    axis = *curve.arc;
    axis.centre += shift_mm_.value_or(Vector3::Zero());
    slack_mm = std::min(slack_mm, length_mm / axis.sweep * 3);
  }
  const bool turns_rigidly = curve.arc && original.handling == Handling::group;
  const auto way_mm = [&](const Move& move) {
    const Curve way = curve_of(move);
    if (turns_rigidly) return way.arc ? way.arc->sweep * length_mm / axis.sweep : 0.0;
    return curve.arc ? angle_about(axis, way) * length_mm / axis.sweep : length(way);
  };
  // A move that is found by its turn may have several pieces that end at one place.
  const std::optional<OrientationNumbers> end_turn = expected_turn(matched);
  const auto off_deg = [&](const Move& move) {
    if (!end_turn || !move.orientation) return 0.0;
    return angle_deg(*original.orientation, move.orientation->end, *end_turn);
  };
  std::size_t best = 0;
  double best_miss = std::numeric_limits<double>::infinity(), gone_mm = 0;
  for (std::size_t j = 0; j < most; ++j) {
    const CorrectedMove* found = found_.at(j);
    if (found == nullptr || found->others != others) break;
    if (j > 0 && next_number_ && found->move->block_number == next_number_) break;
    gone_mm += way_mm(*found->move);
    if ((!turns_rigidly || found->move->arc) && may_end(original, matched.words, *found, j)) {
      const double aside_mm = (found->move->end_mm - end_mm).norm(), turned = off_deg(*found->move),
                   off = std::hypot(aside_mm, turned), surplus = std::abs(gone_mm - length_mm);
      const double rounding_mm = std::max(rounding_mm_, rounding_as_read(*found->move) / mm);
      // This end is rounded, and the one before, whose shift is expected here: no other end is as near, but
      // for those that are planned within these digits.
      const bool is_there = aside_mm <= 2 * rounding_mm && turned <= same_turn_deg;
      if (!turns_rigidly && is_there && surplus <= slack_mm)
        return j + 1 + count_behind(matched, j + 1, others, end_mm, 2 * rounding_mm);
      // The end of a contour's piece is known up to its turn, its angle to the last digits.
      const double miss = turns_rigidly ? surplus + length_share * off : off + length_share * surplus;
      if (miss < best_miss - nearer_mm) best = j + 1, best_miss = miss;
    }
    if (!may_go_on(original, matched.words, *found, j) ||
        gone_mm > length_mm + 2 * job_.options.max_correction / mm)
      break;
  }
  return best;
}

MatchedMoves MoveFinder::find(std::size_t m, std::optional<std::size_t> segment,
                              const PlaceAmongLines& place) {
  const Move& original = job_.program.moves[m];
  MatchedMoves matched{
      original, segment, {}, kept_words(job_.program, original) + place.acting, rounding_mm_ * mm};
  const CorrectedMove* first = found_.at(0);
  if (first == nullptr || first->others != place.others) return matched;
  if (!shift_mm_ && all_known(original.known_start) && all_known(first->move->known_start))
    shift_mm_ = first->move->start_mm - original.start_mm;
  if (frame_ != original.frame) planned_shift_mm_.reset(), shift_mm_.reset();
  next_number_.reset();
  if (m + 1 < job_.program.moves.size()) next_number_ = job_.program.moves[m + 1].block_number;
  if (next_number_ == original.block_number || job_.program.dialect == "heidenhain") next_number_.reset();
  const std::size_t most = most_moves(original, segment.has_value());
  matched.found = found_.first(most == 1 ? 1 : count(matched, most, place.others));
  if (matched.found.empty()) return matched;
  planned_shift_mm_ = planned_shift_mm(original, segment);
  frame_ = original.frame;
  if (all_known(original.known_end)) shift_mm_ = matched.last().end_mm - original.end_mm;
  rounding_mm_ = rounding_as_read(matched.last()) / mm;
  return matched;
}

std::optional<Failure> words_failure(const Job& job, const MatchedMoves& matched) {
  const Move& original = matched.original;
  const std::string& wanted = matched.words;
  std::size_t own_blocks = 0;
  // A restart at the number of a block runs the whole move. In Klartext all blocks are numbered in order.
  const bool klartext = job.program.dialect == "heidenhain";
  const auto is_numbered_rightly = [&](const Move& move, bool first) {
    if (klartext) return true;
    return first ? move.block_number == original.block_number : !move.block_number || original.block_number;
  };
  for (const CorrectedMove& found : matched.found) {
    const Move& move = *found.move;
    const std::string& words = found.words;
    if (are_copies(found)) {
      if (!are_alike(words, wanted))
        return matched.failure_at(move.line,
                                  "the words besides coordinates are not those of the original's statement");
      if (move.feed_mm_min != original.feed_mm_min || move.tool != original.tool)
        return matched.failure_at(move.line, "the feed or the tool is not that of the original");
      own_blocks = 1;
      continue;
    }
    if (words == wanted) ++own_blocks;
    const bool plain = is_plain(words) && words.find_first_of("(;") == std::string::npos;
    // Two feeds that are not known are the same if they are the same text.
    const bool same_text =
        move.feed_mm_min > 0 || feed_word(words).empty() || feed_word(words) == feed_word(wanted);
    const bool same_feed = move.motion == Motion::rapid || move.feed_mode == FeedMode::inverse_time ||
                           only_turns(original) || (move.feed_mm_min == original.feed_mm_min && same_text) ||
                           ends_cut_before(original, move, words);
    if (matched.found.size() == 1 && words != wanted)
      return matched.failure_at(move.line,
                                "the words besides coordinates are not those of the original's block");
    if (words != wanted && !plain)
      return matched.failure_at(
          move.line, "an inserted block may hold motion, axes and the feed that acts, nothing else");
    if (!is_numbered_rightly(move, &found == &matched.found.front()))
      return matched.failure_at(
          move.line,
          "the N of a block belongs to its first piece, and other pieces of a block without N have none");
    if (!same_feed && !same_text)
      return matched.failure_at(move.line, fmt::format("the feed is {} here, in the original '{}'",
                                                       feed_word(words), feed_word(wanted)));
    if (!same_feed)
      return matched.failure_at(move.line,
                                fmt::format("the feed is {:g} mm/min here, in the original {:g} mm/min",
                                            move.feed_mm_min, original.feed_mm_min));
  }
  if (own_blocks == 0 || (own_blocks > 1 && !is_plain(wanted)))
    return matched.failure("the words of the original's block are in several blocks here, or in no block");
  if (auto failure = point_failure(job, matched)) return failure;
  if (auto failure = turn_failure(matched)) return failure;
  return time_failure(matched);
}

}  // namespace counterflex
