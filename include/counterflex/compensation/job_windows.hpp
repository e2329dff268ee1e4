#pragma once
/// A program on a machine, window by window: path and forces of each go on from the one before.
#include <memory>
#include <optional>

#include "counterflex/compensation/options.hpp"
#include "counterflex/program/program_reader.hpp"

namespace counterflex {

/// What all windows of a run have in common. Borrowed: everything outlives it.
struct RunInput {
  const Model& model;
  const std::vector<WorkFrame>& frames;  ///< by index into the program's work offsets, all of them
  const std::array<bool, 3>& ignored;    ///< program axes that no target needs (`ignore_axes`)
  const ForceSource& source;
  const CompensationOptions& options;
  const ReadOptions& read;
  const ToolModels* tools = nullptr;    ///< as for a job
  const StartTables* starts = nullptr;  ///< as for a job
};

/// A window with its path and forces; it stands on its own.
struct JobWindow {
  Program program;
  Toolpath path;
  std::optional<PathForces> forces;
};

class JobWindows {
 public:
  JobWindows(const RunInput& input, ProgramReader& reader);
  ~JobWindows();

  /// Goes to the next window, which is as long as its forces need; false at the program's end. Throws
  /// `InputError` as reader and forces do.
  bool next();

  /// The window, until the next one.
  Job job() const;

  /// The same, into `window`, which stays as it is while others are read; what it held is used again.
  bool next(JobWindow& window);
  Job job(const JobWindow& window) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterflex
