#include "program/write/text_arc.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "counterflex/files/text.hpp"
#include "program/dialect.hpp"
#include "program/text/arc_radius.hpp"
#include "program/text/number_style.hpp"

namespace counterflex {
namespace {

Vector3 across(const Vector3& v, const ArcMove& arc) {
  Vector3 flat = v;
  flat[arc.normal] = 0;
  return flat;
}

double sweep_of(const ArcMove& arc, const Vector3& start, const Vector3& end, const Vector3& centre_mm) {
  return sweep_between(start, end, centre_mm, normal_of(arc));
}

/// I, J or K: relative to the start unless G90.1 is active.
void round_centre_word(const Move& move, std::size_t axis, const Vector3& start, double wanted_mm,
                       Place place, const WriteOptions& options, ArcWords& words) {
  const ArcMove& arc = *move.arc;
  const double unit = mm_per(move.unit);
  const double from_mm = arc.absolute_centre ? 0 : component(start, axis);
  const double original_mm =
      component(arc.centre_mm, axis) - (arc.absolute_centre ? 0 : component(move.start_mm, axis));
  const auto& word = arc.centre_words[axis];
  // A missing word is zero.
  const double original = word ? shown_number(move, *word, original_mm) : 0;
  WordNumber number = round_number(move, word, original, (wanted_mm - from_mm) / unit, place, options);
  if (!word && number.value == 0) number.write = false;
  words.centre[axis] = number;
  words.curve.arc->centre[static_cast<Eigen::Index>(axis)] = from_mm + number.value * unit;
}

/// R: the mean distance of both ends, at least half the chord.
void round_radius(const Move& move, const Vector3& centre_mm, Place place, const WriteOptions& options,
                  ArcWords& words) {
  const ArcMove& arc = *move.arc;
  const Vector3 &start = words.curve.start, &end = words.curve.end;
  const double unit = mm_per(move.unit);
  const double size_mm = 0.5 * (across(start - centre_mm, arc).norm() + across(end - centre_mm, arc).norm());
  // Half a turn is equally long in both directions: the sign stays, independent of the rounded sweep.
  constexpr double digits_of_ends = 2;
  const auto beyond_half_mm = [&](const Vector3& from, const Vector3& to, const Vector3& centre) {
    return size_mm * (sweep_of(arc, from, to, centre) - std::numbers::pi);
  };
  const double room_mm = digits_of_ends * unit / power_of_ten(decimals_of(move, options).inserted);
  const double beyond_mm = beyond_half_mm(start, end, centre_mm);
  const bool stays_half = std::abs(beyond_mm) < room_mm &&
                          std::abs(beyond_half_mm(move.start_mm, move.end_mm, arc.centre_mm)) < room_mm;
  const bool longer = stays_half ? arc.radius_mm < 0 : beyond_mm > 0;
  const double wanted = (longer ? -size_mm : size_mm) / unit;
  // Controls lengthen an R that is slightly too short.
  const double reaches_mm =
      std::fmax(std::abs(arc.radius_mm), across(move.end_mm - move.start_mm, arc).norm() / 2);
  const double original = std::copysign(reaches_mm, arc.radius_mm) / unit;
  WordNumber number = round_number(move, arc.radius_word, original, wanted, place, options);
  const double half_chord = across(end - start, arc).norm() / 2 / unit;
  if (number.write && std::abs(number.value) < half_chord) {
    const double digit = 1 / power_of_ten(number.decimals);
    number.value =
        rounded(std::copysign(std::ceil(half_chord / digit) * digit, number.value), number.decimals);
  }
  words.radius = number;
  words.curve.arc->centre = centre_from_radius(start, end, number.value * unit, normal_of(arc));
}

/// Rounding has turned a short piece into a full turn: it turns more than its own move or, unless it may be a
/// full circle, more than `via` gives.
bool is_turned_around(const Move& move, const Curve& piece, const Via& via, Place place, int decimals) {
  constexpr double digits_that_ends_may_miss = 2, digits_of_a_safe_radius = 1000,
                   angle_that_digits_may_add = 0.5;
  const ArcMove& arc = *move.arc;
  const double digit_mm = mm_per(move.unit) / power_of_ten(decimals);
  const bool ends_may_have_passed =
      across(piece.end - piece.start, arc).norm() <= digits_that_ends_may_miss * digit_mm;
  const double radius_mm = across(piece.start - piece.arc->centre, arc).norm();
  if (!ends_may_have_passed && radius_mm > digits_of_a_safe_radius * digit_mm) return false;
  double most = sweep_of(arc, move.start_mm, move.end_mm, arc.centre_mm);
  if (place != Place::end || most <= std::numbers::pi) {
    most = std::fmin(most, sweep_of(arc, piece.start, via.end_mm, *via.centre_mm));
    if (ends_may_have_passed) most = std::fmin(most, std::numbers::pi);
  }
  return piece.arc->sweep > most + angle_that_digits_may_add;
}

/// The auxiliary point, and the arc that a control reads through the rounded point. The height of the centre
/// above the start, along the normal, is added to that of the point: it tilts the plane of the arc.
std::optional<ArcWords> round_point(const Move& move, const Via& via, Place place,
                                    const WriteOptions& options, ArcWords words) {
  const ArcMove& arc = *move.arc;
  Curve wanted{words.curve.start, via.end_mm, Arc{*via.centre_mm, normal_of(arc), 0}};
  wanted.arc->sweep = sweep_of(arc, wanted.start, wanted.end, *via.centre_mm);
  const Vector3 normal = normal_of(arc);
  const Vector3 point = point_at(wanted, share_of_point(move, wanted.arc->sweep)) +
                        normal * normal.dot(*via.centre_mm - words.curve.start);
  Vector3 written;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double unit = mm_per(move.unit);
    words.centre[axis] = round_number(move, arc.centre_words[axis], component(arc.through->p_mm, axis) / unit,
                                      component(point, axis) / unit, place, options);
    written[static_cast<Eigen::Index>(axis)] = words.centre[axis].value * unit;
  }
  words.curve.arc = arc_through(words.curve.start, written, words.curve.end);
  if (!words.curve.arc || words.curve.arc->normal.dot(normal_of(arc)) <= 0) return std::nullopt;
  return words;
}

}  // namespace

