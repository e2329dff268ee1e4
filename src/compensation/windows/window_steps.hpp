#pragma once
/// The steps of a window between its job and its verdict.
#include <exception>

#include "compensation/emit/emit.hpp"
#include "compensation/match/match.hpp"
#include "compensation/solve/branch.hpp"
#include "counterflex/compensation/constant_shift.hpp"
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
/// them in their order. A step is left out where one before it has failed.
struct WindowSteps {
  using Step = std::function<void(const Job&, WindowWork&)>;
  Questions questions{};
  Step prepare, write, match;
  /// The first miss of the tolerance among the waypoints, if there is one.
  std::function<void(const Job&, WindowWork&, const std::optional<Failure>& missed)> judge;
};

/// What every run carries from window to window.
struct PathCarry {
  std::optional<Vector3> command{};  ///< where the text ends, if that is known
  Eigen::VectorXd actuators{};       ///< where the path ends, rotary ones counted on over full turns
};

WindowSteps steps_of_prediction(PathCarry& carry);

/// Sampled as a verification, with all bands. `carry` is where the text ends alone.
WindowSteps steps_of_bands(PathCarry& carry);

/// With a constant shift in effect. `carry` is where the text ends alone: the way there is not followed.
WindowSteps steps_of_shifted_prediction(const ConstantShift& shift, PathCarry& carry);

/// What compensating carries from window to window.
struct WritingCarry {
  Rewriter rewriter;
  TextReader corrected;
  EmitterState emitter{};
  PathCarry path{};
};

WindowSteps steps_of_compensation(WritingCarry& carry, bool attribution);

/// What verifying carries from window to window.
struct VerifyingCarry {
  CorrectedMoves found;
  OtherLines lines{};
  PathCarry path{};
  std::optional<Failure> missed{};  ///< the first miss of the tolerance
};

WindowSteps steps_of_verification(VerifyingCarry& carry, bool attribution);

/// Takes a program that is one window through all steps.
Compensation run_steps(const Job& job, const WindowSteps& steps);

}  // namespace counterflex
