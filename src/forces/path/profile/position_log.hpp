#pragma once
/// Logged positions: finds the place on the path of each row of a log.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/path/profile/log_matching.hpp"
#include "forces/path/profile/point_grid.hpp"

namespace counterflex {

/// For messages, in mm.
std::string shown_point(const Vector3& p);

/// A row whose point is not near any feed move, and the nearest feed move, found window by window.
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

/// Collects, window by window, the places where the path comes near the rows of a log: local minima of the
/// distance along the path. Memory is proportional to the number of rows.
class PositionLog {
 public:
  /// `log` has the key `point`, and outlives this.
  explicit PositionLog(ForceProfile& log);

  void add(const Program& window, const Toolpath& path);

  /// The first row that is not near the path, if any.
  std::optional<FarPoint> far_point() const;

  /// Converts the log to a profile by path length. Throws `InputError` (ErrorKind::machine_or_force) at a row
  /// that does not fit the order of the path.
  void settle();

 private:
  /// How the distance from a row's point changed on the last piece near it.
  struct Approach {
    std::size_t piece = 0;  ///< number of that piece
    bool falls = false;     ///< the distance decreased
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
