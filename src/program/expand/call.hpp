#pragma once
/// Blocks that call subprograms.
#include <optional>
#include <string>
#include <vector>

#include "program/expand/definitions.hpp"

namespace counterflex {

struct SubprogramCall {
  SubprogramName name;
  SubprogramName other_reading{};  ///< of P31001: O1001, 3 times; used if there is no O31001
  long repeats = 1, other_repeats = 1;
  Span span{};                ///< position of the call, for diagnostics
  std::vector<Span> dropped;  ///< bytes of the block that make up the call; the rest of the block stays
  std::vector<std::string> arguments;  ///< of an O-word, without their outer brackets
  std::string why_not;  ///< it is not all plain numbers, or may be skipped; empty: it can be expanded
};

/// The call in `block`; empty for other blocks, and for calls of macros (G65).
std::optional<SubprogramCall> call_in(std::string_view text, const Dialect& dialect, const Block& block);

/// Whether the block may run a subprogram in another way: macros, other files, codes that are expressions.
bool may_call(const Block& block, const Dialect& dialect);

/// Why a call of another kind is never replaced: macros with arguments, programs of other memories. Empty for
/// other blocks.
std::string why_never_replaced(const Block& block, const Dialect& dialect);

}  // namespace counterflex
