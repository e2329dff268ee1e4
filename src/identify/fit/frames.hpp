#pragma once
/// Where a session's frames are about, before anything is fitted.
#include "identify/fit/residuals.hpp"

namespace counterflex {

/// From the tips of the machine as it is (by row of `rows`, all of one session). A probe that is not known is
/// found, too. Rows with gross errors do not spoil it.
SessionFrames first_frames(const Session& session, const std::vector<const Measurement*>& rows,
                           const std::vector<Pose>& X_MT);

}  // namespace counterflex
