#pragma once
/// Causes of a deviation, as reports show them.
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// The part of the superposition that is caused by preloads alone (m, rad). Values below 1e-12 m are rounding
/// and become zero.
inline Vector6 preloads_of(const Causes& causes) {
  const Vector6 rest = causes.superposition - causes.geometry - causes.load - causes.fixture - causes.gravity;
  return rest.cwiseAbs().maxCoeff() < 1e-12 ? Vector6(Vector6::Zero()) : rest;
}

}  // namespace counterflex
