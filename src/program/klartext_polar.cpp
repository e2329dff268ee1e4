#include "program/klartext_read.hpp"

namespace counterflex {
namespace {

/// Whether all of the block's way goes along with a shift of its pole and its start.
bool is_rigid(const KlartextBlock& block, const KlartextReading& r) {
  const KlartextState& state = r.state;
  const KlartextWord* z = find_word(r.words, "Z");
  const bool along_z = z == nullptr || z->incremental;
  const bool contour = state.contour || find_word(r.words, "RL") != nullptr ||
                       find_word(r.words, "RR") != nullptr || find_word(r.words, "R") != nullptr;
  const bool across = find_word(r.words, "X") != nullptr || find_word(r.words, "Y") != nullptr;
  const bool followed = state.elsewhere.empty() && !holds(r.doubtful, block.line);
  return followed && along_z && !contour && !across && state.pole && state.pole->just_set &&
         state.tool_along_z && state.unit;
}

}  // namespace

void add_polar_arc(const KlartextBlock& block, KlartextReading& r) {
  if (!is_rigid(block, r)) return add_unfollowed_move(block, r, "a polar arc is not followed");
  Move move = begin_klartext_move(block, r);
  move.motion = Motion::feed;
  move.handling = Handling::held;
  // What a shift changes are the words of the pole: they stand for a place, and where the arc ends is not
  // followed.
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    move.words[axis] = r.state.pole->words[axis];
    move.end_mm[i] = r.state.pole->centre_mm[i];
    r.state.known[axis] = false;
  }
  if (find_word(r.words, "Z") != nullptr) r.state.known[2] = false;
  move.known_end = r.state.known;
  r.state.pole.reset();
  r.state.after_contour = r.state.rounds_next = false;
  r.program.moves.push_back(std::move(move));
  r.state.run_begin = r.program.moves.size();
  leave_alone(r, block.line, "a polar arc is not followed");
}

}  // namespace counterflex
