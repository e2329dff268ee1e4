#pragma once
/// Straight segments of the tool tip in the machine frame M: what a program asks for, without its text.
/// Lengths in m.
#include <array>
#include <string>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

/// One linear move. Rapid segments carry no cutting force and are corrected at their end only.
struct Segment {
  std::size_t move = 0;  ///< index into Program::moves
  int line = 0;
  bool cutting = false;  ///< a feed move (G1)
  Vector3 p_MT_start = Vector3::Zero();
  Vector3 p_MT_end = Vector3::Zero();
  Vector3 p_WT_start = Vector3::Zero();  ///< the same in program coordinates
  Vector3 p_WT_end = Vector3::Zero();
  double feed_m_s = 0;  ///< programmed feed; 0 where none is programmed
  double s_start = 0;   ///< cutting path length at the start, from the program's start: feed moves only (m)
  double s_end = 0;
  double t_start =
      0;  ///< time at the start at programmed feeds, feed moves only; stands still without a feed (s)
  double t_end = 0;
};

/// The path: all moves whose start and end are known in every axis. `X_MW` places program coordinates in M.
struct Toolpath {
  Pose X_MW;
  std::vector<Segment> segments;
};

/// Makes program axes count as known throughout that no target needs, those that the machine does not control: where
/// such a position is unknown it is taken to be the next one programmed. No word is inserted for them.
void ignore_axes(Program& program, const std::array<bool, 3>& ignored);

/// Builds the path of `program` in the machine frame. Moves with an axis that is not known at start and end
/// give no segment; a move of no length gives none either.
Toolpath build_toolpath(const Program& program, const Pose& X_MW);

}  // namespace counterflex
