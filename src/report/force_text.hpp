#pragma once
/// The part of the summary that is about cutting forces.
#include <string>

#include "counterflex/report/report.hpp"
#include "text_layout.hpp"

namespace counterflex {

/// How large the force is, which moves have none, and what becomes of the deviation under another one; empty
/// where nothing was solved.
std::string force_text(const RunReport& report, const Ink& ink);

}  // namespace counterflex
