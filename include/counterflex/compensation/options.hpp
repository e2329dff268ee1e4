#pragma once
/// What a run is asked to do, and the data that all stages of compensation read.
#include <string>
#include <string_view>

#include "counterflex/files/input_error.hpp"
#include "counterflex/forces/forces.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/program/rewrite.hpp"
#include "counterflex/statics/batch_solver.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

enum class Method { direct, nested, linear };
std::string_view to_string(Method method);

struct CompensationOptions {
  Method method = Method::direct;
  double tolerance = 5e-6;  ///< m: norm of the tip's controlled position error at equal fraction of a segment
  double max_correction = 1e-3;  ///< m
  double blend = 2e-3;           ///< m: 0 makes steps of the force jumps of the correction, at rapids too
  int threads = 1;
  WriteOptions write;
};

/// A position of the nominal tip (M, m) on a machine.
struct TipPosition {
  const Model* model = nullptr;
  Vector3 p_MT = Vector3::Zero();
};

/// One program on one machine. Borrowed: everything outlives the job.
struct Job {
  const Model& model;
  const Program& program;
  const Toolpath& path;  ///< wanted tip path in M, and the frames of the program's work offsets
  const PathForces& forces;
  CompensationOptions options;
  ReadOptions read;  ///< with which the program was read: its corrected text is read in the same way
  const ToolModels* tools = nullptr;    ///< of tools that make the machine another one; none: `model` is all
  const StartTables* starts = nullptr;  ///< of the kernel; none: waypoints are solved one by one
  std::optional<TipPosition> from{};    ///< of a window: where the path before it ended
};

/// The machine with tool number `tool` in its spindle.
const Model& model_with(const Model& model, const ToolModels* tools, long tool);

/// The machine that makes a move of the path. Nearly always there is only one: no move is looked at then.
inline const Model& model_of(const Job& job, const Segment& segment) {
  if (job.tools == nullptr || job.tools->empty()) return job.model;
  return model_with(job.model, job.tools, job.program.moves[segment.move].tool);
}

/// Why a run was refused: exit status, line of the original program, what happened, and the line of the
/// corrected program, if there is one (0: none).
struct Failure {
  Exit exit = Exit::not_compensated;
  int line = 0;
  std::string what;
  int corrected_line = 0;
  Status status = Status::converged;  ///< of the machine, where that is the reason
};

}  // namespace counterflex
