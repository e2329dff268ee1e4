#pragma once
/// Numbers as texts of the command line.
#include <string>

namespace counterflex::setting_file {

/// The shortest text that is read as `value` again, without an exponent; "0" of both zeros.
std::string number_text(double value);

}  // namespace counterflex::setting_file
