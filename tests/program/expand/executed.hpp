#pragma once
/// Programs whose loops, conditions and jumps were executed, for tests.
#include <string>

#include "program/dialect.hpp"
#include "program/expand/expand.hpp"

namespace counterflex::test {

struct Executed {
  std::string text;
  Expansion expansion;
};

inline Executed executed(std::string text, const std::string& dialect) {
  Expansion expansion = expand_subprograms(text, "p.nc", *find_dialect(dialect));
  return {std::move(text), std::move(expansion)};
}

}  // namespace counterflex::test
