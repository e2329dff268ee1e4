#include "run/windows.hpp"

#include <fmt/format.h>

#include <cmath>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex::cli {

Windows::Windows(Run& run, Console& console, std::size_t least_moves)
    : run_(run),
      console_(console),
      reader_(run.file.bytes, run.program.file, run.read, least_moves),
      jobs_(run.input(), reader_) {}

WindowEvents Windows::events(RunTally& tally, RunFiles& files) {
  const auto read = [this](const Job& window) {
    const std::lock_guard alone(speaking_);
    const auto& segments = window.path.segments;
    console_.solving(segments.empty() ? 0 : segments.front().line, run_.program.lines);
    refuse_uncontrolled_moves(window);
  };
  const auto begun = [this, &tally](const Job& window) {
    const std::lock_guard alone(speaking_);
    for (const ForceNote& note : window.forces.notes())
      console_.warning(run_.program.file, note.line, note.what);
    tally.add_window(window);
  };
  const auto solved = [this, &tally, &files](const Job& window, const std::vector<Waypoint>& waypoints) {
    run_.load_places.add(window, waypoints);
    tally.add_waypoints(waypoints, window);
    files.add_waypoints(waypoints);
    console_.solved(waypoints.size());
  };
  return {read, begun, solved, [](const Job&, const Compensation&) {}};
}

/// Throws if a component of the position that the machine does not control changes.
void Windows::refuse_uncontrolled_moves(const Job& job) {
  const Machine& machine = run_.machine.machine;
  if (machine.controlled.empty() || job.path.segments.empty()) return;
  if (!first_) first_ = job.path.segments.front().wanted.start;
  for (int c = 0; c < 3; ++c) {
    if (controls(machine, static_cast<Component>(c))) continue;
    for (const Segment& segment : job.path.segments)
      for (const Vector3& p : points_along(segment.wanted))
        if (std::abs(p[c] - (*first_)[c]) > 1e-9)
          throw InputError(
              ErrorKind::program_text, {run_.program.file, segment.line, 1},
              fmt::format("the move changes {} of the machine frame from {:.6g} to {:.6g} mm, which the "
                          "machine does not control",
                          "xyz"[c], (*first_)[c] / mm, p[c] / mm));
  }
}

}  // namespace counterflex::cli
