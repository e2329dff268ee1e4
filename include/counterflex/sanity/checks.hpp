#pragma once
/// Checks of a machine and of a path.
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/statics/mechanism.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

// One question of the sanity block, which doubts inputs that can be read but that hardly any machine has.

enum class SanityState {
  ok,
  doubtful,  ///< the run continues
  wrong,     ///< the run is refused
  unknown,   ///< there is nothing to judge by
};
std::string_view to_string(SanityState state);

struct SanityCheck {
  std::string name;  ///< "tool axis"
  SanityState state = SanityState::unknown;
  std::string text;  ///< the value found; where it is not ok what is usual, and what to do
};

using SanityChecks = std::vector<SanityCheck>;

// Checks of a machine and of what a run makes of it, before anything is solved along a path.

/// The largest angle between the tip's z (from the tip to the spindle, at home) of `models` and the z axes of
/// `frames`, or the machine's z where `frames` is empty. Above 90 deg the tool points into the work: wrong,
/// unless `allowed`. From 45 deg on it is doubtful for machines that turn no joint.
SanityCheck check_tool_axis(const std::vector<const Model*>& models, const std::vector<WorkFrame>& frames,
                            bool turns_joints, bool allowed);

/// Stiffness along x, y and z of the machine at its tip (N/m), the force over the displacement that it
/// causes there; infinite where the tip does not deflect. None where the machine has no equilibrium.
/// `p_MT`: the position of the tip (m); none: home.
std::optional<Vector3> tip_stiffness(const Model& model, const std::optional<Vector3>& p_MT);

/// `where`: "at home", "at line 12". Doubtful below 0.05 and above 1000 N/um.
SanityCheck check_tip_stiffness(const std::optional<Vector3>& stiffness, const std::string& where);

/// Lengths by tool number (mm) that are known, of the tools in use (all where `used` is empty): without
/// [spindle] they do not move the tip, which is doubtful.
SanityCheck check_tool_lengths(const std::map<long, double>& lengths_mm, const std::vector<long>& used,
                               bool has_spindle);

/// Whether the offsets that a program selects ("" where it selects none) have a place: `known` is true if
/// the machine file or --work gives any.
SanityCheck check_work_offset(const std::vector<std::string>& selected, bool known);

/// Springs, masses, angles and lengths that hardly any machine has, each a doubtful check that names what
/// holds it; one check that is ok where no value is doubtful.
SanityChecks check_magnitudes(const Machine& machine);

// Checks of a run along its path, gathered waypoint by waypoint in memory that does not grow with it. They
// depend on the order of the waypoints, not on where the path is cut into windows.

/// The values of one axis along a path, as the control shows them (m or rad).
struct AxisValues {
  double least = HUGE_VAL, largest = -HUGE_VAL;
  double margin = HUGE_VAL;  ///< the least one to an end of its travel; infinite without a limit
  double tightest = 0;       ///< the value there
  int line = 0;              ///< and the line of its move
};

/// The values of all axes over the commanded targets of a path, rapids and the bottoms of holes included.
/// Rotary axes count on over full turns.
class TravelTally {
 public:
  /// Actuator values at a place (m, rad), and the line of its move.
  void add(const Mechanism& mechanism, const Eigen::VectorXd& rho, int line);

  /// The places of a move that are not known, or not solved.
  void skip(int line) {
    if (skipped_++ == 0) first_skipped_ = line;
  }

  const std::vector<AxisValues>& axes() const { return axes_; }  ///< empty: nothing was added
  std::size_t places() const { return places_; }
  std::size_t skipped() const { return skipped_; }  ///< moves with such places
  int first_skipped() const { return first_skipped_; }

 private:
  std::vector<AxisValues> axes_;
  Eigen::VectorXd last_;  ///< actuator values, counted on
  std::size_t places_ = 0, skipped_ = 0;
  int first_skipped_ = 0;
};

/// `named`: the machine without a tool, whose actuators have names. `failure`: why the path was not followed
/// to its end. The text names what was skipped.
SanityCheck check_travel(const Mechanism& named, const TravelTally& tally,
                         const std::optional<Failure>& failure);

/// What a check states of the path behind the place where a run ended.
std::string unknown_behind(const Failure& failure);

/// The force on the tool beside the direction of its feed, over the cutting path where a force acts.
struct FeedForceTally {
  double loaded = 0;                    ///< m
  double along = 0;                     ///< m: the force pushes along the feed
  double push = 0;                      ///< N m: integral of its component there
  Vector3 force = Vector3::Zero();      ///< N m: integral of the force across the tool axis
  double size = 0;                      ///< N m: integral of its size
  Vector3 direction = Vector3::Zero();  ///< m: integral of the path's direction

  void add(const Waypoint& w);
};

/// Doubtful where the force pushes along the feed on more than three quarters of the path, or keeps its
/// direction in the machine while the feed turns; never where all forces are `computed` from the cut, so that
/// their sense is not typed. Unknown where a run with a `failure` ended before any force acted.
SanityCheck check_feed_force(const FeedForceTally& tally, bool computed = false,
                             const std::optional<Failure>& failure = {});

/// Forces (N) and the tolerance (mm) that hardly any run has; empty where they are usual.
SanityChecks check_force_size(double largest_N);
SanityChecks check_tolerance(double tolerance_mm);

}  // namespace counterflex
