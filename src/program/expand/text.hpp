#pragma once
/// Composes the text with its calls replaced.
#include <string>
#include <string_view>

#include "program/expand/expand.hpp"

namespace counterflex {

struct ExpandedText {
  std::string text;
  Expansion expansion;
  bool seeks_numbers = false;  ///< a block remains that searches a block number: M97, M99 P
};

/// As `expand_subprograms`. If `why_none` is a reason, no call is replaced and no line is executed.
ExpandedText expand_text(std::string_view text, const std::string& file, const Dialect& dialect,
                         std::string_view why_none);

}  // namespace counterflex
