#pragma once
/// Starts of the kernel that depend on the place alone.
#include <optional>

#include "batch.hpp"
#include "flatten.hpp"

namespace counterflex::kernel {

/// The cell of a target question about a position, the tip's controlled orientations those of home. The
/// nominal machine is followed straight from home to its centre; `step` (m) is the distance of the
/// differences. None where the nominal machine does not get there, or the question is not solved at one of
/// the places about it.
std::optional<StartCell> make_start_cell(const Model& model, const Flat& flat, const Question& question,
                                         const Vector3& centre, double step);

}  // namespace counterflex::kernel
