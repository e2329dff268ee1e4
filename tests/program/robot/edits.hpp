#pragma once
/// Edits of robot programs in tests.
#include "program/reading.hpp"

namespace counterflex::test {

inline MoveEdit robot_edit(const Program& program, std::size_t move) {
  const Move& m = program.moves[move];
  MoveEdit edit{.move = move, .end_mm = m.end_mm};
  if (m.orientation) edit.orientation = m.orientation->end;
  if (m.arc) edit.centre_mm = m.arc->centre_mm;
  return edit;
}

/// Edits of all moves to their own ends.
inline std::vector<MoveEdit> robot_edits(const Program& program) {
  std::vector<MoveEdit> edits;
  for (std::size_t m = 0; m < program.moves.size(); ++m) edits.push_back(robot_edit(program, m));
  return edits;
}

/// The written text without edits of numbers.
inline std::string unchanged(const Program& program) {
  return rewrite(program, robot_edits(program), {}).text;
}

}  // namespace counterflex::test
