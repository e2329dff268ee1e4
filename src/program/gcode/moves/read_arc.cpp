#include "program/gcode/moves/read_arc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "program/gcode/moves/read_move.hpp"
#include "program/text/arc_radius.hpp"

namespace counterflex {
namespace {

constexpr std::array<char, 3> letters_of_centre{'I', 'J', 'K'};
constexpr double most_turns = 100;  // of one arc; each turn is sampled, and the results are stored
constexpr std::size_t more_turns_than_blocks =
    10000;                              // limit for a program: computing time is proportional to its turns
constexpr double most_turned_mm = 1e6;  // limit for the length of all full turns of a program

/// Axes of the plane. From the first to the second is counter-clockwise about the normal.
struct Plane {
  std::size_t first, second;
};

bool in_plane(const Plane& plane, std::size_t axis) {
  return axis == plane.first || axis == plane.second;
}

Plane plane_of(int normal) {
  return {static_cast<std::size_t>((normal + 1) % 3), static_cast<std::size_t>((normal + 2) % 3)};
}

bool is_plain(const Word* word) {
  return word == nullptr || word->literal;
}

const Word* word_of_turns(const Reading& r) {
  return arcs_have_turns(r.dialect) ? r.sorted.word('P') : nullptr;
}

bool words_are_plain(const Reading& r) {
  for (const char letter : {'I', 'J', 'K', 'R'})
    if (!is_plain(r.sorted.word(letter))) return false;
  return is_plain(word_of_turns(r));
}

/// Refuses words that are an arc on no control.
void check_words(const Block& block, const Reading& r) {
  const bool centre = r.sorted.has_any("IJK");
  const Plane plane = plane_of(r.state.normal);
  const char first = letters_of_centre[plane.first], second = letters_of_centre[plane.second];
  const Word* radius = r.sorted.word('R');
  if (centre && radius != nullptr) refuse_word(block, r, *radius, "an arc has either R or I, J and K");
  if (!centre && radius == nullptr)
    refuse_word(block, r, first_axis_word(block), "the arc has neither I, J, K nor R");
  if (centre && !r.sorted.word(first) && !r.sorted.word(second))
    refuse_word(block, r, block.words.front(),
                fmt::format("the arc has neither {} nor {}, which give its centre in the active plane",
                            std::min(first, second), std::max(first, second)));
  const Word* across = r.sorted.word(letters_of_centre[static_cast<std::size_t>(r.state.normal)]);
  // Some post processors write half the rise of a helix there, and hobby controls ignore it.
  const bool ignored = (r.dialect.family & (grbl_family | mach3_family)) != 0;
  if (across != nullptr && across->literal && across->value != 0 && !ignored)
    refuse_word(block, r, *across,
                fmt::format("{} is not a centre word of an arc in the active plane", across->letter));
  const Word* turns = word_of_turns(r);
  if (turns != nullptr && turns->literal && (turns->value < 1 || turns->value != std::floor(turns->value)))
    refuse_word(block, r, *turns,
                fmt::format("P{} is not a number of turns: expected an integer from 1", turns->value));
  if (turns != nullptr && turns->literal && turns->value > most_turns)
    refuse_word(
        block, r, *turns,
        fmt::format("{:.0f} turns in one arc: at most {:.0f} are allowed; divide the arc into several blocks",
                    turns->value, most_turns));
}

/// Whether I, J and K are coordinates: by G90.1, or by their own form ("I=AC(5)").
bool centre_is_absolute(const Reading& r) {
  if (r.state.absolute_centres) return true;
  for (const char letter : letters_of_centre)
    if (const Word* word = r.sorted.word(letter); word != nullptr && word->mode == DistanceMode::absolute)
      return true;
  return false;
}

/// Whether one coordinate of the centre is marked as absolute and another is not.
bool centre_is_mixed(const Reading& r, const Plane& plane) {
  const Word *first = r.sorted.word(letters_of_centre[plane.first]),
             *second = r.sorted.word(letters_of_centre[plane.second]);
  const auto absolute = [](const Word* word) {
    return word != nullptr && word->mode == DistanceMode::absolute;
  };
  return absolute(first) != absolute(second);
}

/// Centre by I, J, K. In absolute form both must be there.
void set_centre(const Block& block, const Reading& r, const Plane& plane, const Move& move, ArcMove& arc) {
  arc.absolute_centre = centre_is_absolute(r);
  for (std::size_t i = 0; i < 3; ++i)
    if (const Word* word = r.sorted.word(letters_of_centre[i]);
        word != nullptr && (in_plane(plane, i) || word->value == 0))
      arc.centre_words[i] = AxisWord{word->number, word->decimals};
  for (const std::size_t axis : {plane.first, plane.second}) {
    const Word* word = r.sorted.word(letters_of_centre[axis]);
    if (word == nullptr && arc.absolute_centre)
      refuse_word(
          block, r, block.words.front(),
          fmt::format("an arc whose centre is absolute needs {} in this plane", letters_of_centre[axis]));
    const double value = word != nullptr ? length_mm(r, *word) : 0;
    const Vector3& start = move.start_mm;
    coordinate(arc.centre_mm, axis) =
        value + (arc.absolute_centre ? 0 : start[static_cast<Eigen::Index>(axis)]);
  }
}

/// Distances (mm) of an arc's start and end from a centre.
struct Radii {
  double start, end;
};

Radii radii_about(const Vector3& centre, const Plane& plane, const Vector3& start, const Vector3& end) {
  const auto distance = [&](const Vector3& p) {
    const auto a = static_cast<Eigen::Index>(plane.first), b = static_cast<Eigen::Index>(plane.second);
    return std::hypot(p[a] - centre[a], p[b] - centre[b]);
  };
  return {distance(start), distance(end)};
}

bool agree(const Radii& radii, const Reading& r) {
  const bool inch = r.state.unit == LengthUnit::inches;
  return radii_agree(inch ? r.dialect.radius_room_inch : r.dialect.radius_room, radii.start, radii.end);
}

/// The centre words of the plane, as they are in the text: "I-24.273 J0.025".
std::string centre_text(const Reading& r, const Plane& plane) {
  std::string text;
  for (const std::size_t axis : {std::min(plane.first, plane.second), std::max(plane.first, plane.second)})
    if (const Word* word = r.sorted.word(letters_of_centre[axis]))
      text += fmt::format("{}{}", text.empty() ? "" : " ", part(r.program.text, word->span));
  return text;
}

/// The cure if the words fit when they are read the other way.
std::string cure_of_centres(const Reading& r, bool absolute) {
  const std::string fits =
      fmt::format("read as {} the words fit: ", absolute ? "distances from the start" : "coordinates");
  if (absolute != r.options.absolute_centres)  // the option applies up to the code
    return fits + (absolute ? "G90.1 is active, which may be wrong" : "G91.1 is active, which may be wrong");
  return fits + fmt::format("give --arc-centres {}", absolute ? "incremental" : "absolute");
}

/// Refuses a centre that is not equally far from both ends: on no control this is an arc.
void check_radii(const Block& block, const Reading& r, const Plane& plane, const Move& move,
                 const ArcMove& arc) {
  const Vector3 &start = move.start_mm, &end = r.state.position_mm;
  const Radii radii = radii_about(arc.centre_mm, plane, start, end);
  if (agree(radii, r)) return;
  const Word* word = r.sorted.word(letters_of_centre[plane.first]);
  if (word == nullptr) word = r.sorted.word(letters_of_centre[plane.second]);
  const Vector3 otherwise = arc.centre_mm + (arc.absolute_centre ? start : Vector3(-start));
  const bool both =
      r.sorted.word(letters_of_centre[plane.first]) && r.sorted.word(letters_of_centre[plane.second]);
  const bool others_fit = (both || arc.absolute_centre) && word->mode == DistanceMode::modal &&
                          agree(radii_about(otherwise, plane, start, end), r);
  const std::string cure =
      others_fit ? cure_of_centres(r, arc.absolute_centre) : "correct the end or the centre of the arc";
  refuse_word(
      block, r, *word,
      fmt::format(
          "{}: the radius is {:.4f} mm at the arc's start and {:.4f} mm at its end, which differ by more "
          "than a {} control accepts; {}",
          centre_text(r, plane), radii.start, radii.end, r.dialect.name, cure));
}

/// Centre by R, as in LinuxCNC: the chord may be 0.05 mm longer than twice the radius. False if the end is
/// the start.
bool set_centre_of_radius(const Block& block, const Reading& r, const Plane& plane, const Vector3& end,
                          const Move& move, ArcMove& arc) {
  const Word& word = *r.sorted.word('R');
  arc.radius_word = AxisWord{word.number, word.decimals};
  arc.radius_mm = length_mm(r, word);
  const auto a = static_cast<Eigen::Index>(plane.first), b = static_cast<Eigen::Index>(plane.second);
  const double half_chord = std::hypot(end[a] - move.start_mm[a], end[b] - move.start_mm[b]) / 2;
  const double radius = std::abs(arc.radius_mm);
  if (half_chord == 0) return false;
  if (half_chord - radius > 0.05)
    refuse_word(block, r, word,
                fmt::format("R{}: the arc's ends are {:.6g} mm apart, more than twice the radius", word.value,
                            2 * half_chord));
  const Vector3 centre = centre_from_radius(move.start_mm, end, arc.radius_mm, normal_of(arc));
  arc.centre_mm[a] = centre[a];
  arc.centre_mm[b] = centre[b];
  return true;
}

/// The arc of `move`, whose words were read. Empty if the arc has no length.
std::optional<ArcMove> arc_of(const Block& block, const Reading& r, const Move& move) {
  ArcMove arc;
  arc.normal = r.state.normal;
  arc.clockwise = r.state.motion == MotionMode::clockwise;
  arc.centre_mm[arc.normal] = move.start_mm[arc.normal];
  if (const Word* p = word_of_turns(r)) arc.turns = static_cast<int>(count_of(*p) - 1);
  const Plane plane = plane_of(arc.normal);
  if (r.sorted.word('R') == nullptr) {
    set_centre(block, r, plane, move, arc);
    check_radii(block, r, plane, move, arc);
  } else if (!set_centre_of_radius(block, r, plane, r.state.position_mm, move, arc)) {
    return std::nullopt;
  }
  return arc;
}

/// An arc that cannot be followed. Its positions in the plane are fixed; if all its words are relative, the
/// arc is held.
void hold_arc(Reading& r, Move& move, const Plane& plane, bool start_known) {
  move.may_insert_words = false;
  move.handling = Handling::held;
  const bool rigid = start_known && !(centre_is_absolute(r) && r.sorted.has_any("IJK"));
  if (rigid) return;
  for (const std::size_t axis : {plane.first, plane.second})
    if (r.sorted.word(letters_of_axes[axis]) != nullptr) fix_axis(r, move, axis);
}

std::string_view why_unknown(const Reading& r, bool start_known) {
  if (!start_known) return "the start of the arc is not known";
  if (words_are_plain(r)) return "the arc is not known";
  return r.options.evaluate
             ? "the centre, radius or number of turns of the arc is a variable or an expression "
               "whose value is not known from the text"
             : "the centre, radius or number of turns of the arc is a variable or an expression "
               "(--evaluate works out constants)";
}

/// Limits the computing time of a short program. Reports the error at P, because without P there are fewer
/// turns than blocks.
void count_turns(const Block& block, Reading& r, const ArcMove& arc, const Vector3& start_mm) {
  r.turns += static_cast<std::size_t>(arc.turns) + 1;
  if (arc.turns == 0) return;
  Vector3 arm = start_mm - arc.centre_mm;
  arm[arc.normal] = 0;
  r.turned_mm += 2 * std::numbers::pi * arm.norm() * arc.turns;
  if (r.turned_mm > most_turned_mm)
    refuse_word(block, r, *word_of_turns(r),
                fmt::format("the full turns of the arcs up to here are {:.0f} m long: at most {:.0f} m are "
                            "allowed; write each turn as "
                            "a block",
                            r.turned_mm / 1000, most_turned_mm / 1000));
  if (r.turns <= r.program.block_count + more_turns_than_blocks) return;
  refuse_word(
      block, r, *word_of_turns(r),
      fmt::format(
          "the arcs up to here have {} turns in {} blocks: at most {} turns more than blocks are allowed; "
          "write each turn as a block",
          r.turns, r.program.block_count, more_turns_than_blocks));
}

}  // namespace

void read_arc(const Block& block, Reading& r) {
  Move& move = start_move(block, r, Motion::feed);
  const bool followed = why_not_followed(r).empty();
  if (followed) check_words(block, r);
  place_words(block, r, move);
  const Plane plane = plane_of(r.state.normal);
  const bool start_known = move.known_start[plane.first] && move.known_start[plane.second];
  const bool end_known = r.state.known[plane.first] && r.state.known[plane.second];
  const bool resolved =
      followed && start_known && end_known && words_are_plain(r) && !centre_is_mixed(r, plane);
  if (resolved) move.arc = arc_of(block, r, move);
  if (move.arc) count_turns(block, r, *move.arc, move.start_mm);
  if (!move.arc) {
    hold_arc(r, move, plane, start_known);
    if (followed) forget_way(move), note_uncorrected(block, r, why_unknown(r, start_known));
  }
  finish_move(r, move);
}

}  // namespace counterflex
