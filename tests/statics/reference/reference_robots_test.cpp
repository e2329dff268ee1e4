/// A 6R milling robot and a hexapod against an independent solver.
#include "statics/support/reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("the 6R robot agrees with an independent solver, with elastic joints and with an elastic forearm") {
  check_cases("serial6r", 14);
}

TEST_CASE("the hexapod agrees with an independent solver, with free and with sprung joints") {
  check_cases("hexapod", 8);
}
