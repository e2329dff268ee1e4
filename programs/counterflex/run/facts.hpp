#pragma once
/// What a report says about a run's inputs and options.
#include "run/run.hpp"

namespace counterflex::cli {

/// Version, inputs with their hashes, and every option that can change the result. The number of threads
/// cannot.
RunFacts facts_of(const Options& options, const Run& run);

}  // namespace counterflex::cli
