#include "run/program_places.hpp"

#include <numeric>
#include <utility>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/shown.hpp"
#include "counterflex/toolpath/reach.hpp"
#include "run/run_end.hpp"
#include "run/windows.hpp"

namespace counterflex::cli {
namespace {

/// The waypoints of a window, in which a hole weighs what the feed to its bottom does.
std::vector<Waypoint> with_weights_of_holes(const Job& window, const std::vector<Waypoint>& waypoints) {
  std::vector<Waypoint> weighed = waypoints;
  for (Waypoint& w : weighed) {
    if (!is_place_of_cycle(window.program, w)) continue;
    const std::vector<Curve> holes_mm = holes_of_cycle(window.program.moves[w.move]);
    if (!holes_mm.empty()) w.weight = length(holes_mm.front()) * mm;
  }
  return weighed;
}

}  // namespace

std::optional<Failure> find_program_places(const Options& options, MachineInput machine, Console& console,
                                           std::vector<ProgramPlace>& places) {
  constexpr std::size_t most = 256;
  const auto run = prepare_run(options, std::move(machine), console);
  RunFiles files(OutputPaths{}, {});
  RunTally tally = tally_for(options, *run);
  Windows windows(*run, console);
  WindowEvents events = windows.events(tally, files);
  events.solved = [&](const Job& window, const std::vector<Waypoint>& waypoints) {
    run->load_places.add(window, with_weights_of_holes(window, waypoints));
  };
  if (auto failure = predict_windows(windows.jobs(), run->options.threads, events)) {
    print_failure(*run, failure, console);
    return failure;
  }
  const ShownActuators& shown = run->machine.model.mechanism.shown;
  const std::vector<LoadPlace> all = run->load_places.places();
  const std::size_t each = (all.size() + most - 1) / most;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const LoadPlace& at = all[i];
    if (i % each != 0) {
      places.back().weight += at.at.weight;
      continue;
    }
    long tool = 0;
    for (const auto& [number, model] : run->tool_models)
      if (&model == at.model) tool = number;
    places.push_back({{shown_values(shown, at.at.rho), at.load.F, at.at.directions, {}, tool}, at.at.weight});
  }
  const auto weigh = [](double sum, const ProgramPlace& place) { return sum + place.weight; };
  if (!(std::accumulate(places.begin(), places.end(), 0.0, weigh) > 0))
    throw InputError(ErrorKind::program_text, {run->program.file},
                     "the program has no feed move with a known place, and no hole with a known place and "
                     "depth; give another program with --for");
  return std::nullopt;
}

}  // namespace counterflex::cli
