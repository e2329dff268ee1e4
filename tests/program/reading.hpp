#pragma once
/// Helpers of tests to read a program and to edit it.
#include <string>

#include "counterflex/files/input_error.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/program/rewrite.hpp"

namespace counterflex::test {

inline Program read(const std::string& text, const std::string& dialect = "auto") {
  ReadOptions options;
  options.dialect = dialect;
  return read_program(text, "p.ngc", options);
}

/// The diagnostic of `action`, or "none".
template <typename Action>
std::string diagnostic_of(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

/// Edits of all moves to their original ends.
inline std::vector<MoveEdit> edits_to_original(const Program& program) {
  std::vector<MoveEdit> edits;
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const Move& move = program.moves[i];
    MoveEdit& edit = edits.emplace_back(MoveEdit{.move = i, .end_mm = move.end_mm});
    if (move.arc) edit.centre_mm = move.arc->centre_mm;
    if (move.cycle) edit.bottom_mm = move.cycle->bottom_mm, edit.retract_mm = move.cycle->retract_mm;
  }
  return edits;
}

/// Edits that shift all moves by `d_mm`.
inline std::vector<MoveEdit> shifted(const Program& program, const Vector3& d_mm) {
  std::vector<MoveEdit> edits = edits_to_original(program);
  for (MoveEdit& edit : edits) edit.end_mm += d_mm;
  return edits;
}

/// The text of `program` with all moves that have coordinates shifted by `d_mm`, arcs with their centres.
inline std::string shifted_text(const Program& program, const Vector3& d_mm,
                                const WriteOptions& options = {}) {
  std::vector<MoveEdit> edits = shifted(program, d_mm);
  std::erase_if(edits, [&](const MoveEdit& edit) {
    const auto& words = program.moves[edit.move].words;
    return !words[0] && !words[1] && !words[2];
  });
  for (MoveEdit& edit : edits)
    if (edit.centre_mm) *edit.centre_mm += d_mm;
  return rewrite(program, edits, options).text;
}

/// `text` rewritten with one edit of its last move.
inline std::string with_last_move(const std::string& text, MoveEdit edit,
                                  const std::string& dialect = "auto") {
  const Program program = read(text, dialect);
  edit.move = program.moves.size() - 1;
  return rewrite(program, {edit}, {}).text;
}

}  // namespace counterflex::test
