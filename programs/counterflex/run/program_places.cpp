#include "run/program_places.hpp"

#include "counterflex/machine/shown.hpp"
#include "run/windows.hpp"

namespace counterflex::cli {

std::optional<Failure> find_program_places(const Options& options, Console& console,
                                           std::vector<ProgramPlace>& places) {
  constexpr std::size_t most = 256;
  const auto run = prepare_run(options, console);
  RunFiles files(OutputPaths{}, {});
  RunTally tally = tally_for(options, *run);
  Windows windows(*run, console);
  if (auto failure = predict_windows(windows.jobs(), run->options.threads, windows.events(tally, files))) {
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
  if (places.empty())
    throw InputError(ErrorKind::program_text, {run->program.file},
                     "the program has no feed move with a known place; give another program with --for");
  return std::nullopt;
}

}  // namespace counterflex::cli
