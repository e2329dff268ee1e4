#pragma once
/// A program on a machine, window by window: path and forces of each go on from the one before.
#include <memory>

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
  const ToolModels* tools = nullptr;  ///< as for a job
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

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterflex
