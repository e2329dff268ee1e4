#pragma once
/// Guards of Klartext.
#include <string>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// FN 18: SYSREAD with FN 14: ERROR.
std::vector<std::string> klartext_guard(const Guard& guard);
std::string why_no_klartext_guard(const Guard& guard);

}  // namespace counterflex
