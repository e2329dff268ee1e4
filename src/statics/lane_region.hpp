#pragma once
/// What lanes share around a place: nominal kinematics as polynomials, the tangents with which all waypoints there are
/// iterated, and the proof that the machine is stable there. EQUATIONS.md, section 11.
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "lane_model.hpp"

namespace counterflex {

/// A cube of commanded positions. Where waypoints begin and with what they are iterated depends on the cube alone.
class LaneRegion {
 public:
  /// The cube around `centre` (M, m), half its edge `half`; polynomials hold to `margin` beyond. Null where the nominal machine
  /// is not reached there, is near a singularity, or is not matched by polynomials to `polynomial_tolerance`.
  static std::unique_ptr<LaneRegion> make(const Model& model, const LaneModel& lane_model, const Vector3& centre, double half,
                                          double margin, StaticsWork& work);

  const lanes::Region& flat() const { return flat_; }
  const Matrix3& R_centre() const { return R_centre_; }
  const Configuration& nominal() const { return nominal_; }
  /// Whether polynomials hold at a commanded position.
  bool holds(const Vector3& p) const { return (p - centre_).cwiseAbs().maxCoeff() <= flat_.half; }

  /// Values of the actuators for a commanded position.
  Eigen::VectorXd rho_at(const Vector3& p) const;

  /// Orientation of the nominal tip at `p`.
  Matrix3 R_MT(const Vector3& p) const;

  /// Whether the machine, followed from its nominal configuration at the centre, is stable and well conditioned under every
  /// load up to `size` (the larger of force and moment / l, N; no moment where `moments` is false). To first order the loads that
  /// a machine bears are a convex set, so the corners of an octahedron that holds them with a margin speak for all.
  bool bears(double size, bool moments, double errors, StaticsWork& work) const;

 private:
  LaneRegion(const Model& model) : model_(model) {}
  bool fit_kinematics(double half, double margin);
  bool fit_polynomials(double half, int degree);
  bool take_tangents(const LaneModel& lane_model, StaticsWork& work);
  Eigen::MatrixXd actuators_by_position() const;
  Eigen::VectorXd outputs_at(const Vector3& p) const;

  const Model& model_;
  Vector3 centre_;
  Matrix3 R_centre_;
  bool turns_ = false;  ///< whether the nominal tip's orientation depends on the position
  Configuration nominal_, reference_;
  lanes::Region flat_{};
  std::array<double, 9> R_flat_{};
  std::vector<double> polynomials_, start_, cosine_, sine_, forward_, target_;
  std::vector<std::vector<double>> matrices_;
  std::vector<const double*> inside_, by_end_, by_actuators_;
  mutable std::mutex mutex_;
  mutable std::map<std::array<int, 3>, bool> borne_;
};

}  // namespace counterflex
