#pragma once
/// Which forces act where: rules, of which the most specific one that covers a move acts.
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

enum class ForceFrame { machine, work, tool, feed };

/// How specific a rule is; the first is the most specific. A place is a line, a block number, a length, a
/// time, a point, or a FORCE comment.
enum class ForceRank { place, operation, tool, program };

/// Which moves a rule covers: those that meet all conditions that are given.
struct ForceSelector {
  std::optional<long> tool;              ///< T in the spindle
  std::optional<std::string> operation;  ///< the operation's comment, case aside; `*` at its end: begins so
  std::optional<std::array<long, 2>> lines;   ///< first and last
  std::optional<std::array<long, 2>> blocks;  ///< first and last N
};

/// By the most specific of the conditions that are given.
ForceRank rank(const ForceSelector& selector);

/// The same wrench for all moves of a rule.
struct ConstantForce {
  Vector6 F = Vector6::Zero();  ///< on the tool (N, N m)
  ForceFrame frame = ForceFrame::machine;
  bool at_platform = false;  ///< acts at the reference point instead of the tip
};

}  // namespace counterflex
