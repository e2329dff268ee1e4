#pragma once
/// Guards of controls that read G-code.
#include <string>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// LinuxCNC: O-words with `(abort, )`.
std::vector<std::string> linuxcnc_guard(const Guard& guard);
std::string why_no_linuxcnc_guard(const Guard& guard);

/// Fanuc and Haas: custom macros with alarms by #3000.
std::vector<std::string> fanuc_guard(const Guard& guard);
std::string why_no_fanuc_guard(const Guard& guard);
std::vector<std::string> haas_guard(const Guard& guard);
std::string why_no_haas_guard(const Guard& guard);

}  // namespace counterflex
