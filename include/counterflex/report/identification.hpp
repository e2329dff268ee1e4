#pragma once
/// The result of an identification for people and for programs.
#include <string>
#include <string_view>

#include "counterflex/identify/identify.hpp"

namespace counterflex {

/// For a terminal: the parameters that are identified, or all.
std::string to_text(const Identification& found, bool all_parameters = false);

/// "counterflex-identification 1": values, their covariance in the units of their names, the tests of the
/// fit.
std::string to_json(const Identification& found);

/// The covariance of such a document, for the fit of other measurements. Throws `InputError`
/// (ErrorKind::machine_or_force) unless `machine` has its parameters with its values, and the matrix is a
/// covariance.
KnownParameters read_covariance(std::string_view text, const std::string& file, const Machine& machine);

/// One HTML file that needs nothing but itself. `machine`: its name; `files`: the measurements.
std::string identification_page(const Identification& found, std::string_view machine,
                                std::string_view files);

}  // namespace counterflex
