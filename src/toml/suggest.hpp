#pragma once
/// Suggestions for misspelt names.
#include <string>
#include <string_view>
#include <vector>

namespace counterflex::toml_file {

/// `; did you mean "..."? KIND: a, b, c` for the end of a message about an unknown name; without known names
/// `; KIND: nothing`.
std::string hint(std::string_view name, const std::vector<std::string_view>& known, std::string_view kind);

}  // namespace counterflex::toml_file
