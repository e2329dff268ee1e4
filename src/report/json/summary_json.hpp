#pragma once
/// The measured parts of a report as JSON: statistics of deviations, their causes, offsets.
#include <functional>

#include "counterflex/report/report.hpp"
#include "report/json/json_numbers.hpp"
#include "report/tally/causes.hpp"

namespace counterflex {

Json optional_number(const std::optional<double>& value);
Json optional_statistics(const std::optional<DeviationStatistics>& s);
/// A cause that is not `shown` is null; without a fixture there is no entry for it.
Json sources_at_json(const SourcesAtWorst& at, const std::function<bool(const Cause&)>& shown);
Json best_offsets_json(const BestOffsets& best);
Json summary_json(const RunReport& report);

}  // namespace counterflex
