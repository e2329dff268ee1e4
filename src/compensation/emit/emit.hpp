#pragma once
/// From a plan to the edits of a program's text.
#include "compensation/plan/plan.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// One move of the original with its edit.
struct EmittedMove {
  enum class Kind {
    segment,  ///< judged along its segment
    shifted,  ///< goes nowhere, or from an unknown position: it keeps a correction
    alone,    ///< the first position that is known in all axes, or the bottom of a hole
  };
  MoveEdit edit;
  Kind kind = Kind::shifted;
  bool in_part = false;  ///< listed: held, or corrected without its force
};

struct Emission {
  std::vector<EmittedMove> moves;
  std::vector<LeftAlone> left_alone;
  std::optional<Failure> failure;
};

/// The edits of an emission, out of which their inserted points are moved.
std::vector<MoveEdit> take_edits(Emission& emission);

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
