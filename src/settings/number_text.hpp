#pragma once
/// Numbers as texts of the command line.
#include <string>

namespace counterflex::setting_file {

/// The shortest text that TOML and the command line read as `value`, with an exponent below 1e-6 and from
/// 1e15 on; "0" for both zeros.
std::string number_text(double value);

}  // namespace counterflex::setting_file
