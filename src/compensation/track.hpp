#pragma once
/// Nominal kinematics along the whole path, once and in order: it keeps the branch, and lets chunks start
/// anywhere.
#include <span>

#include "chunks.hpp"
#include "counterflex/compensation/travel_words.hpp"
#include "counterflex/compensation/waypoint.hpp"
#include "path_solver.hpp"

namespace counterflex {

/// Where the nominal machine stands at a segment's start.
struct TrackStart {
  std::size_t segment;
  Configuration configuration;  ///< of the model that the segment needs
};

struct NominalTrack {
  std::vector<TrackStart> starts;  ///< of every 32nd segment, and of those that need another model than the
                                   ///< one before
  NominalPlace end;
  std::optional<Failure> failure;

  /// The last start that is not behind `segment`: one of the model that this segment needs.
  const Configuration& start_before(std::size_t segment) const;
};

/// `start`: a nominal configuration on the branch, home or that with which the window before ended. Where
/// the model changes it is begun anew from the next one's home.
NominalTrack track(const Job& job, const NominalPlace& start);

/// Solves forward along pieces whose nominal track is known; `command` is where the piece before them ended.
ForwardRun solve_forward_from(const Job& job, const NominalTrack& nominal, std::span<const Piece> pieces,
                              const Questions& questions, const std::optional<Vector3>& command);

/// The same for waypoints that are given out in chunks, of which `together` are solved before the first of them is
/// given out. Returns the failure of the last waypoint.
std::optional<Failure> solve_forward_in_portions(const Job& job, const NominalTrack& nominal,
                                                 std::span<const Piece> pieces, const Questions& questions,
                                                 const std::optional<Vector3>& command, std::size_t together,
                                                 const WaypointTaker& take);

inline constexpr std::size_t few_chunks = 4;  ///< together; of long lines each has 30 MB of waypoints
inline constexpr std::size_t all_chunks = static_cast<std::size_t>(-1);

/// The failure that the status of a target stands for: travel is a limit, all else is not compensated.
Failure status_failure(const Job& job, Status status, const CommandedPlace& at, int line);

/// The same of a target (m, in M) of one of the job's moves, which `model` makes.
Failure status_failure(const Job& job, Status status, const Model& model, const Move& move,
                       const Vector3& target, int line);

/// The failure of a correction (emitted minus commanded position, m) larger than the limit.
std::optional<Failure> limit_failure(const Job& job, const Vector3& correction, int line);

}  // namespace counterflex
