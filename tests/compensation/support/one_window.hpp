#pragma once
/// Programs that are one window, taken through the steps of a run.
#include "compensation/windows/window_steps.hpp"

namespace counterflex {

inline Compensation run_steps(const Job& job, const WindowSteps& steps) {
  WindowWork work;
  for (const WindowSteps::Step* step : {&steps.prepare, &steps.write, &steps.match})
    if (*step && !work.failed()) (*step)(job, work);
  if (work.failed()) return std::move(work.result);
  ForwardRun run = solve_pieces(job, work.pieces, steps.questions, work.command);
  work.result.waypoints = std::move(run.waypoints);
  work.result.failure = run.failure;
  steps.judge(work, tolerance_failure(job, work.result.waypoints));
  return std::move(work.result);
}

/// With `attribution` each waypoint's deviation is split into its causes.
inline Compensation compensate(const Job& job, bool attribution) {
  WritingCarry carry{Rewriter(job.options.write), TextReader(job.program, job.read)};
  return run_steps(job, steps_of_compensation(carry, attribution));
}

/// Judges `corrected` by its text alone: matches it with the original and solves it forward.
inline Compensation verify(const Job& job, const Program& corrected, bool attribution) {
  VerifyingCarry carry{CorrectedMoves(corrected)};
  WindowSteps steps = steps_of_verification(carry, attribution);
  steps.match = [&carry](const Job&, WindowWork& work) {
    work.result.failure = match_end(carry.lines, carry.found);
  };
  Compensation result = run_steps(job, steps);
  if (!result.failure) result.failure = carry.missed;
  return result;
}

}  // namespace counterflex
