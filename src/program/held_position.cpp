#include "program/held_position.hpp"

#include "counterflex/files/numbers.hpp"
#include "program/dialect.hpp"
#include "program/number_style.hpp"

namespace counterflex {
namespace {

Coordinate written(const Move& move, double value, int decimals) {
  return {true, value, rounded(value, decimals) * mm_per(move.unit)};
}

double component(const Vector3& p, std::size_t axis) {
  return p[static_cast<Eigen::Index>(axis)];
}

}  // namespace

Coordinate settle_inserted(const Move& move, std::size_t axis, std::optional<double> held_mm,
                           double wanted_mm, int decimals) {
  const double unit = mm_per(move.unit);
  if (move.ignored[axis]) return {false, 0, held_mm};
  if (!move.known_end[axis]) return {false, 0, std::nullopt};
  if (held_mm && rounds_to(*held_mm / unit, wanted_mm / unit, decimals)) return {false, 0, held_mm};
  return written(move, wanted_mm / unit, decimals);
}

Coordinate settle_end(const Move& move, std::size_t axis, std::optional<double> held_mm, double wanted_mm,
                      int decimals) {
  if (!move.words[axis]) {
    if (!move.may_insert_words) return {false, 0, held_mm};
    return settle_inserted(move, axis, held_mm, wanted_mm, decimals);
  }
  const double unit = mm_per(move.unit);
  const double original_mm = component(move.end_mm, axis);
  if (rounds_to(original_mm / unit, wanted_mm / unit, decimals)) return {false, 0, original_mm};
  return written(move, wanted_mm / unit, decimals);
}

HeldPosition held_at_start(const Move& move, HeldPosition before) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!move.known_start[axis]) before[axis].reset();
  return before;
}

HeldPosition held_after_original(const Move& move, const HeldPosition& before) {
  HeldPosition held = held_at_start(move, before);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!move.words[axis]) continue;
    held[axis] = component(move.end_mm, axis);
    if (move.block_delete) held[axis].reset();
  }
  return held;
}

HeldPosition held_after(const Move& move, const HeldPosition& before, const Vector3& end_mm,
                        const WriteOptions& options) {
  const Decimals decimals = decimals_of(move, options);
  HeldPosition held = held_at_start(move, before);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Coordinate end = settle_end(move, axis, held[axis], component(end_mm, axis), decimals.end[axis]);
    held[axis] = end.held_mm;
    // Whether a skippable block has moved the axis, the text does not tell.
    if (move.block_delete && (end.write || move.words[axis])) held[axis].reset();
  }
  return held;
}

Decimals decimals_of(const Move& move, const WriteOptions& options) {
  const int resolution = resolution_decimals(move.unit);
  Decimals decimals{{resolution, resolution, resolution}, resolution};
  if (options.decimals >= 0)
    return {{options.decimals, options.decimals, options.decimals}, options.decimals};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis]) decimals.end[axis] = std::max(resolution, move.words[axis]->decimals);
  return decimals;
}

Vector3 as_written_mm(const Vector3& p_mm, LengthUnit unit, const std::array<int, 3>& decimals) {
  Vector3 p;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    p[axis] = rounded(p_mm[axis] / mm_per(unit), decimals[static_cast<std::size_t>(axis)]) * mm_per(unit);
  return p;
}

}  // namespace counterflex
