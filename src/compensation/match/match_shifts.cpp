#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "compensation/match/match.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/failures.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {
namespace {

constexpr double height_rounding_mm = 1e-3 * (1 + 1e-9);  // of both, to three decimals

// Whether the move's height is a word of a block before it: Q203 of a cycle's definition, MCALL.
bool takes_surface(const Move& move) {
  if (move.called && move.called->heights[0]) return !move.called->modal.empty();
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

// The surface from which the held holes of a Klartext cycle count goes along with them: they keep the shift
// with which they are entered. The others are judged where they are.
std::optional<Failure> surface_failure(const MatchedMoves& matched, CarriedShifts& carried) {
  const Move &original = matched.original, &found = matched.last();
  if (is_robot_dialect(matched.found.back().program->dialect)) return std::nullopt;  // named targets
  const double shift = found.end_mm.z() - original.end_mm.z();
  if (takes_surface(original) != takes_surface(found))
    return matched.failure(
        "this hole takes the height of its surface from a cycle's definition in one of both programs only");
  const bool held = original.handling == Handling::held;
  if (takes_surface(original) && held && std::abs(shift - carried.height_mm) > height_rounding_mm)
    return matched.failure(
        fmt::format("the surface of this hole's cycle is shifted by {:.4f} mm, the hole by {:.4f} mm", shift,
                    carried.height_mm));
  if (!takes_surface(original) && original.known_end[2] && found.known_end[2]) carried.height_mm = shift;
  return std::nullopt;
}

// All heights of a called cycle go along with its reference plane, the first of them.
std::optional<Failure> call_failure(const MatchedMoves& matched) {
  const Move &original = matched.original, &found = matched.last();
  if (!original.called != !found.called)
    return matched.failure("a drilling cycle is called here in one of both programs only");
  if (!original.called) return std::nullopt;
  if (without_heights(*original.called) != without_heights(*found.called))
    return matched.failure("the cycle that MCALL calls here is not that of the original");
  const double shift = found.end_mm.z() - original.end_mm.z();
  for (std::size_t i = 0; i < original.called->heights.size(); ++i) {
    if (!original.called->heights[i] != !found.called->heights[i])
      return matched.failure("a height of the cycle is given in one of both programs only");
    const double other = found.called->heights_mm[i] - original.called->heights_mm[i];
    if (original.called->heights[i] && std::abs(other - shift) > height_rounding_mm)
      return matched.failure(fmt::format(
          "a height of the cycle is shifted by {:.4f} mm, its reference plane by {:.4f} mm", other, shift));
  }
  return std::nullopt;
}

void forget_lost_axes(const Job& job, std::size_t m, CarriedShifts& carried) {
  const Move &move = job.program.moves[m], *last = move_before(job.program, m);
  const bool moved_frame = last != nullptr && last->frame != move.frame;
  const std::array<bool, 3> lost = lost_axes(job.program, m);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lost[axis] || moved_frame || move.fixed[axis]) carried.axes_mm[axis].reset();
}

// Also an inserted one.
bool has_absolute_word(const MatchedMoves& matched, std::size_t axis) {
  return !matched.original.relative && !matched.last().relative &&
         std::any_of(matched.found.begin(), matched.found.end(),
                     [axis](const CorrectedMove& found) { return bool(found.move->words[axis]); });
}

// After a word of an axis has been shifted, no word of it is unshifted until the axis has gone to a
// position of the machine. Where the deviation is judged a correction may be nothing, and an inserted word
// counts, too.
std::optional<Failure> axis_failure(const Job& job, std::size_t m, const MatchedMoves& matched,
                                    CarriedShifts& carried) {
  constexpr double unshifted_mm = 1e-9;
  const Move &original = matched.original, &found = matched.last();
  forget_lost_axes(job, m, carried);
  // A hole is judged at its bottom, also where the height behind it is not known.
  const bool place_is_known = all_known(original.known_end) || !fractions_of_holes(original).empty();
  const bool judged =
      place_is_known && (original.handling == Handling::own || original.handling == Handling::group);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!has_absolute_word(matched, axis)) continue;
    const bool in_both = original.words[axis] && found.words[axis];
    if (!in_both && !(judged && found.known_end[axis])) continue;
    const double shift = found.end_mm[axis] - original.end_mm[axis],
                 before = carried.axes_mm[axis].value_or(0);
    if (in_both && !judged && std::abs(shift) < unshifted_mm && std::abs(before) > job.options.tolerance / mm)
      return matched.failure(
          fmt::format("{} is the same as in the original, but the moves before it are shifted by {:.4f} mm",
                      "XYZ"[axis], before));
    carried.axes_mm[axis] = shift;
  }
  return std::nullopt;
}

