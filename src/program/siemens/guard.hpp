#pragma once
/// Guards of a Sinumerik.
#include <string>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// IF with SETAL.
std::vector<std::string> siemens_guard(const Guard& guard);
std::string why_no_siemens_guard(const Guard& guard);

}  // namespace counterflex
