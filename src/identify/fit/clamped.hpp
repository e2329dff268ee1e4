#pragma once
/// An actuator that turns against the compliance of a machine whose flange is clamped.
#include "identify/fit/responses.hpp"

namespace counterflex {

/// What is varied, for tangents.
struct VariedTangents {
  const ParameterTangents& of;
  const std::vector<bool>& is_compliance;  ///< by varied parameter
};

/// Fills `turn` and `turn_tangents` of a state in equilibrium at `free`. With the compliance C of the tip and
/// its twist J by the actuator, the clamp exerts F = -C^-1 J turn, and the torque is J' C^-1 J turn. A tip
/// that is rigid in some directions has J in the range of C, where any generalised inverse gives the same.
/// Positions are taken as small motions: errors are of second order. An actuator without compliance turns by
/// 0.
void fill_clamped(const Model& model, const Configuration& free, const ClampedTorque& clamped,
                  const VariedTangents& tangents, StaticsWork& work, StaticsWork& tangent_work, Response& at);

}  // namespace counterflex
