#pragma once
/// Tangents and starts of lanes in a part of a zone. They depend on the place alone, not on who asked first. EQUATIONS.md,
/// section 11.
#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "lane_zone.hpp"

namespace counterflex {

/// A cube small enough for one set of tangents, in which the unloaded state is a polynomial of the position.
class LaneCell {
 public:
  /// The cube around `centre` (M, m), half its edge `half`. Null where an equilibrium is not found from the zone's, or where it
  /// has no stiffness.
  static std::unique_ptr<LaneCell> make(const Model& model, const LaneModel& lane_model, std::shared_ptr<const LaneZone> zone,
                                        const Vector3& centre, double half, StaticsWork& work);

  const LaneZone& zone() const { return *zone_; }

  /// Whether tangents and starts are made for a position.
  bool holds(const Vector3& p) const { return (p - centre_).cwiseAbs().maxCoeff() <= half_ && zone_->holds(p); }

  /// What lanes share.
  lanes::Region region(lanes::Acting acting) const;

 private:
  LaneCell(const LaneModel& lane_model, std::shared_ptr<const LaneZone> zone, const Vector3& centre, double half)
      : lane_model_(lane_model), zone_(std::move(zone)), centre_(centre), half_(half) {}
  bool take_tangents(const Model& model, StaticsWork& work);
  std::vector<double> displacement(lanes::Acting acting) const;
  lanes::Region flat() const;

  const LaneModel& lane_model_;
  std::shared_ptr<const LaneZone> zone_;
  Vector3 centre_;
  double half_;
  LaneStart start_;
  LaneTangents tangents_;       ///< at the centre
  std::vector<double> bend_;
  mutable std::array<std::once_flag, 4> asked_;  ///< for the displacement without and with errors and weights
  mutable std::array<std::vector<double>, 4> displacements_;
};

}  // namespace counterflex
