// The pole (CC), and moves whose ends are polar coordinates: LP and CP.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "program/dialect.hpp"
#include "program/klartext/read.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 3> axis_keys{"X", "Y", "Z"};
constexpr double full_turn_deg = 360;

double mm_per_word(const KlartextReading& r) {
  return r.state.unit ? mm_per(*r.state.unit) : 1.0;
}

/// Axes of the plane. Angles are measured from the first to the second.
std::array<std::size_t, 2> plane_axes(int normal) {
  const auto n = static_cast<std::size_t>(normal);
  return {(n + 1) % 3, (n + 2) % 3};
}

double angle_of(const Vector3& arm, int normal) {
  const auto [a, b] = plane_axes(normal);
  return std::atan2(arm[static_cast<Eigen::Index>(b)], arm[static_cast<Eigen::Index>(a)]);
}

/// The point at `angle` (rad) and `radius` about the pole, at the height of `at`.
Vector3 polar_place(const KlartextPole& pole, double radius, double angle, Vector3 at) {
  const auto [a, b] = plane_axes(pole.normal);
  const auto i = static_cast<Eigen::Index>(a), k = static_cast<Eigen::Index>(b);
  at[i] = pole.centre_mm[i] + radius * std::cos(angle);
  at[k] = pole.centre_mm[k] + radius * std::sin(angle);
  return at;
}

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// Words of polar coordinates; a missing word is null.
struct PolarWords {
  const KlartextWord *radius, *more_radius, *angle, *more_angle;
  const KlartextWord* first;  ///< the first of them in the block
};

/// Empty if a word is not a plain number, or if both words of a kind are there.
std::optional<PolarWords> polar_words(const KlartextReading& r) {
  PolarWords words{find_word(r.words, "PR"), find_word(r.words, "IPR"), find_word(r.words, "PA"),
                   find_word(r.words, "IPA"), nullptr};
  for (const KlartextWord* word : {words.radius, words.more_radius, words.angle, words.more_angle}) {
    if (word == nullptr) continue;
    if (!word->literal) return std::nullopt;
    if (words.first == nullptr) words.first = word;
  }
  const bool twice = (words.radius && words.more_radius) || (words.angle && words.more_angle);
  if (twice || words.first == nullptr) return std::nullopt;
  return words;
}

/// The value of `word`, or the last value plus `more`; empty if it is unknown.
std::optional<double> sum_of(const KlartextWord* word, const KlartextWord* more, double unit,
                             const std::optional<double>& last) {
  if (word != nullptr) return word->value * unit;
  if (!last) return std::nullopt;
  return *last + (more != nullptr ? more->value * unit : 0);
}

std::string place_line(const PolarWords& words, KlartextReading& r) {
  KlartextPole& pole = *r.state.pole;
  const auto radius = sum_of(words.radius, words.more_radius, mm_per_word(r), pole.radius_mm);
  const auto angle = sum_of(words.angle, words.more_angle, radians(1), pole.angle);
  if (!radius || !angle)
    return "LP is relative to the polar coordinates of the block before it, which has no polar coordinates "
           "about "
           "this CC: give PR and PA";
  pole.radius_mm = *radius;
  pole.angle = *angle;
  r.state.position_mm = polar_place(pole, *radius, *angle, r.state.position_mm);
  return {};
}

/// The end about the pole. `arc` gets its full turns.
std::string place_arc(const PolarWords& words, KlartextReading& r, const Move& move, ArcMove& arc) {
  KlartextPole& pole = *r.state.pole;
  Vector3 arm = move.start_mm - pole.centre_mm;
  arm[pole.normal] = 0;
  const double radius = arm.norm(), begin = angle_of(arm, pole.normal);
  if (words.radius || words.more_radius) return "CP with PR is not supported: give the angle only";
  if (!(radius > 0)) return "CP begins at its own pole";
  double end = 0;
  Vector3 place = move.start_mm;
  if (words.angle) {
    arc.polar = PolarEnd::in_direction;
    end = radians(words.angle->value);
    place = polar_place(pole, radius, end, move.start_mm);
  } else {
    const double degrees = words.more_angle->value, size = std::abs(degrees);
    if (degrees == 0 || (degrees < 0) != arc.clockwise) return "IPA and DR of CP have different signs";
    if (size > 1e6) return "IPA of CP is more than 1e6 degrees";
    arc.polar = PolarEnd::by_angle;
    arc.turns = static_cast<int>(std::ceil(size / full_turn_deg)) - 1;
    end = begin + radians(degrees);
    if (std::fmod(size, full_turn_deg) != 0) place = polar_place(pole, radius, end, move.start_mm);
  }
  for (const std::size_t axis : plane_axes(pole.normal))
    r.state.position_mm[static_cast<Eigen::Index>(axis)] = place[static_cast<Eigen::Index>(axis)];
  pole.radius_mm = radius;
  pole.angle = end;
  return {};
}

