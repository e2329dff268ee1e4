#pragma once
/// The sanity block on a terminal.
#include "counterflex/sanity/checks.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

std::string sanity_text(const SanityChecks& checks, const Ink& ink);

}  // namespace counterflex
