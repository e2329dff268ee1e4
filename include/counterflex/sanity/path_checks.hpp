#pragma once
/// Checks of a run along its path, gathered waypoint by waypoint in memory that does not grow with it. They
/// depend on the order of the waypoints, not on where the path is cut into windows.
#include <optional>

#include "counterflex/compensation/waypoint.hpp"
#include "counterflex/sanity/check.hpp"
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// The place of a path where an actuator comes nearest to an end of its travel; m or rad.
struct LeastMargin {
  std::size_t actuator = 0;
  double value = 0, margin = 0;
  int line = 0;
};

/// The least margin of the commanded targets.
class TravelTally {
 public:
  /// Actuator values at a place (m, rad), and the line of its move.
  void add(const Mechanism& mechanism, const Eigen::VectorXd& rho, int line);

  /// None: no actuator has a limit, or nothing was added.
  const std::optional<LeastMargin>& least() const { return tightest_; }
  std::size_t places() const { return places_; }

 private:
  std::optional<LeastMargin> tightest_;
  double share_ = 0;  ///< of the travel, as `AxisPlace` has it
  std::size_t places_ = 0;
};

/// `named`: the machine without a tool, whose actuators have names. `failure`: why the path was not followed to its
/// end.
SanityCheck check_travel(const Mechanism& named, const TravelTally& tally, const std::optional<Failure>& failure);

/// The force on the tool beside the direction of its feed, over the cutting path where a force acts.
struct FeedForceTally {
  double loaded = 0;                      ///< m
  double along = 0;                       ///< m: the force pushes along the feed
  double push = 0;                        ///< N m: integral of its component there
  Vector3 force = Vector3::Zero();        ///< N m: integral of the force across the tool axis
  double size = 0;                        ///< N m: integral of its size
  Vector3 direction = Vector3::Zero();    ///< m: integral of the path's direction

  void add(const Waypoint& w);
};

/// Doubtful where the force pushes along the feed on more than three quarters of the path, or keeps its
/// direction in the machine while the feed turns; never where all forces are `computed` from the cut, so that
/// their sense is not typed.
SanityCheck check_feed_force(const FeedForceTally& tally, bool computed = false);

/// Forces (N) and the tolerance (mm) that hardly any run has; empty where they are usual.
SanityChecks check_force_size(double largest_N);
SanityChecks check_tolerance(double tolerance_mm);

}  // namespace counterflex
