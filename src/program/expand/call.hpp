#pragma once
/// Blocks that call subprograms.
#include <optional>
#include <string>
#include <vector>

#include "program/expand/definitions.hpp"

namespace counterflex {

struct SubprogramCall {
  SubprogramName name;
  SubprogramName other_reading{};  ///< of P31001: O1001, 3 times; tried where there is no O31001
  long repeats = 1, other_repeats = 1;
  Span said{};                         ///< where the call stands, for diagnostics
  std::vector<Span> dropped;           ///< bytes of the block that call: the rest of it stays
  std::vector<std::string> arguments;  ///< of an O-word, without their outer brackets
  std::string why_not;                 ///< it does not say all in plain numbers, or may be skipped
};

/// The call that `block` is; nothing for other blocks, and for calls of macros (G65).
std::optional<SubprogramCall> call_in(std::string_view text, const Dialect& dialect, const Block& block);

/// Whether the block may run a subprogram in some other way: macros, other files, codes that are expressions.
bool may_call(const Block& block, const Dialect& dialect);

}  // namespace counterflex
