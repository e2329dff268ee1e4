#pragma once
/// How uncertain the place of a loaded machine's tip is, to first order. EQUATIONS.md, section 14.
#include "counterflex/statics/nominal.hpp"
#include "counterflex/statics/parameter_tangents.hpp"

namespace counterflex {

/// What the covariance of the tip is a sum of (m2, m rad, rad2; axes of M).
struct TipCovariance {
  Matrix6 parameters = Matrix6::Zero();  ///< of the machine
  Matrix6 force = Matrix6::Zero();
  Matrix6 others = Matrix6::Zero();  ///< tool length, repeatability, temperature

  Matrix6 sum() const { return parameters + force + others; }
};

/// How the place of a part follows the errors of the machine with which it was touched off. Nothing where it
/// was not.
struct DatumTangents {
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_parameter{};  ///< m by parameter (SI), axes of M
  Vector3 axes = Vector3::Zero();                           ///< 1 for each touched axis of M, else 0
};

/// Covariances of the tip of one machine, whose `uncertainty` and parameters' deviations they are of. Keeps a
/// reference to nothing; threads may share it.
class TipUncertainty {
 public:
  /// `machine` has an uncertainty, and a temperature if that is uncertain. `model` is that of `machine`, or
  /// of the machine with a tool of [tools].
  TipUncertainty(const Machine& machine, const Model& model, const Tool* tool = nullptr);

  /// Memory for one thread.
  StaticsWork work() const { return tangents_.work(); }

  /// Of the tip relative to the part, at an equilibrium of the model under `load` with everything acting.
  /// `datum`: of the part.
  TipCovariance of_tip(const Configuration& configuration, const Load& load, StaticsWork& work,
                       const DatumTangents& datum = {}) const;

  /// Of a datum that was touched off at `configuration`, an equilibrium of the model without a load. `axes`:
  /// 1 for each axis of M in which the datum is from there, else 0.
  DatumTangents of_datum(const Configuration& configuration, const Vector3& axes, StaticsWork& work) const;

 private:
  Mechanism mechanism_;
  Uncertainty uncertainty_;
  KnownParameters known_;
  ParameterTangents tangents_;
  Vector3 shift_ = Vector3::Zero();  ///< of the tip by temperature (m/K)
  double growth_ = 0;                ///< of the spindle (m/K)
};

/// Half the width of the band of a position deviation `d` with covariance `C`, k = 2 (m): 2 sqrt(u'Cu), u the
/// direction of d. Where d is not larger than that its direction means nothing, and u is the most uncertain
/// direction.
double band(const Vector3& d, const Matrix3& C);

/// The direction u of `band`.
Vector3 band_direction(const Vector3& d, const Matrix3& C);

}  // namespace counterflex
