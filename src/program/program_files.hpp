#pragma once
/// The line between the files of a joined text.
#include <string_view>

namespace counterflex {

/// Attributes of KUKA files begin with '&'. No file has this one: it is only in joined texts.
inline constexpr std::string_view file_mark = "&FILE ";

}  // namespace counterflex
