#pragma once
/// Guards of URScript.
#include <string>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// if with halt.
std::vector<std::string> ur_guard(const Guard& guard);
std::string why_no_ur_guard(const Guard& guard);

}  // namespace counterflex