std::string place_circle(const PolarWords& words, KlartextReading& r, Move& move) {
  const KlartextPole& pole = *r.state.pole;
  const KlartextWord* direction = find_word(r.words, "DR");
  if (pole.must_stay) return "CP has a CC that another block uses, which is not followed: give CC before CP";
  if (!r.state.tool_along_z) return "CP with a tool that is not along Z is not supported";
  if (direction == nullptr || empty(direction->number)) return "CP has no DR+ or DR-";
  for (const std::size_t axis : plane_axes(pole.normal))
    if (!move.known_start[axis]) return "the start of CP is not known";
  const auto normal = static_cast<std::size_t>(pole.normal);
  if (!move.known_start[normal] && move.words[normal]) return "the start height of a helix is not known";
  ArcMove arc;
  arc.clockwise = r.program.text[direction->number.begin] == '-';
  arc.flat = true;
  set_centre(arc, pole, move, r);
  if (std::string why = place_arc(words, r, move, arc); !why.empty()) return why;
  move.arc = arc;
  return {};
}

}  // namespace

bool has_own_words(const KlartextPole& pole, const KlartextReading& r) {
  constexpr std::size_t most_moves_between = 16;  // a window holds the CC and the arc
  return pole.just_set && r.moves_read - pole.set_at <= most_moves_between;
}

void set_centre(ArcMove& arc, const KlartextPole& pole, const Move& move, const KlartextReading& r) {
  const bool from_start = pole.incremental && pole.set_at == r.moves_read;
  arc.normal = pole.normal;
  arc.absolute_centre = !from_start;
  arc.centre_mm = pole.centre_mm;
  arc.centre_mm[pole.normal] = move.start_mm[pole.normal];
  if (has_own_words(pole, r) && (from_start || !pole.incremental)) arc.centre_words = pole.words;
}

std::string place_polar_end(const KlartextBlock& block, KlartextReading& r, Move& move) {
  KlartextState& state = r.state;
  const auto words = polar_words(r);
  if (!words) return block.head + " has no angle or radius of plain numbers";
  if (!state.pole) return block.head + " needs a known pole: give CC with plain numbers before it";
  const auto axes = plane_axes(state.pole->normal);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (find_word(r.words, axis_keys[axis]) == nullptr) continue;
    if (axis == axes[0] || axis == axes[1])
      return block.head + " with both polar and Cartesian coordinates in its plane is not supported";
    if (!state.known[axis]) return block.head + " ends at a height that is not known";
  }
  std::string why = block.head == "LP" ? place_line(*words, r) : place_circle(*words, r, move);
  if (!why.empty()) return why;
  move.polar = true;
  for (const std::size_t axis : axes) {
    move.words[axis] = AxisWord{words->first->number, 0};
    state.known[axis] = true;
  }
  if (block.head == "LP") state.pole->just_set = false;
  return {};
}

void read_klartext_pole(const KlartextBlock& block, KlartextReading& r) {
  r.state.pole.reset();
  const bool unfollowed = std::binary_search(r.outline.poles.begin(), r.outline.poles.end(), block.line);
  const bool lexed = read_words(block, r);
  if (!lexed || r.words.size() != 2 || may_not_run(block, r)) return;
  KlartextPole pole;
  pole.just_set = true;
  pole.set_at = r.moves_read;
  int axes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const KlartextWord* word = find_word(r.words, axis_keys[axis]);
    if (word == nullptr) {
      pole.normal = static_cast<int>(axis);
      continue;
    }
    if (!word->literal || (word->incremental && !r.state.known[axis])) return;
    ++axes;
    pole.words[axis] = AxisWord{word->number, word->decimals};
    pole.centre_mm[i] = word->value * mm_per_word(r) + (word->incremental ? r.state.position_mm[i] : 0);
    pole.incremental = pole.incremental || word->incremental;
  }
  if (axes != 2) return;
  pole.must_stay = unfollowed;
  const bool mixed = r.words[0].incremental != r.words[1].incremental;
  if (mixed || unfollowed)
    pole.just_set = pole.incremental = false;  // known, but not a pole whose words can move it
  r.state.pole = pole;
}

}  // namespace counterflex
