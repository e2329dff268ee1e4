#pragma once
/// Tokens, names and list literals of ABB RAPID, as spans of the text.
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/line.hpp"
#include "program/robot/target.hpp"

namespace counterflex {

inline constexpr std::string_view rapid_comment = "!";

enum class RapidTokenKind { none, name, number, string, assign, symbol };

/// A name, a number, a string in quotes, ":=", or one other character.
struct RapidToken {
  RapidTokenKind kind = RapidTokenKind::none;  ///< none: at the end of the text
  Span span;
};

/// The first token from byte `at` on, behind blanks, line ends and comments.
RapidToken rapid_token_at(std::string_view text, std::size_t at, std::size_t end);

/// `text` in upper case without blanks: RAPID does not distinguish case.
std::string rapid_word(std::string_view text);

/// Whether `token` is the character `symbol`.
bool is_symbol(std::string_view text, const RapidToken& token, char symbol);

/// The variable at byte `at`: a name with indices and members, "p{3}", "p1.trans.x". Empty without one.
Span rapid_variable_at(std::string_view text, std::size_t at, std::size_t end);

/// A list literal, "[[1,2,3],[1,0,0,0]]", or a value in one.
struct RapidList {
  Span span;
  bool is_list = false;  ///< else a value
  std::vector<RapidList> items{};
};

/// The list that begins at byte `at` and ends before `end`; empty if there is no closed list.
std::optional<RapidList> rapid_list_at(std::string_view text, std::size_t at, std::size_t end);

/// Whether `list` has lists of 3, 4, 4 and 6 values: position, quaternion, configuration, external axes.
bool is_robtarget(const RapidList& list);

/// The numbers of a target with the form of `is_robtarget`. Empty if one of them is not a plain number.
std::optional<RobotTarget> rapid_target(std::string_view text, const RapidList& list);

/// Values of external axes from there on (9E9) mean that there is no such axis.
constexpr double rapid_not_connected = 9e8;

/// The parts of `span` between commas that are outside of brackets, without blanks around them.
std::vector<Span> rapid_arguments(std::string_view text, Span span);

/// `text` in one line: without line ends, the blanks after them, and comments.
std::string in_one_line(std::string_view text);

}  // namespace counterflex
