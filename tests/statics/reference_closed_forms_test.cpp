/// Machines simple enough for a formula.
#include "reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE(
    "cantilever, arm, parallel bars and two chains agree with their formulas or an independent solver") {
  check_cases("closed_forms", 23);
}
