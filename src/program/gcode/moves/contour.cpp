#include "program/gcode/moves/contour.hpp"

#include <algorithm>
#include <cmath>

#include "program/gcode/moves/read_move.hpp"

namespace counterflex {
namespace {

bool may_join(const Move& move) {
  return !move.cycle && !move.fixed[0] && !move.fixed[1] && !move.fixed[2] && move.handling != Handling::held;
}

void put_into(Move& move, int group) {
  move.group = group;
  move.handling = Handling::group;
  move.may_split = move.may_jump = false;
}

/// The plunge before the contour, and the move across to its begin.
void take_moves_before(Reading& r) {
  std::vector<Move>& moves = r.program.moves;
  const std::size_t first = first_before_contour(r.program, r.run_begin);
  for (std::size_t i = moves.size(); i-- > first;) {
    // Moves that leave one contour may begin the next one. Both then share one shift.
    if (moves[i].group != 0) {
      r.state.group = moves[i].group;
      for (std::size_t k = i; k < moves.size(); ++k)
        if (may_join(moves[k]) || moves[k].group != 0) put_into(moves[k], r.state.group);
      return;
    }
    if (!may_join(moves[i])) return;
    put_into(moves[i], r.state.group);
  }
}

/// D of G41.1 and G42.1 in the block.
const Word* stated_diameter(const Reading& r, const FoundG& cutter) {
  const bool stated = (cutter.code->tenths % 10) != 0 && r.dialect.family == linuxcnc_family;
  return stated ? r.sorted.word('D') : nullptr;
}

/// A negative D moves the cutter to the other side.
CutterSide side_of(const FoundG& cutter, const Word* diameter) {
  const bool is_left = cutter.code->tenths < 420, is_other = diameter != nullptr && diameter->value < 0;
  return is_left != is_other ? CutterSide::left : CutterSide::right;
}

/// Notes the diameter of the tool for the last move, where it differs from that of the move before.
void note_diameter(Reading& r) {
  std::vector<CutterDiameter>& known = r.program.cutter_diameters;
  const std::optional<double> last_mm = known.empty() ? std::nullopt : known.back().mm;
  if (r.state.cutter_diameter_mm != last_mm)
    known.push_back({r.program.moves.size() - 1, r.state.cutter_diameter_mm});
}

/// Arcs at which the cutter has arrived before, and whose end no word of the block gives: points on them do
/// not change the plane.
bool may_divide(const Reading& r, const Move& move) {
  return move.arc && move.may_split && r.state.contour == Contour::inside && r.state.beside_contour &&
         r.sorted.word('D') == nullptr && r.sorted.word('H') == nullptr;
}

}  // namespace

bool changes_compensation(const ModalState& state) {
  return state.contour == Contour::taking_off || (state.contour == Contour::inside && !state.beside_contour);
}

bool is_along_z(const Move& move) {
  return !move.words[0] && !move.words[1] && !move.fixed[0] && !move.fixed[1] && !move.arc;
}

bool ends_along_z(const Program& window) {
  const std::vector<Move>& moves = window.moves;
  const auto last_across = std::find_if_not(moves.rbegin(), moves.rend(), is_along_z);
  const bool goes_back = last_across == moves.rend() &&
                         window.before;  // a window begins like this only after as many moves along Z
  return goes_back || last_across - moves.rbegin() > most_moves_before_contour;
}

std::size_t first_before_contour(const Program& program, std::size_t run_begin) {
  const std::vector<Move>& moves = program.moves;
  std::size_t first = moves.size();
  while (first > run_begin && moves[first - 1].group == 0 && is_along_z(moves[first - 1])) --first;
  const bool goes_back = first == 0 && program.before;  // the window before has more of them
  if (goes_back || std::ssize(moves) - static_cast<std::ptrdiff_t>(first) > most_moves_before_contour)
    return moves.size();
  // An arc keeps its own correction: with the shift of the contour at its end alone it would not be round.
  return first > run_begin && !moves[first - 1].arc ? first - 1 : first;
}

void apply_cutter(Reading& r) {
  ModalState& state = r.state;
  if (const FoundG* cutter = r.sorted.find(Action::cutter)) {
    const Word* diameter = stated_diameter(r, *cutter);
    state.cutter_side = state.normal == 2 ? side_of(*cutter, diameter) : CutterSide::none;
    state.cutter_diameter_mm.reset();
    if (diameter != nullptr && diameter->literal)
      state.cutter_diameter_mm = std::abs(length_mm(r, *diameter));
    state.beside_contour = false;
    if (state.contour != Contour::inside) {
      state.group = r.groups + 1;
      if (why_not_followed(r).empty()) take_moves_before(r);
      r.groups = std::max(state.group, r.groups);
    }
    state.contour = Contour::inside;
  } else if (r.sorted.has(Action::no_cutter) && state.contour == Contour::inside) {
    state.contour = Contour::taking_off;
  }
}

void join_contour(Reading& r) {
  ModalState& state = r.state;
  if (state.contour == Contour::none || !why_not_followed(r).empty()) return;
  note_diameter(r);
  Move& move = r.program.moves.back();
  const bool outside = state.contour != Contour::inside;
  const bool takes_off = state.contour == Contour::taking_off &&
                         (r.sorted.has(Action::no_cutter) || move.motion == Motion::feed);
  if (outside && (!may_join(move) || (!is_along_z(move) && !takes_off))) return end_contour(r);
  if (may_join(move)) {
    const bool divides = may_divide(r, move);
    put_into(move, state.group);
    move.may_split = divides;
    if (!outside && state.beside_contour && !is_along_z(move)) move.cutter_side = state.cutter_side;
  }
  if (!is_along_z(move)) state.beside_contour = state.contour == Contour::inside;
  if (outside) state.contour = Contour::leaving;
}

void end_contour(Reading& r) {
  if (r.state.contour != Contour::inside) r.state.contour = Contour::none;
}

}  // namespace counterflex
