#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "compensation/match/match_moves.hpp"

namespace counterflex {
namespace {

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
