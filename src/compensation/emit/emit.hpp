#pragma once
/// From a plan to the edits of a program's text.
#include "compensation/plan/plan.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// The edits of a window, and how many of its moves are corrected in which way.
struct Emission {
  std::vector<MoveEdit> edits;
  std::size_t corrected_moves = 0;  ///< each on its own
  OtherMoves other_moves;
  std::vector<LeftAlone> left_alone;
  std::vector<NarrowedContour> narrowed;
  std::optional<Failure> failure;
};

/// What holds where the tool is, from move to move and from window to window.
struct EmitterState {
  Vector3 correction = Vector3::Zero();  ///< target minus wanted position, M (m)
  Vector3 turn = Vector3::Zero();        ///< commanded against wanted orientation: rotation vector (rad, M)
  bool correction_known = false;
  std::array<bool, 3> holds{};  ///< program axes that carry it
  bool doubtful = false;  ///< a block made a position unknown that carries the correction, and it still is
  int group = 0;          ///< contour group that is being emitted
  TextPosition held{};    ///< of the emitted text
};

/// Edits for all moves: segments as planned; moves that go nowhere keep the correction that holds there;
/// moves made before all axes are known take that of the first position that is (look-ahead of 64 blocks).
/// Arcs are fitted to what the text holds before them; holes get the correction at their bottom, contour
/// groups one rigid motion; a held move keeps the correction at its start. Where one cannot be
/// held the emission fails (ErrorKind::program_text).
Emission emit(const Job& job, const Plan& plan, EmitterState& state);

}  // namespace counterflex
