#pragma once
/// The directions in which actuators move along a path: the joints of a machine with reversals lag against
/// them.
#include <cstddef>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "counterflex/statics/directions.hpp"

namespace counterflex {

/// An actuator begins to move in another direction, or to move at all.
struct DirectionChange {
  std::size_t move = 0;  ///< index into Program::moves
  double u = 0;          ///< fraction of its way
  std::size_t actuator = 0;
  Directions behind{};       ///< of all actuators from here on
  bool is_reversal = false;  ///< it moved in the other direction before, and has lost motion
};

/// Along the nominal path of the original program, rapids included. An actuator that does not move keeps the
/// direction of its last motion.
class PathDirections {
 public:
  explicit PathDirections(const Directions& first = {}) : first_(first) {}

  /// At a fraction of a move: inside it, of the motion that ends or that begins there; at its ends its own.
  Directions at(std::size_t move, double u, Side side) const;

  /// Fractions inside a move at which a joint reverses, increasing.
  std::vector<double> inside(std::size_t move) const;

  const std::vector<DirectionChange>& changes() const { return changes_; }

  /// The next change along the path.
  void add(DirectionChange change) { changes_.push_back(change); }

 private:
  Directions first_;
  std::vector<DirectionChange> changes_;
};

/// What a window needs from the one before it.
struct DirectionsEnd {
  Directions directions{};
  Eigen::VectorXd rho{};  ///< actuators where the path ended; empty: not known
};

}  // namespace counterflex
