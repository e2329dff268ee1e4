#pragma once
/// The lines between the files of a joined text.
#include <string_view>

namespace counterflex {

/// Attributes of KUKA files begin with '&'. No file has this one: it is only in joined texts.
inline constexpr std::string_view file_mark = "&FILE ";

/// "&FILE NAME\tLINE" and "&BACK \tLINE" are around a data list that follows its loop: the lines behind them
/// are counted from LINE on. Behind "&BACK" the program continues.
inline constexpr std::string_view back_mark = "&BACK ";
inline constexpr char line_mark = '\t';

}  // namespace counterflex
