#pragma once
/// The measured parts of a report as JSON: statistics of deviations, their causes, offsets.
#include "counterflex/report/report.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {

Json optional_number(const std::optional<double>& value);
Json optional_statistics(const std::optional<DeviationStatistics>& s);
Json sources_at_json(const SourcesAtWorst& at, bool weights, bool preloads);
Json best_offsets_json(const BestOffsets& best);
Json summary_json(const RunReport& report);

}  // namespace counterflex
