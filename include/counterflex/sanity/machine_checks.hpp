#pragma once
/// Checks of a machine and of what a run makes of it, before anything is solved along a path.
#include <map>
#include <optional>

#include "counterflex/sanity/check.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

/// The largest angle between the tip's z (from the tip to the spindle, at home) of `models` and the z axes of
/// `frames`, or the machine's z where there are none. Above 90 deg the tool points into the work: wrong,
/// unless `allowed`. From 45 deg on it is doubtful for machines that turn no joint.
SanityCheck check_tool_axis(const std::vector<const Model*>& models, const std::vector<WorkFrame>& frames,
                            bool turns_joints, bool allowed);

/// Stiffness along x, y and z of the machine at its tip (N/m), the force over the displacement that it
/// causes there; infinite where the tip does not yield. None where the machine has no equilibrium.
/// `p_MT`: where the tip stands (m); none: home.
std::optional<Vector3> tip_stiffness(const Model& model, const std::optional<Vector3>& p_MT);

/// `where`: "at home", "at line 12". Doubtful below 0.05 and above 1000 N/um.
SanityCheck check_tip_stiffness(const std::optional<Vector3>& stiffness, const std::string& where);

/// Lengths by tool number (mm) that are known, of the tools in use (all where `used` is empty): without
/// [spindle] they do not move the tip, which is doubtful.
SanityCheck check_tool_lengths(const std::map<long, double>& lengths_mm, const std::vector<long>& used,
                               bool has_spindle);

/// Whether the offsets that a program selects ("" where it selects none) have a place: `known` says whether
/// the machine file or --work gives any.
SanityCheck check_work_offset(const std::vector<std::string>& selected, bool known);

/// Springs, masses, angles and lengths that hardly any machine has, each a doubtful check that names what
/// holds it; one check that is ok where there is none.
SanityChecks check_magnitudes(const Machine& machine);

}  // namespace counterflex
