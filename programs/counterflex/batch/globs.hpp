#pragma once
/// Names with wildcards.
#include <string>
#include <string_view>
#include <vector>

namespace counterflex::cli {

/// Whether `text` has one of * ? [
bool is_glob(std::string_view text);

/// The regular files that `pattern` matches, sorted by their bytes: * ? [...] within a name, ** for any
/// number of folders. Hidden files and folders match only patterns with their dot. Throws `InputError` with a
/// folder that cannot be read: ErrorKind::machine_or_force without permission, else ErrorKind::transient_io.
std::vector<std::string> files_matching(const std::string& pattern);

}  // namespace counterflex::cli
