#pragma once
/// Help for misspelt names.
#include <string>
#include <string_view>
#include <vector>

namespace counterflex::toml_file {

/// The entry of `known` that `name` was probably meant to be, or empty: few letters differ, or only what
/// follows the first underscore, the unit, does; then the one that begins most like it.
std::string_view nearest(std::string_view name, const std::vector<std::string_view>& known);

/// `; did you mean "..."? KIND: a, b, c`, to follow a message about an unknown name; without known names, `;
/// there are none`.
std::string hint(std::string_view name, const std::vector<std::string_view>& known, std::string_view kind);

}  // namespace counterflex::toml_file
