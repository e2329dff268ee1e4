#pragma once
#include <mutex>
#include <optional>

#include "counterflex/compensation/windows.hpp"
#include "counterflex/report/run_tally.hpp"
#include "process/console.hpp"
#include "run/run.hpp"
#include "run/run_files.hpp"

namespace counterflex::cli {

/// The windows of a run's program, read once from the beginning.
class Windows {
 public:
  Windows(Run& run, Console& console, std::size_t least_moves = window_moves);

  const ProgramReader& reader() const { return reader_; }
  JobWindows& jobs() { return jobs_; }

  /// What a run does with its windows: shows progress, prints notes on forces as warnings, and adds the
  /// windows and their waypoints to what it keeps. Reading throws `InputError` (ErrorKind::program_text) for
  /// a move along an axis that the machine does not control. `done` does nothing.
  WindowEvents events(RunTally& tally, RunFiles& files);

  /// Guards the console in events.
  std::mutex& speaking() { return speaking_; }

 private:
  void refuse_uncontrolled_moves(const Job& job);

  Run& run_;
  Console& console_;
  std::mutex speaking_;
  ProgramReader reader_;
  JobWindows jobs_;
  std::optional<Vector3> first_;  ///< where the path begins
};

}  // namespace counterflex::cli
