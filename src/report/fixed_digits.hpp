#pragma once
/// Numbers of tables with many cells.
#include <string>

namespace counterflex {

/// Appends what `format_fixed` gives, some times faster.
void append_fixed(std::string& text, double value, int decimals);

}  // namespace counterflex
