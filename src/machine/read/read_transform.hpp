#pragma once
/// Reads transforms from the machine file.
#include "counterflex/geometry/pose.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// `xyz_mm` (translation first) or `xyz_after_mm` (rotation first), and one of `rpy_deg`, `rotvec_deg`,
/// `quat_wxyz`; missing parts are identity. `name` is for messages, `more_keys` are keys that the caller
/// reads.
Pose read_transform(const toml::node& node, std::string_view name, const Reading& reading,
                    const std::vector<std::string_view>& more_keys = {});

}  // namespace counterflex::toml_file
