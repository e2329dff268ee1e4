#pragma once
/// Targets that a KRL program gives names: "P1 = {X 1, Y 2, Z 3, A 0, B 0, C 0}".
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "program/robot/kuka/lex.hpp"

namespace counterflex {

/// An assignment: its variable, and its value up to the end of the statement.
struct KrlAssignment {
  Span variable, value;
};

/// Whether a statement that begins with `head` (upper case) declares variables: DECL, a type.
bool begins_declaration(std::string_view head);

/// The assignment that begins at byte `at`; empty for other text.
std::optional<KrlAssignment> assignment_at(std::string_view text, std::size_t at, std::size_t end);

/// The assignment of a statement, also behind the words of a declaration: "DECL E6POS P1 = {X 1}".
std::optional<KrlAssignment> assignment_in(std::string_view text, Span code);

/// Whether a line of `lines` gives a target, also in joint values, or a frame a name, so that moves may
/// depend on lines far before them.
bool names_targets(std::string_view lines);

/// How often the statements of `text` have each variable: "P1", "P[3]", without members. Declarations without
/// a value do not count.
std::map<std::string, std::size_t, std::less<>> uses_of_names(std::string_view text);

}  // namespace counterflex
