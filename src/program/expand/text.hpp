#pragma once
/// The text with its calls replaced.
#include <string>
#include <string_view>

#include "program/expand/expand.hpp"

namespace counterflex {

struct ExpandedText {
  std::string text;
  Expansion expansion;
  bool seeks_numbers = false;  ///< a block is left that looks for a block by its number: M97, M99 P
};

/// As `expand_subprograms`. With a reason `why_none` nothing is replaced and nothing is executed.
ExpandedText expand_text(std::string_view text, const std::string& file, const Dialect& dialect,
                         std::string_view why_none);

}  // namespace counterflex
