#pragma once
/// `analyze --joints` and `analyze --pose`.
#include <optional>

#include "counterflex/statics/nominal.hpp"
#include "process/console.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// Warns where the machine has another pose than the one that `option` wants.
void warn_of_uncontrolled(const Pose& found, const Pose& wanted, bool has_orientation,
                          const std::string& option, Console& console);

/// Whether `options` name joints or a pose, so that kinematics are shown instead of an analysis. Throws
/// (ErrorKind::usage) for values and combinations that are not allowed.
bool asks_for_kinematics(const Options& options);

/// Prints the places of --joints, then those of --pose. `tool`: the tool in the spindle, in words, or empty.
std::optional<ErrorKind> run_kinematics(const Options& options, const Model& model, SpindleAxis spindle_axis,
                                        const std::string& tool, Console& console);

}  // namespace counterflex::cli
