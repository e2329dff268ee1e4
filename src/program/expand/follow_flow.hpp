#pragma once
/// Executes lines of flow whose conditions are known from the text.
#include <map>

#include "program/evaluate/variables.hpp"
#include "program/expand/control_flow.hpp"

namespace counterflex {

/// Remaining passes of loops with a count, by their lines.
using PassesLeft = std::map<std::size_t, long>;

struct FlowStep {
  LinePlace next{};       ///< the next line
  std::string written{};  ///< the assignment that replaces the line: FOR sets its counter
  Span rest{};            ///< the part of the line that is executed as a block: IF [...] THEN #1=5
  bool leaves = false;    ///< execution leaves the body
};

/// Executes `line` of `flow`. Throws `UnknownFlow` if the text does not determine the next line.
FlowStep follow(const ControlFlow& flow, const ControlLine& line, const Dialect& dialect, PassesLeft& passes,
                Variables& variables);

}  // namespace counterflex
