#include "counterflex/geometry/types.hpp"
#include "counterflex/report/run_tally.hpp"

namespace counterflex {

void AsProgrammedTally::add(const Waypoint& w, bool cuts) {
  constexpr double rounding = 1e-12;  // m: of coordinates that were moved to M and back
  if (w.status != Status::converged) return;
  const bool stays = w.correction.head<3>().norm() < rounding;
  stays_ = stays_ && stays;
  move_mm_ += w.weight / mm;
  const double size_mm = w.after.head<3>().norm() / mm;
  const bool is_left = cuts && w.covariance && (stays || w.insignificant);
  if (is_left && (found_.largest_line == 0 || size_mm > found_.largest_mm + indistinct_mm)) {
    found_.largest_mm = size_mm;
    found_.band_mm = band(w.after.head<3>(), w.covariance->topLeftCorner<3, 3>()) / mm;
    found_.largest_line = w.line;
  }
  if (w.between || w.fraction != 1) return;
  ++found_.targets;
  found_.left += stays;
  found_.length_mm += move_mm_;
  if (stays_) found_.left_mm += move_mm_;
  move_mm_ = 0;
  stays_ = stays;
}

}  // namespace counterflex
