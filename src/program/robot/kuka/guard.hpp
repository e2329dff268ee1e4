#pragma once
/// Guards of KRL.
#include <string>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// IF with a loop of HALT.
std::vector<std::string> kuka_guard(const Guard& guard);
std::string why_no_kuka_guard(const Guard& guard);

}  // namespace counterflex
