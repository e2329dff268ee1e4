#pragma once
/// Results of commands.
#include <string_view>

namespace counterflex::cli {

/// Lines of text, or JSON, on standard output, without control characters. Throws `InputError`
/// (ErrorKind::transient_io).
void write_result(std::string_view text);

/// The same for text with colours, whose names and texts from inputs are without control characters already.
void write_painted_result(std::string_view text);

}  // namespace counterflex::cli