double share_of_point(const Move& move, double sweep) {
  constexpr double most_other_sweep = 0.1;  // of the original's
  const ArcMove& arc = *move.arc;
  const double whole = sweep_of(arc, move.start_mm, move.end_mm, arc.centre_mm);
  return std::abs(sweep - whole) > most_other_sweep * whole ? 0.5 : arc.through->share;
}

Curve polar_arc(const Move& move, const Vector3& start, const Vector3& centre_mm) {
  const ArcMove& arc = *move.arc;
  const Vector3 normal = normal_of(arc), arm = across(start - centre_mm, arc),
                end_arm = across(move.end_mm - arc.centre_mm, arc);
  const double way = sweep_between(move.start_mm, move.end_mm, arc.centre_mm, normal, arc.turns);
  Curve curve{start, start, Arc{centre_mm, normal, way}};
  if (arc.polar == PolarEnd::in_direction) {
    curve.end = centre_mm + arm.norm() * end_arm.normalized();
    curve.arc->sweep = sweep_between(start, curve.end, centre_mm, normal);
  } else {
    curve.end = centre_mm + std::cos(way) * arm + std::sin(way) * normal.cross(arm);
  }
  curve.end[arc.normal] = start[arc.normal] + (move.end_mm - move.start_mm)[arc.normal];
  return curve;
}

std::optional<ArcWords> round_arc(const Move& move, const Vector3& start, const Vector3& end, const Via& via,
                                  Place place, const WriteOptions& options) {
  const ArcMove& arc = *move.arc;
  ArcWords words;
  words.curve = {start, end, Arc{start, normal_of(arc), 0}};
  if (arc.through) return round_point(move, via, place, options, words);
  if (arc.radius_word) {
    if (across(end - start, arc).isZero(0)) return std::nullopt;
    round_radius(move, *via.centre_mm, place, options, words);
  } else {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (in_plane(arc, axis))
        round_centre_word(move, axis, start, component(*via.centre_mm, axis), place, options, words);
  }
  words.curve.arc->sweep = sweep_of(arc, start, end, words.curve.arc->centre);
  if (place == Place::end && arc.turns > 0 && !arc.flat)
    words.curve.arc->sweep += 2 * std::numbers::pi * arc.turns;
  else if (is_turned_around(move, words.curve, via, place, decimals_of(move, options).inserted))
    return std::nullopt;
  return words;
}

}  // namespace counterflex
