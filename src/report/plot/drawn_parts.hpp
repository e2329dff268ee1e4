#pragma once
/// The places of a machine's parts, for pictures.
#include <string>
#include <vector>

#include "counterflex/statics/nominal.hpp"

namespace counterflex {

enum class DrawnKind { linear_axis, rotary_axis, spring, mass, work, tip };

struct DrawnPart {
  DrawnKind kind = DrawnKind::spring;
  std::string name;
  Vector3 at = Vector3::Zero();  ///< in M (m)
};

/// Actuators, springs, compliances and masses at home, work offsets, and the tip, in the order of the
/// machine.
std::vector<DrawnPart> drawn_parts(const Machine& machine, const Model& model);

}  // namespace counterflex
