#pragma once
/// Compensates a program of any length on several threads, several windows at once.
#include <functional>

#include "counterflex/compensation/compensate.hpp"
#include "counterflex/compensation/job_windows.hpp"

namespace counterflex {

/// What a run hears of its windows. None is called by two threads at once.
struct WindowEvents {
  /// The window has been read, perhaps while others before it are still being solved; what this throws is
  /// thrown on when its turn comes.
  std::function<void(const Job&)> read;
  /// In the order of windows, as `done`, and before it: all before this window is compensated.
  std::function<void(const Job&)> begun;
  /// Waypoints of the window in order, in one portion or more.
  std::function<void(const Job&, const std::vector<Waypoint>&)> solved;
  /// The window is compensated, or has failed. Its waypoints have been given out.
  std::function<void(const Job&, Compensation&)> done;
};

/// Compensates all windows to the first that fails: its failure is returned, or thrown on where it is an
/// `InputError`. What is heard of windows, their bytes and numbers do not depend on `threads`; of windows
/// behind the failing one nothing is heard but that they were read. `corrected` and `attribution` as for a
/// `Compensator`.
std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution, const WindowEvents& events);

}  // namespace counterflex
