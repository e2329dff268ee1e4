#pragma once
/// Names of the axes of a tool frame in machine files.
#include <string_view>
#include <vector>

namespace counterflex {

/// In the order of `SpindleAxis`.
inline const std::vector<std::string_view> spindle_axis_names = {"z", "-z", "x", "-x", "y", "-y"};

}  // namespace counterflex
