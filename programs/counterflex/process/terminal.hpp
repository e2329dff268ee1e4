#pragma once
/// The terminal, the arguments and the environment as the operating system has them. Each system has its
/// implementation, in posix/ and in win32/.
#include <cstddef>
#include <vector>

namespace counterflex::cli {

/// Called first: standard streams pass bytes unchanged, and a terminal that can show UTF-8 does. Returns the
/// arguments; on Windows these are UTF-8, and / separates the names of a path.
std::vector<const char*> begin_process(int argc, char** argv);

/// "NAME=VALUE" each; nullptr ends it. On Windows these are as the arguments.
const char* const* environment_variables();

bool is_terminal(int descriptor);

/// Whether it is a terminal that shows colours. NO_COLOR is not looked at.
bool has_colours(int descriptor);

/// Whether it is a terminal that shows UTF-8.
bool shows_utf8(int descriptor);

/// Whether it accepts text now. A stopped terminal does not.
bool is_ready(int descriptor);

/// 0 if it is not a terminal.
std::size_t columns_of(int descriptor);

}  // namespace counterflex::cli
