#pragma once
/// The commands and their options, as the library for command lines is told of them.
#include "settings/options.hpp"

namespace CLI {
class App;
}

namespace counterflex::cli {

/// What is said when `app` parses a command line goes to `options`: flags of settings as they are, to
/// `Options::sources`, all else to its place.
void add_commands(CLI::App& app, Options& options);

}  // namespace counterflex::cli
