#pragma once
/// Nominal kinematics along the whole path, once and in order: it keeps the branch, and lets chunks start
/// anywhere.
#include <span>

#include "chunks.hpp"
#include "counterflex/compensation/waypoint.hpp"

namespace counterflex {

struct NominalTrack {
  std::vector<Configuration>
      starts;         ///< by chunk of segments: nominal configuration at its first segment's start
  Configuration end;  ///< and that at the end
  std::optional<Failure> failure;
};

/// `start`: a nominal configuration on the branch, home or that with which the window before ended.
NominalTrack track(const Job& job, const Configuration& start);

/// Solves forward along pieces whose nominal track is known; `command` is where the piece before them ended.
ForwardRun solve_forward_from(const Job& job, const NominalTrack& nominal, std::span<const Piece> pieces,
                              const Questions& questions, const std::optional<Vector3>& command);

/// The failure that a status at a line stands for: travel is a limit, all else is not compensated.
Failure status_failure(Status status, int line);

/// The failure of a correction (emitted minus commanded position, m) larger than the limit.
std::optional<Failure> limit_failure(const Job& job, const Vector3& correction, int line);

}  // namespace counterflex
