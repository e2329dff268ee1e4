#pragma once
/// The directions in which actuators move along a path: the joints of a machine with reversals lag against
/// them.
#include <cstddef>
#include <optional>
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

/// An actuator lags at a cut in a direction that is not known: it came from a position that is not.
struct DoubtfulDirection {
  int line = 0;  ///< of the cut
  std::size_t actuator = 0;
  int lost_before = 0;  ///< line of the first move behind that position
};

/// Along the nominal path of the original program, rapids included. An actuator that does not move keeps the
/// direction of its last motion, and so does one that comes from a position that is not known.
class PathDirections {
 public:
  explicit PathDirections(const Directions& first = {}) : first_(first) {}

  /// At a fraction of a move: inside it, of the motion that ends or that begins there; at its ends its own.
  Directions at(std::size_t move, double u, Side side) const;

  /// Where a move begins, of the motion that ends there.
  Directions before(std::size_t move) const;

  /// Fractions inside a move at which a joint reverses, increasing.
  std::vector<double> inside(std::size_t move) const;

  const std::vector<DirectionChange>& changes() const { return changes_; }

  /// Each once, at the first cut.
  const std::vector<DoubtfulDirection>& doubtful() const { return doubtful_; }

  /// The next change along the path.
  void add(DirectionChange change) { changes_.push_back(change); }
  void add(DoubtfulDirection doubt) { doubtful_.push_back(doubt); }

 private:
  Directions first_;
  std::vector<DirectionChange> changes_;
  std::vector<DoubtfulDirection> doubtful_;
};

/// What a window needs from the one before it.
struct DirectionsEnd {
  Directions directions{};
  Eigen::VectorXd rho{};          ///< actuators where the path ended; empty: not known
  std::optional<Vector3> p_MT{};  ///< the place (m)
  /// By actuator: the line before which its position was lost, from then on until its direction is known; 0:
  /// it is known. Whether its position is still lost, and whether a cut was reported.
  struct Lost {
    int before = 0;
    bool position = false, reported = false;
  };
  std::vector<Lost> lost{};
};

}  // namespace counterflex
