#pragma once
/// Nominal kinematics along the whole path, once and in order: it keeps the branch, and lets chunks start
/// anywhere.
#include "chunks.hpp"
#include "counterflex/compensation/waypoint.hpp"

namespace counterflex {

struct NominalTrack {
  std::vector<Configuration>
      starts;  ///< by chunk of segments: nominal configuration at its first segment's start
  std::optional<Failure> failure;
};

NominalTrack track(const Job& job);

/// The failure that a status at a line stands for: travel is a limit, all else is not compensated.
Failure status_failure(Status status, int line);

/// The failure of a correction (emitted minus commanded position, m) larger than the limit.
std::optional<Failure> limit_failure(const Job& job, const Vector3& correction, int line);

}  // namespace counterflex
