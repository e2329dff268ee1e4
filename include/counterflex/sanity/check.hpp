#pragma once
/// One question of the sanity block, which doubts inputs that can be read but that hardly any machine has.
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

enum class SanityState {
  ok,
  doubtful,  ///< the run continues
  wrong,     ///< the run is refused
  unknown,   ///< there is nothing to judge by
};
std::string_view to_string(SanityState state);

struct SanityCheck {
  std::string name;  ///< "tool axis"
  SanityState state = SanityState::unknown;
  std::string text;  ///< the value found; where it is not ok what is usual, and what to do
};

using SanityChecks = std::vector<SanityCheck>;

}  // namespace counterflex
