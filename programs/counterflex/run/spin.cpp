#include "run/spin.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "counterflex/compensation/spin_search.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::cli {
namespace {

void refuse_without_freedom(const Run& run) {
  const Machine& machine = run.machine.machine;
  if (!controls_pose(machine))
    throw InputError(ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
                     "--free spin needs a machine that turns its tool freely about the spindle axis; "
                     "`controlled` does not list all of x, y, z, rx, ry, rz: leave the option out");
  if (!run.program.turns_tool)
    throw InputError(ErrorKind::program_text, {run.program.file},
                     "--free spin changes the orientation of targets, but the program gives positions alone; "
                     "leave the option out, or take the program in the language of the robot");
}

/// The largest deviation of feed moves, and where it is.
struct LargestDeviation {
  Largest at{};
  std::optional<Failure> failure{};

  void add(const std::vector<Waypoint>& waypoints) {
    for (const Waypoint& w : waypoints) {
      const double mm_off = w.after.head<3>().norm() / mm;
      if (w.cutting && w.status == Status::converged && mm_off > at.mm) at = {mm_off, w.line};
    }
  }
};

/// Solves the program without a correction, on its branch and within its travel.
LargestDeviation solve_program(Run& run, Console& console) {
  ProgramReader reader(run.file.bytes, run.program.file, run.read);
  RunInput input = run.input();
  input.uncertainties = nullptr;  // bands are of the run
  JobWindows windows(input, reader);
  LargestDeviation largest;
  const auto read = [&](const Job& window) {
    const auto& segments = window.path.segments;
    console.solving(segments.empty() ? 0 : segments.front().line, run.program.lines);
  };
  const auto solved = [&](const Job&, const std::vector<Waypoint>& waypoints) {
    largest.add(waypoints);
    console.solved(waypoints.size());
  };
  largest.failure =
      predict_windows(windows, run.options.threads,
                      {read, [](const Job&) {}, solved, [](const Job&, const Compensation&) {}});
  return largest;
}

SpinChoice search_spins(Run& run, Console& console) {
  ProgramReader reader(run.file.bytes, run.program.file, run.read);
  JobWindows windows(run.input(), reader);
  return best_spins(windows, run.options.threads, [&](const Job& window) {
    const auto& segments = window.path.segments;
    console.solving(segments.empty() ? 0 : segments.front().line, run.program.lines);
  });
}

/// In which direction actuators with lost motion move first depends on the turns.
void find_first_directions(Run& run) {
  if (!has_reversals(run.machine.model)) return;
  run.first_directions = {};
  ProgramReader reader(run.file.bytes, run.program.file, run.read);
  run.first_directions = first_directions(run.input(), reader);
}

}  // namespace

void choose_spin(Run& run, Console& console) {
  if (run.options.spin_tolerance)
    throw InputError(
        ErrorKind::usage, {},
        "--free spin chooses the turn about the tool's axis, and --tolerance-spin-deg limits it; "
        "leave one of them out");
  refuse_without_freedom(run);
  console.progress("turning the tool about its axis");
  const LargestDeviation programmed = solve_program(run, console);
  if (programmed.failure) return;  // the run finds it again
  SpinChoice choice = search_spins(run, console);
  FreeSpin found{.programmed_mm = programmed.at.mm,
                 .programmed_line = programmed.at.line,
                 .turned_mm = programmed.at.mm,
                 .turned_line = programmed.at.line,
                 .targets = choice.targets};
  if (choice.turned > 0) {
    run.spins = std::move(choice.at_end);
    find_first_directions(run);
    const LargestDeviation turned = solve_program(run, console);
    if (turned.failure || turned.at.mm >= programmed.at.mm) {
      run.spins.clear();
      find_first_directions(run);
    } else {
      found.turned_mm = turned.at.mm;
      found.turned_line = turned.at.line;
      found.turned = choice.turned;
      found.least_deg = choice.least / deg;
      found.most_deg = choice.most / deg;
      run.options.tilt_tolerance *= 1 - spin_tilt_share;  // the rest is for the way between targets
    }
  }
  run.facts.free_spin = found;
}

}  // namespace counterflex::cli
