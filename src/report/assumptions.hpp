#pragma once
/// What a run takes for granted of the work frame, in words.
#include "counterflex/report/report.hpp"

namespace counterflex {

/// Where program coordinates were taken to be.
std::string work_in_words(const Machine& machine, const std::vector<WorkFrame>& frames);

/// What the work offset was taken to mean.
std::string datum_in_words(const Machine& machine, const std::vector<WorkFrame>& frames);

}  // namespace counterflex
