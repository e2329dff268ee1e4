#pragma once
/// What a run takes for granted of the work frame, in words.
#include "counterflex/report/report.hpp"

namespace counterflex {

/// Where program coordinates were taken to be.
std::string work_in_words(const Machine& machine, const Job& job);

/// What the work offset was taken to mean.
std::string datum_in_words(const Machine& machine, const Job& job);

}  // namespace counterflex
