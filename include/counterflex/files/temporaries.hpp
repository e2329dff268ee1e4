#pragma once
/// Names of files that are being written: NAME.PID-COUNTER.tmp beside NAME; a long NAME is shortened in it.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// The name under which process `pid` writes its `counter`-th file before that becomes `path`.
std::string temporary_name(const std::string& path, long pid, unsigned counter);

/// What stands for the file `name` in the names of its temporary files: itself, where it is short enough.
std::string temporary_stem(const std::string& name);

/// The `temporary_stem` of what a file of that name was to become; empty where it is no such name.
std::string_view wanted_name(std::string_view name);

/// Removes what writers that were killed have left of `paths`, and nothing else; how many files. The caller
/// knows that nobody writes them now. What cannot be removed stays.
std::size_t sweep_temporaries(const std::vector<std::string>& paths);

/// The same where others may write these paths now: their files, which they have locked, stay.
std::size_t sweep_abandoned(const std::vector<std::string>& paths);

}  // namespace counterflex
