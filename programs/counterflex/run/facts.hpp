#pragma once
/// Inputs and options of a run in its report.
#include "run/run.hpp"

namespace counterflex::cli {

/// Version, inputs with their hashes, and every option that can change the result. The number of threads does
/// not change it.
RunFacts facts_of(const Options& options, const Run& run);

}  // namespace counterflex::cli
