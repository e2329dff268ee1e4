#pragma once
/// Declares the commands and their options to CLI11.
#include "settings/options.hpp"

namespace CLI {
class App;
}

namespace counterflex::cli {

/// When `app` parses a command line, flags of settings go to `Options::sources` unchanged, and other values
/// to their members of `options`.
void add_commands(CLI::App& app, Options& options);

}  // namespace counterflex::cli
