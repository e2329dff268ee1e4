#pragma once
/// Compensates a program, whoever asks for it.
#include <functional>

#include "run/run.hpp"

namespace counterflex::cli {

/// Says what a run has come to whose files have their names; gives its exit status.
using TellEnd = std::function<Exit(const Run&, const RunEnd&, const RunFiles&)>;

/// Everything that `compensate` does but saying the result, which is left to `tell`. A run that fails before
/// there is anything to report says so through `console` and does not come to `tell`. Throws `InputError`.
Exit compensate_program(const Options& options, Console& console, const TellEnd& tell);

}  // namespace counterflex::cli
