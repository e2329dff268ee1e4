#pragma once
/// Why a window cannot be compensated, with the line and what to do.
#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// The failure of a target by its status: travel is a limit, every other status is not
/// compensated.
Failure status_failure(const Job& job, Status status, const CommandedPlace& at, int line);

/// The same for a target (m, in M) of a segment.
Failure status_failure(const Job& job, Status status, const Segment& segment, const Vector3& target);

/// The failure of a correction (emitted minus commanded position, m) larger than the limit.
std::optional<Failure> limit_failure(const Job& job, const Vector3& correction, int line);

/// The failure of a correction that turns the tool (rotation vector, rad) by more than the limit.
std::optional<Failure> turn_limit_failure(const Job& job, const Vector3& turn, int line);

/// 1 for the axes of M along which the machine controls the position of the tip, else 0.
Vector3 controlled_axes(const Mechanism& mechanism);

/// By how much the words of a move as read, and positions that it does not repeat, may be rounded: half of
/// the last digit times sqrt 3 (m).
double rounding_as_read(const Move& move);

/// Roundings that a relation between positions may be off by: of a start, an end and a centre, and of the
/// original's. Shorter first pieces of a move are jumps.
inline constexpr double roundings = 4;

/// The failure of a move's words that are rounded too much for the tolerance.
Failure few_decimals_failure(const Move& move, const CompensationOptions& options);

}  // namespace counterflex
