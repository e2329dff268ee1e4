#pragma once
/// What a setup sheet states besides its report, as JSON.
#include "counterflex/report/report.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {

Json proof_json(const ProofFacts& proof);

}  // namespace counterflex
