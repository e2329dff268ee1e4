#pragma once
/// The dialects that programs can be in.
#include <string_view>
#include <vector>

namespace counterflex {

/// "auto", then the names of all dialects that can be read.
std::vector<std::string_view> known_dialects();

}  // namespace counterflex
