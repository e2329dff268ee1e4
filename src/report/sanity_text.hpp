#pragma once
/// The sanity block on a terminal.
#include "counterflex/sanity/check.hpp"
#include "text_layout.hpp"

namespace counterflex {

std::string sanity_text(const SanityChecks& checks, const Ink& ink);

}  // namespace counterflex
