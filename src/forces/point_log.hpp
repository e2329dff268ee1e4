#pragma once
/// Logged positions: where along the path the rows of a log belong.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/point_grid.hpp"
#include "forces/visits.hpp"

namespace counterflex {

/// For messages, in mm.
std::string shown_point(const Vector3& p);

/// A row whose point no feed move comes near, and the feed move that comes nearest, gathered window by
/// window.
class FarPoint {
 public:
  FarPoint(const ForceProfile& log, std::size_t row) : log_(&log), row_(row) {}
  void add(const Program& window, const Toolpath& path);
  [[noreturn]] void refuse() const;

 private:
  const ForceProfile* log_;
  std::size_t row_;
  double squared_ = -1;  ///< of the distance (m2); negative: no feed move yet
  int line_ = 0;
};

/// Gathers, window by window, where the path comes near the rows of a log: local minima of the distance along
/// the path. Memory grows with the rows.
class PointLog {
 public:
  /// `log` has the key `point`, and outlives this.
  explicit PointLog(ForceProfile& log);

  void add(const Program& window, const Toolpath& path);

  /// The first row that the path does not come near, if there is one.
  std::optional<FarPoint> far_point() const;

  /// Turns the log into a profile by path length. Throws `InputError` (Exit::machine_or_force) at a row that
  /// cannot be in order.
  void settle();

 private:
  /// How the distance of a row's point went on the last piece that was near it.
  struct Approach {
    std::size_t piece = 0;  ///< number of that piece
    bool falls = false;     ///< it ended nearer than it began
    bool listed = false;    ///< the piece's end is the last visit
  };

  void add_piece(const Vector3& a, const Vector3& b, double s0, double s1);
  void visit(std::size_t row, const Visit& visit, bool replace);

  ForceProfile* log_;
  PointGrid grid_;
  std::vector<std::vector<Visit>> visits_;  ///< of each row
  std::vector<Approach> approaches_;
  std::size_t piece_ = 1;
  std::optional<Vector3> end_;  ///< of the last feed move
};

}  // namespace counterflex
