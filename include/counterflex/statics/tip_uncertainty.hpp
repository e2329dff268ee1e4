#pragma once
/// How uncertain the place of a loaded machine's tip is, to first order. EQUATIONS.md, section 14.
#include <map>

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

/// Covariances of the tip of one machine, whose `uncertainty` and parameters' deviations they are of. Keeps a
/// reference to nothing; threads may share it.
class TipUncertainty {
 public:
  /// `machine` has an uncertainty, and a temperature if that is uncertain. `model` is that of `machine`.
  TipUncertainty(const Machine& machine, const Model& model);

  /// Memory for one thread.
  StaticsWork work() const { return tangents_.work(); }

  /// Of the tip relative to the part, at an equilibrium of the model under `load` with everything acting.
  TipCovariance of_tip(const Configuration& configuration, const Load& load, StaticsWork& work) const;

 private:
  Mechanism mechanism_;
  Uncertainty uncertainty_;
  KnownParameters known_;
  ParameterTangents tangents_;
  Vector3 shift_ = Vector3::Zero();  ///< of the tip by temperature (m/K)
  double growth_ = 0;                ///< of the spindle (m/K)
};

/// By model: that of the machine itself, and those of `tools`. Their models outlive it.
using TipUncertainties = std::map<const Model*, TipUncertainty>;

/// Half the width of the band of a position deviation `d` with covariance `C`, k = 2 (m): 2 sqrt(u'Cu), u the
/// direction of d. Where d is not larger than that its direction means nothing, and u is the most uncertain
/// direction.
double band(const Vector3& d, const Matrix3& C);

/// The direction u of `band`.
Vector3 band_direction(const Vector3& d, const Matrix3& C);

/// None for a machine without an uncertainty.
TipUncertainties tip_uncertainties(const Machine& machine, const Model& model, const ToolModels& tools);

}  // namespace counterflex
