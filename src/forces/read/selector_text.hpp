#pragma once
/// Tools, operations and rules as texts in files and messages.
#include <optional>
#include <string>
#include <string_view>

#include "counterflex/forces/forces.hpp"

namespace counterflex {

/// "3", "T3" or "t3"; nothing if the text is not a tool's number of at least 1.
std::optional<long> read_tool(std::string_view text);

/// An operation's text for comparisons: without blanks at the ends, ASCII letters in upper case.
std::string folded(std::string_view operation);

/// "tool T3", "operation 'POCKET*'", "lines 10 to 40": the conditions of a selector.
std::string shown(const ForceSelector& selector);

/// Whether a rule is a section of a file of cutting models; messages show its name.
bool is_section(const ForceRule& rule);

/// The origin of a rule: "forces.csv:6", "section \"slot\" (cuts.toml:9)", or its text on the command line.
std::string place_of(const ForceRule& rule, const Location& where);

/// "places", "operations", "tools" or "the whole program".
std::string_view shown(ForceRank rank);

/// Throws at a rule, or a row of it: ErrorKind::usage for the command line, else ErrorKind::machine_or_force.
[[noreturn]] void fail_rule(const ForceRule& rule, const Location& where, const std::string& message);
[[noreturn]] void fail_rule(const ForceRule& rule, const std::string& message);

}  // namespace counterflex