// Contours are shifted and turned in the plane: each way inside keeps its length there.
std::optional<Failure> contour_failure(const Job& job, std::size_t m, const MatchedMoves& matched) {
  const Move &original = matched.original, &first = matched.first(), &found = matched.last();
  const bool inside = m > 0 && original.group != 0 && job.program.moves[m - 1].group == original.group;
  if (!inside || !all_known(original.known_start) || !all_known(original.known_end) ||
      !all_known(first.known_start))
    return std::nullopt;
  const double rounding_mm =
      roundings * std::max({rounding_as_read(original), rounding_as_read(found), matched.start_rounding}) /
      mm;
  const double off = (found.end_mm - first.start_mm).head<2>().norm() -
                     (original.end_mm - original.start_mm).head<2>().norm();
  if (std::abs(off) <= rounding_mm + 1e-6) return std::nullopt;
  return matched.failure(
      fmt::format("this move of a contour is {:.4f} mm {} in X and Y than that of the original; contours are "
                  "shifted and turned as a whole",
                  std::abs(off), off > 0 ? "longer" : "shorter"));
}

// What the control takes off a line for its corners is one piece, at one height.
std::optional<Failure> corner_failure(const MatchedMoves& matched) {
  const Move& original = matched.original;
  if (!original.corners || original.words[2] || !all_known(original.known_start)) return std::nullopt;
  const double length_mm = (original.end_mm - original.start_mm).norm();
  const auto check = [&](const Move& found, double taken_mm) -> std::optional<Failure> {
    const Vector3 way = found.end_mm - found.start_mm;
    const bool whole = way.norm() > taken_mm || taken_mm >= length_mm;
    if (taken_mm == 0 || !all_known(found.known_start) || (way.z() == 0 && whole)) return std::nullopt;
    const std::string size = std::isfinite(taken_mm) ? fmt::format("{:.4f} mm", taken_mm) : "a part";
    return matched.failure_at(
        found.line,
        fmt::format(
            "the corner takes {} of this block, which is {:.4f} mm long and changes its height by {:.4f} "
            "mm; corners lie in one plane",
            size, way.norm(), way.z()));
  };
  if (auto failure = check(matched.first(), original.corners->begin_mm)) return failure;
  return check(matched.last(), original.corners->end_mm);
}

// External axes of a robot keep their values.
std::optional<Failure> external_failure(const Job& job, const MatchedMoves& matched) {
  const CorrectedMove& last = matched.found.back();
  const auto& moves = last.program->external_axes_move;
  if (moves && !job.program.external_axes_move) return matched.failure(moves->what);
  for (std::size_t i = 0; i < job.program.external_axes.size(); ++i) {
    const auto &wanted = job.program.external_axes[i], &found = last.program->external_axes[i];
    if (wanted && found && wanted->value != found->value)
      return matched.failure(fmt::format("external axis E{} is at {}, in the original at {}", i + 1,
                                         found->value, wanted->value));
    if (wanted && found && wanted->unknown_in == 0 && found->unknown_in > 0)
      return matched.failure(
          fmt::format("external axis E{} is not known at the target in line {}", i + 1, found->unknown_in));
  }
  return std::nullopt;
}

constexpr double no_limit = std::numeric_limits<double>::infinity();

std::string_view words_of(const Program& program, const TargetZone& zone) {
  return std::string_view(program.text).substr(zone.words.begin, zone.words.end - zone.words.begin);
}

