#pragma once
/// Names of work offsets.
#include <optional>
#include <string>
#include <string_view>

namespace counterflex {

/// The name as programs' offsets have it ("G54", "G59.1", "G54.1 P3", "G154 P12", "G505"), of one that may be
/// in lower case, lack the blank before P or have zeros before the number; none where it is no work offset.
std::optional<std::string> work_offset_name(std::string_view text);

/// What `work_offset_name` takes, for diagnostics.
inline constexpr std::string_view work_offset_names =
    "G54 to G59, G59.1 to G59.3, G54.1 P1 to P300, G154 P1 to P99 and G500 to G599";

}  // namespace counterflex
