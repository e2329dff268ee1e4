#pragma once
/// Judges a corrected program by its text alone: matches it with the original and solves it forward.
#include "counterflex/compensation/compensate_windows.hpp"

namespace counterflex {

/// Verifies all windows, however many miss the tolerance, to the first that cannot be matched or solved: its
/// failure is returned, else the first miss of the tolerance. `corrected` is read to its end in the same
/// time. `done` gets waypoints; of the other members of a `Compensation` only the failure means something.
std::optional<Failure> verify_windows(JobWindows& windows, const CompensationOptions& options,
                                      ProgramReader& corrected, bool attribution, const WindowEvents& events);

/// Verifies a program that is one window.
Compensation verify(const Job& job, const Program& corrected, bool attribution);

}  // namespace counterflex
