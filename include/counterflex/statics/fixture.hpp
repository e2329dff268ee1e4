#pragma once
/// Where a part that deflects with its fixture is under a force.
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// The pose of the loaded part's frame in that of the unloaded one, both M where the part does not move:
///
///     X_MR = X_MF [Exp(phi), p] X_MF^-1        (p, phi) = C (-F at F)
///
/// `F` is the wrench on the tool (N, N m; axes of M) at `p_MC`, the place of the cut on the unloaded part. A
/// tip at X_MT is at X_MR^-1 X_MT relative to the part.
Pose deflected_part(const Fixture& fixture, const Vector6& F, const Vector3& p_MC);

/// A wrench on the tool, given at the tip or at the reference point, at a tip at `X_MT`.
Vector6 wrench_at_tip(const Mechanism& mechanism, const Vector6& F, bool at_platform, const Pose& X_MT);

}  // namespace counterflex
