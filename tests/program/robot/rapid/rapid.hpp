#pragma once
/// Helpers of the tests of ABB RAPID.
#include "counterflex/program/program_reader.hpp"
#include "program/reading.hpp"

namespace counterflex::test {

inline Program read_rapid(const std::string& text) {
  return read_program(text, "job.mod", {});
}

/// A module with declarations, which begin in line 2, and a routine.
inline std::string module_of(const std::string& declarations, const std::string& statements) {
  return "MODULE Job\n" + declarations + "PROC main()\n" + statements + "ENDPROC\nENDMODULE\n";
}

/// The refusal of a module; "none" if it is read.
inline std::string refusal_of_module(const std::string& declarations, const std::string& statements) {
  return diagnostic_of([&] { read_rapid(module_of(declarations, statements)); });
}

/// A robtarget with that position and quaternion.
inline std::string target_at(const std::string& position, const std::string& quaternion = "1,0,0,0") {
  return "[[" + position + "],[" + quaternion + "],[0,-1,0,1],[0,9E9,9E+09,9E9,9E9,9E9]]";
}

inline MoveEdit unchanged_edit(const Program& program, std::size_t move) {
  const Move& m = program.moves[move];
  MoveEdit edit{.move = move, .end_mm = m.end_mm};
  if (m.orientation) edit.orientation = m.orientation->end;
  if (m.arc) edit.centre_mm = m.arc->centre_mm;
  return edit;
}

inline std::vector<MoveEdit> unchanged_edits(const Program& program) {
  std::vector<MoveEdit> edits;
  for (std::size_t m = 0; m < program.moves.size(); ++m) edits.push_back(unchanged_edit(program, m));
  return edits;
}

/// Replaces each "<1,2,3>" by the target at that position.
inline std::string with_targets(std::string text) {
  for (std::size_t open; (open = text.find('<')) != std::string::npos;) {
    const std::size_t close = text.find('>', open);
    text.replace(open, close - open + 1, target_at(text.substr(open + 1, close - open - 1)));
  }
  return text;
}

/// The program of statements, with the targets of `with_targets`.
inline Program read_routine(const std::string& statements, const std::string& declarations = "") {
  return read_rapid(with_targets(module_of(declarations, statements)));
}

}  // namespace counterflex::test
