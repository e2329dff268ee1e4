#pragma once
/// The part of the summary that is about loads and their limits.
#include <string>

#include "counterflex/report/report.hpp"
#include "text_layout.hpp"

namespace counterflex {

/// How near each chain comes to a limit of its; empty where no limit is given, or no loads were solved.
std::string loads_text(const RunReport& report, const Ink& ink);

}  // namespace counterflex
