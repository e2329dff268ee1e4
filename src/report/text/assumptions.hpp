#pragma once
/// Assumptions of a run about work frame, tools and weights, in words.
#include "counterflex/report/report.hpp"

namespace counterflex {

/// The assumed pose of program coordinates.
std::string work_in_words(const Machine& machine, const std::vector<WorkFrame>& frames);

/// The assumed datum of the work offset.
std::string datum_in_words(const Machine& machine, const std::vector<WorkFrame>& frames);

/// The tools of the program that are in [tools], ascending; empty if no tool changes the machine.
std::vector<UsedTool> used_tools(const Machine& machine, const std::vector<long>& numbers);

/// The stiffness of tools in use, and the assumption for moves with other tools; empty without tools.
std::string tools_in_words(const std::vector<UsedTool>& tools, const std::vector<long>& numbers);

/// Causes of deviation that are not modelled, one phrase each, the largest first.
std::vector<std::string> not_modelled(const Machine& machine);

/// Which weights act, and when the control's zero was set; empty without weights.
std::string thermal_in_words(const Machine& machine);
std::string gravity_in_words(const Machine& machine);

}  // namespace counterflex
