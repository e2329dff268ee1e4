#include "run/significance.hpp"

#include "counterflex/compensation/significance.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex::cli {

void refuse_without_uncertainty(const Run& run, const std::string& option) {
  if (!run.uncertainties.empty()) return;
  throw InputError(ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
                   option +
                       " needs the uncertainty of this machine: add [uncertainty] here, and a sigma to each "
                       "known number of [parameters], or give --uncertainty FILE; else leave the option out");
}

void find_insignificant(Run& run, Console& console) {
  refuse_without_uncertainty(run, "--only-significant");
  console.progress("comparing deviations with their bands");
  ProgramReader reader(run.file.bytes, run.program.file, run.read);
  JobWindows windows(run.input(), reader);
  const auto read = [&](const Job& window) {
    const auto& segments = window.path.segments;
    console.solving(segments.empty() ? 0 : segments.front().line, run.program.lines);
  };
  const auto solved = [&](const Job&, const std::vector<Waypoint>& waypoints) {
    console.solved(waypoints.size());
  };
  run.as_programmed =
      targets_as_programmed(windows, run.options.threads,
                            {read, [](const Job&) {}, solved, [](const Job&, const Compensation&) {}});
}

}  // namespace counterflex::cli
