#pragma once
/// What becomes of a window between its job and its compensated text, stage by stage. A stage does nothing
/// where one before it has failed.
#include "counterflex/compensation/compensate.hpp"
#include "emit.hpp"
#include "match.hpp"

namespace counterflex {

/// What compensating carries from window to window.
struct CarriedState {
  Rewriter rewriter;
  TextReader corrected;
  EmitterState emitter{};
  std::optional<NominalPlace> nominal{};  ///< where the window before ended; none: home
  std::optional<Vector3> command{};       ///< where the text has come, if that is known
};

/// A window on its way.
struct WindowWork {
  NominalTrack track{};
  Plan plan{};
  PlannedWays ways{};
  std::optional<Vector3> command{};  ///< where the window before ended, if that is known
  Compensation result{};

  bool failed() const { return result.failure.has_value(); }
};

/// In the order of windows: checks decimals, follows the nominal machine along the window.
void begin_window(const Job& job, CarriedState& carried, WindowWork& work);

/// In any order.
void plan_window(const Job& job, WindowWork& work);

/// In the order of windows: writes the text and reads it back.
void write_window(const Job& job, CarriedState& carried, WindowWork& work);

/// In any order: matches what was written with the window's moves, by its text.
Matching match_written(const Job& job, const WindowWork& work);

/// Solves it forward.
void solve_matched(const Job& job, bool attribution, const Matching& matching, WindowWork& work);

/// The same for waypoints that are given out in portions.
void solve_matched(const Job& job, bool attribution, const Matching& matching, WindowWork& work,
                   const WaypointTaker& take);

/// In any order: matches, solves, and judges by the tolerance.
void verify_window(const Job& job, bool attribution, WindowWork& work);

}  // namespace counterflex