double length_of(const Move& move) {
  return all_known(move.known_start) ? (move.end_mm - move.start_mm).norm() : no_limit;
}

// Half of the distance from the target of piece `i` to the nearest one beside it, if one of them was
// inserted.
double most_length(const MatchedMoves& matched, std::size_t i) {
  const auto& found = matched.found;
  if (found.size() == 1) return no_limit;
  double nearest = length_of(*found[i].move);
  if (i + 1 < found.size()) nearest = std::min(nearest, length_of(*found[i + 1].move));
  return nearest / 2;
}

bool is_too_long(double length_mm, double most_mm, double least_mm) {
  constexpr double rounding_mm = 0.002;  // of targets
  return length_mm > std::max(most_mm + rounding_mm, least_mm);
}

std::string too_long(double length_mm, double most_mm) {
  return fmt::format(
      "the zone of {:.3f} mm reaches over the middle between two targets, of which one was inserted; at most "
      "{:.3f} mm are allowed",
      length_mm, most_mm);
}

}  // namespace

std::optional<Failure> frame_failure(const Job& job, const MatchedMoves& matched) {
  constexpr double rounding_mm = 1e-6, rounding_rad = 1e-9;
  const CorrectedMove& last = matched.found.back();
  const ProgramFrame &wanted = job.program.frames[matched.original.frame],
                     &found = last.program->frames[last.move->frame];
  const double off = (found.origin_mm - wanted.origin_mm).norm();
  const bool same = found.work_offset == wanted.work_offset && found.set_mm == wanted.set_mm &&
                    found.tool_axis == wanted.tool_axis && off <= rounding_mm &&
                    std::abs(found.turn_rad - wanted.turn_rad) <= rounding_rad;
  if (same) return external_failure(job, matched);
  return matched.failure(
      fmt::format("the coordinates of this block are not those of the original: another offset, or {:.4f} mm "
                  "off",
                  off));
}

std::optional<Failure> shift_failure(const Job& job, std::size_t m, const MatchedMoves& matched,
                                     CarriedShifts& carried) {
  if (auto failure = surface_failure(matched, carried)) return failure;
  if (auto failure = call_failure(matched)) return failure;
  if (auto failure = axis_failure(job, m, matched, carried)) return failure;
  if (auto failure = contour_failure(job, m, matched)) return failure;
  return corner_failure(matched);
}

std::optional<Failure> zone_failure(const Job& job, const MatchedMoves& matched, ZoneBefore& before) {
  const Move& original = matched.original;
  const bool is_split = matched.found.size() > 1;
  if (before.smaller && !is_split) return before.smaller;
  if (const Move& first = matched.first(); is_split && before.length_mm > 0 && all_known(first.known_start)) {
    const double most_mm = (first.end_mm - before.end_mm).norm() / 2;
    const double least_mm = original.zone ? original.zone->least_mm : 0;
    if (is_too_long(before.length_mm, most_mm, least_mm))
      return matched.failure_at(before.line, too_long(before.length_mm, most_mm));
  }
  for (std::size_t i = 0; i < matched.found.size(); ++i) {
    const CorrectedMove& found = matched.found[i];
    const Move& move = *found.move;
    before = {.end_mm = move.end_mm, .line = move.line};
    if (!move.zone || !original.zone) continue;  // else the words differ, or no zone is changed
    const TargetZone &zone = *move.zone, &wanted = *original.zone;
    const std::string_view words = words_of(*found.program, zone),
                           wanted_words = words_of(job.program, wanted);
    if (words != wanted_words) {
      Failure failure = matched.failure_at(
          move.line, fmt::format("the zone is {} here, {} in the original", words, wanted_words));
      if (zone.length_mm >= wanted.length_mm) return failure;
      if (!is_split && !wanted.must_not_overlap) before.smaller = std::move(failure);
    }
    const double most_mm = most_length(matched, i);
    if (is_too_long(zone.length_mm, most_mm, zone.least_mm))
      return matched.failure_at(move.line, too_long(zone.length_mm, most_mm));
    before.length_mm = zone.length_mm;
  }
  return std::nullopt;
}

}  // namespace counterflex
