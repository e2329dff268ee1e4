#pragma once
/// The place of a failure, for the report.
#include <optional>

#include "run/run.hpp"

namespace counterflex::cli {

/// Solves the original program's moves of a line: where it is off most in this line, with the causes. None if
/// the line has no move, or if nothing of it can be solved. Reads the program again.
std::optional<SourcesAtWorst> solve_failed_line(Run& run, int line);

}  // namespace counterflex::cli
