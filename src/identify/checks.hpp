#pragma once
/// What is refused before a fit, because no fit can be right.
#include <vector>

#include "counterflex/identify/measurements.hpp"

namespace counterflex {

/// Throws where a session has fewer numbers than its frames have freedoms, or states that are all alike.
void check_sessions(const Measurements& measurements);

/// Throws where measured places spread far more, or less, than the tips at the commanded states: a unit is
/// wrong.
void check_units(const Session& session, const std::vector<const Measurement*>& rows,
                 const std::vector<Pose>& X_MT);

}  // namespace counterflex
