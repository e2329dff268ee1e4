#pragma once
/// What a run takes for granted of work frame, tools and weights, in words.
#include "counterflex/report/report.hpp"

namespace counterflex {

/// Where program coordinates were taken to be.
std::string work_in_words(const Machine& machine, const std::vector<WorkFrame>& frames);

/// What the work offset was taken to mean.
std::string datum_in_words(const Machine& machine, const std::vector<WorkFrame>& frames);

/// The tools of the program that [tools] says something of, ascending; none where no tool makes the machine
/// another one.
std::vector<UsedTool> used_tools(const Machine& machine, const std::vector<long>& numbers);

/// The stiffness of tools in use, and what was taken of moves with others; empty without any.
std::string tools_in_words(const std::vector<UsedTool>& tools, const std::vector<long>& numbers);

/// What moves the tip of a real machine besides what was solved, one phrase each; the largest first.
std::vector<std::string> not_modelled(const Machine& machine);

/// Which weights act, and when the controller's zero was set; empty where none act.
std::string gravity_in_words(const Machine& machine);

}  // namespace counterflex
