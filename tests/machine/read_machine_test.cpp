#include "counterflex/machine/read_machine.hpp"

#include <doctest/doctest.h>

using namespace counterflex;

TEST_CASE("x") { CHECK(load_machine(COUNTERFLEX_SOURCE_DIR "/tests/machine/data/orthoglide.toml").chains.size() == 3); }
