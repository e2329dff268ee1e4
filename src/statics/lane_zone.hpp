#pragma once
/// What is known of nominal kinematics and of stability in a zone of commanded positions. All of it depends on the place
/// alone, not on who asked first. EQUATIONS.md, section 11.
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "lane_memory.hpp"
#include "lane_tangents.hpp"

namespace counterflex {

/// A cube of commanded positions in which the values of actuators are polynomials of the position.
class LaneZone {
 public:
  /// The cube around `centre` (M, m), half its edge `half`. Null where the nominal machine is not reached there, is near a
  /// singularity, has no stiffness or preloads of its own at the nominal configuration, or is not matched by polynomials to
  /// 2e-12 (m, rad).
  static std::unique_ptr<LaneZone> make(const Model& model, const LaneModel& lane_model, const Vector3& centre, double half,
                                        StaticsWork& work);

  const Configuration& nominal() const { return nominal_; }
  const Configuration& reference() const { return reference_; }

  const Vector3& centre() const { return centre_; }

  /// Where a point of [-1, 1]^3 is in the cube, and corner 0 to 7.
  Vector3 place_of(const Vector3& x) const { return centre_ + flat_.half * x; }
  Vector3 corner(int number) const { return place_of({number & 1 ? 1. : -1., number & 2 ? 1. : -1., number & 4 ? 1. : -1.}); }

  /// What lanes share at the zone's centre.
  const lanes::Region& flat() const { return flat_; }

  /// Whether polynomials hold at a commanded position.
  bool holds(const Vector3& p) const { return (p - centre_).cwiseAbs().maxCoeff() <= flat_.half; }

  /// Values of the actuators for a commanded position, their change by it (actuators x 3), and the nominal tip's orientation.
  Eigen::VectorXd rho_at(const Vector3& p) const;
  Eigen::MatrixXd actuators_by_position(const Vector3& p) const;
  std::vector<double> bend_of_actuators(const Vector3& p) const;  ///< how that changes by the position, as Region::bend
  Matrix3 R_MT(const Vector3& p) const;

  /// Whether the machine is stable, and as far as that is judged well conditioned, under every force up to `force` (N) with every moment up to `moment`
  /// (N m; 0: none). To first order the loads that it bears in a place are a convex set, so the corners of an octahedron that
  /// holds them with a margin speak for all, at the centre and the corners of the cube. `lane_strength.hpp`.
  bool bears(double force, double moment, lanes::Acting acting, StaticsWork& work) const;

 private:
  LaneZone(const Model& model, const LaneModel& lane_model) : model_(model), lane_model_(lane_model) {}
  bool find_centre(StaticsWork& work);
  bool fit_kinematics();
  void take_polynomials(const Eigen::MatrixXd& coefficients, int degree);
  Eigen::RowVectorXd powers_at(const Vector3& p) const;
  Eigen::Map<const Eigen::MatrixXd> coefficients() const;  ///< actuators x powers
  bool bears_octahedron(double force, double turning, lanes::Acting acting, StaticsWork& work) const;

  const Model& model_;
  const LaneModel& lane_model_;
  Vector3 centre_;
  Matrix3 R_centre_;
  Configuration nominal_, reference_;
  LaneStart start_;
  LaneTangents tangents_;
  lanes::Region flat_{};
  bool turns_ = false;  ///< whether the nominal tip's orientation depends on the position
  std::vector<double> polynomials_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> orientation_;  ///< polynomials of its rotation vector against the centre's
  mutable std::mutex mutex_;
  mutable std::map<std::array<double, 4>, bool> borne_;  ///< by force, moment / l, errors and weights
};

}  // namespace counterflex
