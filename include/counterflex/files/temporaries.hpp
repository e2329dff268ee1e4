#pragma once
/// Names of files that are being written: NAME.PID-COUNTER.tmp beside NAME.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// The name under which process `pid` writes its `counter`-th file before that becomes `path`.
std::string temporary_name(const std::string& path, long pid, unsigned counter);

/// What a file of that name was to become; empty where it is no such name.
std::string_view wanted_name(std::string_view name);

/// Removes what writers that were killed have left of `paths`, and nothing else; how many files. The caller
/// knows that nobody writes them now. What cannot be removed stays.
std::size_t sweep_temporaries(const std::vector<std::string>& paths);

}  // namespace counterflex
