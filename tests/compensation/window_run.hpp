#pragma once
/// Programs compensated in windows.
#include <vector>

#include "compensation/shop.hpp"
#include "counterflex/compensation/compensate_windows.hpp"

namespace counterflex::test {

/// What comes of a run whose windows have at least as many moves.
struct WindowRun {
  std::string text;
  std::vector<Waypoint> waypoints;
  std::vector<LeftAlone> left_alone;
  std::optional<Failure> failure;
  std::size_t begun = 0, windows = 0, inserted = 0, corrected = 0;
  double largest = 0;
};

inline void add(const Compensation& done, WindowRun& run) {
  run.text += done.text;
  run.waypoints.insert(run.waypoints.end(), done.waypoints.begin(), done.waypoints.end());
  run.left_alone.insert(run.left_alone.end(), done.left_alone.begin(), done.left_alone.end());
  run.inserted += done.counts.inserted_blocks;
  run.corrected += done.corrected_moves;
  run.largest = std::max(run.largest, done.largest_correction);
  ++run.windows;
}

/// `run` has what was heard even where something is thrown; `read` hears of windows that were read.
inline void run_in_windows(
    const Order& order, std::size_t least_moves, const WriteOptions& write, WindowRun& run,
    const std::function<void(const Job&)>& read = [](const Job&) {}) {
  const Model model = prepare(order.machine);
  FileReader bytes = FileReader::of_bytes(order.text);
  ProgramReader reader(bytes, "part.ngc", order.read, least_moves);
  const std::vector<WorkFrame> frames(10, {{}, order.X_MW, order.datum_shift});
  CompensationOptions options;
  options.tolerance = order.tolerance;
  options.max_correction = order.max_correction;
  options.blend = order.force.blend;
  options.threads = order.threads;
  options.write = write;
  ToolModels tools;
  if (!order.machine.tools.empty())
    tools = prepare_tools(order.machine, model,
                          overview_of(read_program(order.text, "part.ngc", order.read)).tools);
  std::optional<LaneMachines> lanes;
  if (order.in_lanes) lanes.emplace(order.max_correction);
  JobWindows windows(
      {model, frames, order.ignored, order.force, options, order.read, &tools, lanes ? &*lanes : nullptr},
      reader);
  const WindowEvents events{read, [&](const Job&) { ++run.begun; },
                            [&](const Job&, Compensation& done) { add(done, run); }};
  run.failure = compensate_windows(windows, options, TextReader(reader), false, events);
}

inline WindowRun in_windows(const Order& order, std::size_t least_moves, const WriteOptions& write = {}) {
  WindowRun run;
  run_in_windows(order, least_moves, write, run);
  return run;
}

}  // namespace counterflex::test
