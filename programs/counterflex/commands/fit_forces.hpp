#pragma once
/// Identifies cutting coefficients from a log of the spindle.
#include <optional>

#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// Fits the cutting model of `options` to the log, shows the coefficients, and writes the fitted model.
/// Throws `InputError`.
std::optional<ErrorKind> fit_forces(const Options& options, Console& console);

}  // namespace counterflex::cli
