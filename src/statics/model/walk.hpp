#pragma once
/// Walks over all series of a mechanism: its chains, and the branches of groups inside them. Each series
/// comes before its branches: in this order the whole system counts variables and closures.
#include <cstddef>

namespace counterflex {

/// Calls visit(series) for `chains` and their branches. Takes states in the place of series, too.
template <class Chains, class Visit>
void for_each_series(Chains& chains, const Visit& visit) {
  for (auto& series : chains) {
    visit(series);
    for (auto& group : series.groups) for_each_series(group.branches, visit);
  }
}

/// Calls visit(series, state) for `chains` and their branches.
template <class Chains, class States, class Visit>
void for_each_series(Chains& chains, States& states, const Visit& visit) {
  for (std::size_t i = 0; i < chains.size(); ++i) {
    visit(chains[i], states[i]);
    for (std::size_t g = 0; g < chains[i].groups.size(); ++g)
      for_each_series(chains[i].groups[g].branches, states[i].groups[g].branches, visit);
  }
}

}  // namespace counterflex
