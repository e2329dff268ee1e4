#pragma once
/// The part of the summary with loads and their limits.
#include <string>

#include "counterflex/report/report.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

/// How near each chain is to its limits; empty without limits or loads.
std::string loads_text(const RunReport& report, const Ink& ink);

}  // namespace counterflex
