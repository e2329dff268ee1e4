#pragma once
/// Guards of RAPID.
#include <string>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// IF with EXIT.
std::vector<std::string> rapid_guard(const Guard& guard);
std::string why_no_rapid_guard(const Guard& guard);

}  // namespace counterflex
