#pragma once
/// The part of the summary that is about cutting forces.
#include <string>

#include "counterflex/report/report.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

/// "372.0 N and 5.00 N m": the largest force and moment on the path. One that does not act is left out.
std::string largest_wrench(const ForceSummary& forces);

/// The largest force, the moves without a force, and the deviation under other forces; empty if no waypoint
/// was solved.
std::string force_text(const RunReport& report, const Ink& ink);

}  // namespace counterflex
