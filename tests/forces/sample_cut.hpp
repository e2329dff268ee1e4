#pragma once
/// A cut for the tests of the cutting model.
#include <cmath>

#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::test {

/// A slot of 2 mm with a straight 10 mm cutter of four flutes.
inline CuttingModel sample_cut() {
  CuttingModel model;
  model.mill = {10 * mm, 4, 0};
  model.coefficients = {700 * N_per_mm2, 210 * N_per_mm2, 140 * N_per_mm2,
                        20 * N_per_mm,   15 * N_per_mm,   1.5 * N_per_mm};
  model.axial_depth = 2 * mm;
  model.entry = 0;
  model.exit = pi;
  return model;
}

inline CuttingModel with_helix(CuttingModel model, double helix_deg) {
  model.mill.helix = helix_deg * deg;
  return model;
}

inline CuttingModel between(CuttingModel model, double entry_deg, double exit_deg) {
  model.entry = entry_deg * deg;
  model.exit = exit_deg * deg;
  return model;
}

inline CuttingModel at_wall(CuttingModel model, Wall wall) {
  model.force_at = ForceAt::surface;
  model.wall = wall;
  return model;
}

/// The wrench at a feed per tooth.
inline Vector6 at_feed_per_tooth(const CuttingModel& model, double c) {
  const CutResponse response = respond(model);
  return response.F_c * c + response.F_e;
}

/// Whether two wrenches are the same to `part` of the larger.
inline bool agree(const Vector6& A, const Vector6& B, double part) {
  const auto near = [part](const auto& a, const auto& b) {
    return (a - b).norm() <= part * std::max(a.norm(), b.norm());
  };
  return near(A.head<3>(), B.head<3>()) && near(A.tail<3>(), B.tail<3>());
}

}  // namespace counterflex::test
