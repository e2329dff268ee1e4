#pragma once
#include "counterflex/report/report.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {

Json as_programmed_json(const AsProgrammed& found);
Json bands_json(const BandStatistics& bands);
Json uncertainty_json(const UncertaintyReport& of);

}  // namespace counterflex
