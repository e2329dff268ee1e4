#pragma once
/// From a plan to the edits of a program's text, and from text that was read back to the pieces that it
/// commands.
#include "counterflex/compensation/compensate.hpp"
#include "plan.hpp"

namespace counterflex {

struct Emission {
  std::vector<MoveEdit> edits;
  /// By edit: fractions of its inserted points and its end on its segment; empty where it has none.
  std::vector<std::vector<double>> fractions;
  std::vector<std::size_t> segment;  ///< by edit; no_segment where it has none
  std::vector<bool> first_known;     ///< by edit: its end is the first position that is known in all axes
  std::vector<bool> exempt;          ///< by edit: listed as not split, its inside may miss the tolerance
  std::vector<LeftAlone> left_alone;
  std::optional<Failure> failure;
};

/// Edits for all moves: segments as planned; moves that go nowhere keep the correction that holds there;
/// moves made before all axes are known take that of the first position that is (look-ahead of 64 blocks).
Emission emit(const Job& job, const Plan& plan);

/// The pieces that the emitted text commands. `corrected` is that text, read anew.
std::vector<Piece> emitted_pieces(const Job& job, const Emission& emission, const Rewritten& rewritten,
                                  const Program& corrected);

/// A position in program coordinates (mm) as a target in M (m).
Vector3 target_of(const Job& job, const Vector3& p_mm);

}  // namespace counterflex
