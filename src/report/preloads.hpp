#pragma once
/// What preloads do to the perfect, unloaded machine.
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// The part of the superposition that is none of the other causes: what preloads do alone (m, rad). Less than 1e-12 m, which
/// is rounding, is zero.
inline Vector6 preloads_of(const Causes& causes) {
  const Vector6 rest = causes.superposition - causes.geometry - causes.load - causes.gravity;
  return rest.cwiseAbs().maxCoeff() < 1e-12 ? Vector6(Vector6::Zero()) : rest;
}

}  // namespace counterflex
