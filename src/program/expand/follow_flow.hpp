#pragma once
/// Executes lines of flow whose conditions are known from the text.
#include <map>

#include "program/evaluate/variables.hpp"
#include "program/expand/control_flow.hpp"

namespace counterflex {

/// What loops keep from one of their lines to another.
///
/// LinuxCNC has one state for the loops of all calls. It forgets a `break` only at the end of a do loop: the
/// `break` of a while loop ends the next do loop after its first pass. It has read each `break` that it
/// passes on its way to the end of a while loop.
struct LoopState {
  std::map<const ControlLine*, long> passes_left{};  ///< of loops with a count that run, by their first line
  bool keeps_break = false;
  bool is_unknown = false;  ///< a call or a loop of LinuxCNC stays, which may have changed its state
};

struct FlowStep {
  LinePlace next{};       ///< the next line
  std::string written{};  ///< the assignment that replaces the line: FOR sets its counter
  Span rest{};            ///< the part of the line that is executed as a block: IF [...] THEN #1=5
  bool leaves = false;    ///< execution leaves the body
};

/// Executes `line` of `flow`. Throws `UnknownFlow` if the text does not determine the next line.
FlowStep follow(const ControlFlow& flow, const ControlLine& line, const Dialect& dialect, LoopState& loops,
                Variables& variables);

}  // namespace counterflex
