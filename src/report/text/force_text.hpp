#pragma once
/// The part of the summary that is about cutting forces.
#include <string>

#include "counterflex/report/report.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

/// The largest force, the moves without a force, and the deviation under other forces; empty if no waypoint
/// was solved.
std::string force_text(const RunReport& report, const Ink& ink);

}  // namespace counterflex
