#pragma once
/// The steps of a window between its job and its verdict.
#include "compensation/emit/emitter.hpp"
#include "compensation/match/match.hpp"
#include "compensation/plan/plan.hpp"
#include "compensation/solve/branch.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// A window in progress.
struct WindowWork {
  Plan plan{};
  ActuatorWay actuators{};
  std::vector<Piece> pieces{};       ///< that are solved
  std::optional<Vector3> command{};  ///< where the window before ended, if that is known
  Compensation result{};

  bool failed() const { return result.failure.has_value(); }
};

/// Steps of a run, in their order. `prepare` and `match` take any number of windows at once, `write` takes
/// them in their order. A step is left out where it is empty, or one before it has failed.
struct WindowSteps {
  using Step = std::function<void(const Job&, WindowWork&)>;
  Questions questions{};
  Step prepare{}, write{}, match{};
  /// The first miss of the tolerance among the waypoints, if there is one.
  std::function<void(WindowWork&, const std::optional<Failure>& missed)> judge{};
};

/// What every run carries from window to window.
struct PathCarry {
  std::optional<Vector3> command{};  ///< where the text ends, if that is known
  Eigen::VectorXd actuators{};       ///< where the path ends, rotary ones counted on over full turns
};

/// What compensating carries from window to window.
struct WritingCarry {
  Rewriter rewriter;
  TextReader corrected;
  EmitterState emitter{};
  PathCarry path{};
};

/// What verifying carries from window to window.
struct VerifyingCarry {
  CorrectedMoves found;
  OtherLines lines{};
  PathCarry path{};
  std::optional<Failure> missed{};  ///< the first miss of the tolerance
};

/// The steps of a compensation, and of a verification. `carry` outlives them.
WindowSteps steps_of_compensation(WritingCarry& carry, bool attribution);
WindowSteps steps_of_verification(VerifyingCarry& carry, bool attribution);

/// Takes the windows of a run through its steps, several at once. The failure of the first that fails.
std::optional<Failure> run_windows(JobWindows& windows, int threads, const WindowSteps& steps,
                                   const WindowEvents& events);

}  // namespace counterflex
