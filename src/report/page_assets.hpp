#pragma once
/// The files of the page, embedded when the program is built; page.cmake lists them.
#include <span>
#include <string_view>

namespace counterflex {

std::string_view page_template();
std::span<const std::string_view> page_styles();
std::string_view sheet_style();                    ///< of a setup sheet
std::span<const std::string_view> page_scripts();  ///< in the order in which they run

}  // namespace counterflex
