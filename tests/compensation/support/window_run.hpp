#pragma once
/// Programs compensated in windows.
#include <vector>

#include "compensation/support/shop.hpp"
#include "counterflex/compensation/uncertainty.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex::test {

/// What comes of a run whose windows have at least as many moves.
struct WindowRun {
  std::string text;
  std::vector<Waypoint> waypoints;
  std::vector<LeftAlone> left_alone;
  std::optional<Failure> failure;
  std::size_t begun = 0, windows = 0, inserted = 0, corrected = 0;
};

inline void add(const Compensation& done, WindowRun& run) {
  run.text += done.text;
  run.left_alone.insert(run.left_alone.end(), done.left_alone.begin(), done.left_alone.end());
  run.inserted += done.counts.inserted_blocks;
  run.corrected += done.corrected_moves;
  ++run.windows;
}

/// What a run in windows borrows: windows that have at least as many moves.
struct WindowShop {
  WindowShop(const Order& of, std::size_t least_moves, const WriteOptions& write = {},
             const std::vector<double>* spins = nullptr, const std::vector<bool>* as_programmed = nullptr)
      : order(of),
        model(prepare(of.machine)),
        bytes(FileReader::of_bytes(of.text)),
        reader(bytes, "part.ngc", of.read, least_moves),
        frames(10, {{}, of.X_MW, of.datum_shift}) {
    options.tolerance = of.tolerance;
    options.max_correction = of.max_correction;
    options.blend = of.force.blend;
    options.threads = of.threads;
    options.write = write;
    if (!of.machine.tools.empty())
      tools = prepare_tools(of.machine, model, overview_of(read_program(of.text, "part.ngc", of.read)).tools);
    if (of.in_batches) starts.emplace();
    RunInput input{model,   frames,     order.ignored, order.force,
                   options, order.read, &tools,        starts ? &*starts : nullptr};
    input.spins = spins;
    input.as_programmed = as_programmed;
    uncertainties = tip_uncertainties(of.machine, model, tools, frames);
    if (!uncertainties.empty()) input.uncertainties = &uncertainties;
    if (has_reversals(model)) {
      FileReader again = FileReader::of_bytes(of.text);
      ProgramReader first(again, "part.ngc", of.read, least_moves);
      input.first_directions = first_directions(input, first);
    }
    windows.emplace(input, reader);
  }

  const Order& order;
  Model model;
  FileReader bytes;
  ProgramReader reader;
  std::vector<WorkFrame> frames;
  CompensationOptions options;
  ToolModels tools;
  std::optional<StartTables> starts;
  TipUncertainties uncertainties;
  std::optional<JobWindows> windows;
};

inline WindowEvents events_for(
    WindowRun& run, const std::function<void(const Job&)>& read = [](const Job&) {}) {
  return {read, [&run](const Job&) { ++run.begun; },
          [&run](const Job&, const std::vector<Waypoint>& some) {
            run.waypoints.insert(run.waypoints.end(), some.begin(), some.end());
          },
          [&run](const Job&, const Compensation& done) { add(done, run); }};
}

/// `run` gets all output received, even if an exception follows; `read` receives each window that was read.
inline void run_in_windows(
    const Order& order, std::size_t least_moves, const WriteOptions& write, WindowRun& run,
    const std::function<void(const Job&)>& read = [](const Job&) {}) {
  WindowShop shop(order, least_moves, write);
  run.failure =
      compensate_windows(*shop.windows, shop.options, TextReader(shop.reader), false, events_for(run, read));
}

inline WindowRun in_windows(const Order& order, std::size_t least_moves, const WriteOptions& write = {}) {
  WindowRun run;
  run_in_windows(order, least_moves, write, run);
  return run;
}

}  // namespace counterflex::test
