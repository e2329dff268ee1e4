#pragma once
/// Completion of the command line in shells, made from the options themselves.
#include <string>

namespace CLI {
class App;
}

namespace counterflex::cli {

/// The script of `shell`: bash, zsh or fish. Throws `InputError` (ErrorKind::usage) for another one.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace counterflex::cli
