#pragma once
/// The turn of the tool about the spindle axis. A cutter does not see it, but the posture of the machine
/// depends on it: chosen along a program, it lowers the deviation.
#include <cstddef>
#include <functional>
#include <vector>

#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// Share of the tolerance of tilt by which a changing turn may tilt the axis between two targets: the control
/// turns the tool about one axis, which is not exactly the way of the programmed axis and the turn together.
inline constexpr double spin_tilt_share = 0.01;

/// The turns that were found.
struct SpinChoice {
  /// At the end of each move of the program, by its number: counter-clockwise about the spindle axis against
  /// the programmed orientation (rad).
  std::vector<double> at_end{};
  std::size_t targets = 0;     ///< that have an orientation
  std::size_t turned = 0;      ///< of them
  double least = 0, most = 0;  ///< turn of the targets (rad)
};

/// Searches the turns of a program, on a grid from -90 to 90 degrees, that minimise the largest deviation of
/// the uncorrected program, then its mean along the feed moves. Of nearly equal ones it takes the smaller
/// turns.
///
/// - The turn changes by at most 0.5 degrees per mm of feed path, evenly between places that are 10 mm apart
///   or more, and not along arcs. At a joint move it may change by any angle.
/// - It is 0 where the orientation of a move cannot be written, and where a path begins at a target in joint
///   values.
/// - No actuator comes closer than 5 degrees to the end of its travel, counted over full turns; it stays in
///   the turn that a target states. No place is closer to another configuration (`arm_margin`, for other
///   machines the condition of the actuators) than the closest place of the program as it is.
/// - The force is that of the program as it is: it does not turn with the flange.
///
/// `windows`: of the program without turns (`RunInput::spins`). Reads them to their end. `read` gets each
/// window before it is solved. Throws `InputError` (ErrorKind::program_text) for a program whose tool cannot
/// be turned, and what the reader throws.
SpinChoice best_spins(JobWindows& windows, int threads, const std::function<void(const Job&)>& read);

}  // namespace counterflex
