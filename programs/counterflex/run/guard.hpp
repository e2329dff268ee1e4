#pragma once
/// The checks of --guard.
#include <optional>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"
#include "process/console.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

/// Finds the first cut of the program and the window within which the corrected program holds, and sets the
/// guard of the run: for this the program is compensated once without being written. Sets no guard if the
/// compensation fails; it will fail again. Throws `InputError`: ErrorKind::usage if the control has no
/// guards, ErrorKind::program_text if nothing is cut or the program sets its own offset,
/// ErrorKind::machine_or_force if the numbers of the work offset on the control are not known,
/// ErrorKind::not_compensated if not even the smallest window holds.
void prepare_guard(Run& run, Console& console);

/// Of a run that verifies: sets the guard with which one of the corrected program is compared, without a
/// window. Sets none if its values are not known.
void expect_guard(Run& run);

/// The largest half-width (mm) of `window_steps_mm` within which the corrected program holds; empty: not even
/// the smallest one. `tool`: its length may be off, too. `places` are of the corrected program, those that
/// use up most of the tolerance.
std::optional<double> window_of(const Run& run, std::optional<long> tool,
                                const std::vector<LoadPlace>& places);

}  // namespace counterflex::cli
