#include <fmt/format.h>

#include <cmath>

#include "program/dialect.hpp"
#include "program/klartext/read.hpp"
#include "program/text/arc_radius.hpp"

namespace counterflex {
namespace {

/// The centre of an arc of given radius; empty if its ends coincide or are too far apart.
std::optional<Vector3> centre_of_radius(const Move& move, double radius, bool clockwise) {
  const double half = 0.5 * (move.end_mm - move.start_mm).head<2>().norm();
  if (half == 0 || half > std::abs(radius) * 1.001) return std::nullopt;
  return centre_from_radius(move.start_mm, move.end_mm, radius, (clockwise ? -1 : 1) * Vector3::UnitZ());
}

void set_arc(const KlartextBlock& block, KlartextReading& r, Move& move, bool clockwise) {
  ArcMove arc;
  arc.clockwise = clockwise;
  arc.flat = true;
  if (block.head == "CR") {
    const KlartextWord* radius = find_word(r.words, "R");
    if (radius == nullptr || !radius->literal) return;
    arc.radius_word = AxisWord{radius->number, radius->decimals};
    arc.radius_mm = klartext_length_mm(r, *radius);
    const auto centre = centre_of_radius(move, arc.radius_mm, clockwise);
    if (!centre) return;
    arc.centre_mm = *centre;
    arc.centre_mm.z() = move.start_mm.z();
  } else {
    set_centre(arc, *r.state.pole, move, r);
  }
  move.arc = arc;
}

/// Whether an arc across the axis `normal` has known ends and no word of that axis.
bool has_known_ends(const KlartextReading& r, const Move& move, std::size_t normal) {
  bool known =
      r.state.tool_along_z && find_word(r.words, std::string_view("XYZ").substr(normal, 1)) == nullptr;
  for (std::size_t axis = 0; axis < 3; ++axis)
    known = known && (axis == normal || (move.known_start[axis] && r.state.known[axis]));
  return known;
}

/// Refuses a pole that is not equally far from both ends: this is not an arc.
void check_radii(const KlartextBlock& block, const KlartextReading& r, const Move& move) {
  const auto radius_at = [&](Vector3 p) {
    p -= move.arc->centre_mm;
    p[move.arc->normal] = 0;
    return p.norm();
  };
  const double start = radius_at(move.start_mm), end = radius_at(move.end_mm);
  if (radii_agree(find_dialect(klartext_name)->radius_room, start, end)) return;
  refuse_klartext(r.program.text, r.program.file, block, r.words.front().span.begin,
                  fmt::format("the radius about CC is {:.4f} mm at the arc's start and {:.4f} mm at its end, "
                              "which differ by more "
                              "than a heidenhain control accepts; correct the end of the arc or its CC",
                              start, end));
}

constexpr double straight = 1e-6;  // rad: an arc with a smaller sweep is a line

/// The direction of a move at its end, across Z; zero if it is unknown.
Vector3 direction_at_end(const Move& move) {
  if (!all_known(move.known_start) || !all_known(move.known_end) || move.motion == Motion::rapid)
    return Vector3::Zero();
  Vector3 way = move.end_mm - move.start_mm;
  if (move.arc) {
    if (move.arc->normal != 2) return Vector3::Zero();
    way = normal_of(*move.arc).cross(move.end_mm - move.arc->centre_mm);
  }
  way.z() = 0;
  return way.isZero(0) ? way : Vector3(way.normalized());
}

}  // namespace

void read_klartext_arc(const KlartextBlock& block, KlartextReading& r, Move& move) {
  const KlartextWord* direction = find_word(r.words, "DR");
  const bool direction_known = direction != nullptr && !empty(direction->number);
  const bool may_move = block.head == "CR" || !r.state.pole || !r.state.pole->must_stay;
  const bool centre_known = (block.head == "CR" || r.state.pole) && may_move;
  const int normal = block.head == "C" && r.state.pole ? r.state.pole->normal : 2;
  const bool ends_known = has_known_ends(r, move, static_cast<std::size_t>(normal));
  if (direction_known && centre_known && ends_known)
    set_arc(block, r, move, r.program.text[direction->number.begin] == '-');
  if (move.arc && block.head == "C") check_radii(block, r, move);
  if (move.arc) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!move.words[axis] && !move.fixed[axis]) continue;
    move.fixed[axis] = true;
    move.words[axis].reset();
    r.state.known[axis] = false;
  }
  move.incremental = 0;
  note_uncorrected(r, block.line,
                   block.head + (may_move ? ": the start or the centre of the arc is unknown"
                                          : " has a CC that another block uses, which is not followed"));
}

bool read_klartext_tangent_arc(KlartextReading& r, Move& move) {
  const auto& moves = r.program.moves;
  if (moves.empty() || r.state.corner || !has_known_ends(r, move, 2) || !move.known_start[2]) return false;
  const Vector3 way = direction_at_end(moves.back()), chord = move.end_mm - move.start_mm,
                side(-way.y(), way.x(), 0);
  const double across = side.dot(chord);
  if (std::abs(across) <= straight * chord.norm() || moves.back().end_mm != move.start_mm) return false;
  ArcMove arc;
  arc.flat = arc.absolute_centre = true;
  arc.clockwise = across < 0;
  arc.centre_mm = move.start_mm + chord.squaredNorm() / (2 * across) * side;
  move.arc = arc;
  return true;
}

}  // namespace counterflex
