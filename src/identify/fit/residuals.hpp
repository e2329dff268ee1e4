#pragma once
/// What a row measured, less what the machine with its parameters predicts, and the tangents of that.
#include <vector>

#include "identify/fit/responses.hpp"

namespace counterflex {

/// What a session does not know: the machine frame in its own frame S, the probe B in the tip's, and an
/// offset. Of a plane, S is the plane's frame, z its normal. Of a coupon, S is the frame in which it was
/// measured, moved to where M would be, and the offset is that of the tool's radius.
struct SessionFrames {
  Pose X_SM;
  Pose X_TB;
  double offset = 0;  ///< m
};

/// Unknowns of a session: the twist of M in S (6: position, rotation), of B (6), the offset.
inline constexpr int session_unknowns = 13;

/// Those that rows of a kind determine.
std::vector<int> unknowns_of(MeasurementKind kind);

/// Those of a session. If its frame is known, only the position of a probe that has a deviation.
std::vector<int> unknowns_of(const Session& session);

/// Moves frames by a step of all unknowns.
SessionFrames moved(const SessionFrames& frames, const Eigen::Matrix<double, session_unknowns, 1>& step);

/// r = predicted - measured, in standard deviations; the first `distances` components are lengths, the others
/// angles. To first order r + J_p dp + J_s ds after steps of parameters and session unknowns.
struct RowResidual {
  Eigen::VectorXd r;
  Eigen::MatrixXd J_p, J_s;
  int distances = 0;
  bool is_found = true;  ///< false: the machine has no equilibrium there
};

/// `at` are the responses of the row's states, `X_MT_nominal` the nominal tips there.
RowResidual residual(const Measurement& row, MeasurementKind kind, const SessionFrames& frames,
                     const Response* at, const Pose* X_MT_nominal);

}  // namespace counterflex
