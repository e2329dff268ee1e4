#pragma once
/// Variables of a URScript program, and where their values are.
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "program/robot/ur/lex.hpp"

namespace counterflex {

/// What the statements of a program do with a variable.
struct UrVariable {
  std::vector<Span> values{};  ///< right sides of its assignments, in the order of the text
  std::size_t read = 0;        ///< how often statements have it otherwise
  bool in_body = false;        ///< a function, a thread, a loop or a condition assigns it
  bool by_member = false;      ///< a statement assigns one of its elements
};

using UrFunctions = std::set<std::string, std::less<>>;  ///< names of functions and threads

struct UrNames {
  std::map<std::string, UrVariable, std::less<>> variables;
  /// Functions and threads that the text defines, with the words of the calls in each.
  std::map<std::string, UrFunctions, std::less<>> functions;
  /// Where the text calls a function that it does not define, before the statement that is read. It might
  /// assign variables.
  std::size_t last_unknown_call = 0;
};

/// An assignment: "P1 = p[...]", "global P1 = p[...]", "q[0] = 1".
struct UrAssignment {
  Span variable;
  Span value;
  bool of_member = false;  ///< only an element changes
};

/// The names in the whole `text`.
UrNames ur_names(std::string_view text);

/// The assignment that the statement `code` is; empty if it is another one.
std::optional<UrAssignment> ur_assignment(std::string_view text, Span code);

/// `value`, or its constant: if it is a variable, the right side of its last assignment before it. Variables
/// that a body assigns, or whose elements are assigned, have no constant. Variables with several assignments
/// have none between the call of a function that the text does not define and their next assignment.
Span ur_resolved(std::string_view text, const UrNames& names, Span value);

/// The number of `value` or of its constant; empty if it is computed.
std::optional<double> ur_constant(std::string_view text, const UrNames& names, Span value);

/// Whether `head` begins a function or a thread.
bool ur_begins_function(std::string_view head);

/// Whether a statement that begins with `head` opens a body that `end` closes.
bool ur_opens_body(std::string_view head);

}  // namespace counterflex
