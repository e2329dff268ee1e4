#pragma once
/// Transforms as the machine file writes them.
#include "counterflex/geometry/pose.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// `xyz_mm` (translation first) or `xyz_after_mm` (rotation first), and one of `rpy_deg`, `rotvec_deg`,
/// `quat_wxyz`; what is missing is identity. `name` is what messages call it, `more_keys` are keys that the
/// caller reads.
Pose read_transform(const toml::node& node, std::string_view name, const Reading& reading,
                    const std::vector<std::string_view>& more_keys = {});

}  // namespace counterflex::toml_file
