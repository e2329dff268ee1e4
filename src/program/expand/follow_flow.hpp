#pragma once
/// Executes lines of flow, as far as the text shows their conditions.
#include <map>

#include "program/expand/control_flow.hpp"
#include "program/evaluate/variables.hpp"

namespace counterflex {

/// Passes that loops with a count have still to run, by their lines.
using PassesLeft = std::map<std::size_t, long>;

struct FlowStep {
  LinePlace next{};       ///< the line that follows
  std::string written{};  ///< the assignment that is written in the place of the line: FOR sets its counter
  Span rest{};            ///< the part of the line that is executed as a block: IF [...] THEN #1=5
  bool leaves = false;    ///< the body
};

/// Executes `line` of `flow`. Throws `UnknownFlow` where the text does not show which line follows.
FlowStep follow(const ControlFlow& flow, const ControlLine& line, const Dialect& dialect, PassesLeft& passes,
                Variables& variables);

}  // namespace counterflex
