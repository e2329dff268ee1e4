#pragma once
/// The text of --help: groups of options, examples, lines of the terminal's width.
#include <memory>
#include <string>
#include <string_view>

namespace CLI {
class FormatterBase;
}

namespace counterflex::cli {

/// The groups of options, in the order in which they are shown.
namespace group {
inline constexpr std::string_view common = "Common options", forces = "Cutting forces",
                                  reading = "Reading the program", correction = "Correction",
                                  output = "Output", settings = "Settings";
}

/// Shows the footer of a command, which has its examples, after its usage line.
std::shared_ptr<CLI::FormatterBase> help_formatter();

/// What `counterflex` prints without arguments.
std::string short_usage();

}  // namespace counterflex::cli
