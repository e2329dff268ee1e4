#pragma once
/// Calls, poses and names of URScript, as spans of the text.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/line.hpp"

namespace counterflex {

inline constexpr std::string_view ur_comment = "#";
inline constexpr double ur_length_mm = mm_per(LengthUnit::metres);  ///< of the unit of length

/// "0.5", "v=0.25": an argument of a call.
struct UrArgument {
  Span name;   ///< empty for a positional argument
  Span value;  ///< without blanks around it
  Span span;   ///< name and value
};

/// "movel(p[...], a=1.2, v=0.25)".
struct UrCall {
  Span name;
  Span span;
  std::vector<UrArgument> arguments;
};

using UrNumbers = std::array<RobotNumber, 6>;

/// "p[x,y,z,rx,ry,rz]" with plain numbers (m, rad).
struct UrPose {
  Span span;
  UrNumbers numbers;
};

/// The call that begins at byte `at` of `text` and ends before `end`; empty if it is not one.
std::optional<UrCall> ur_call_at(std::string_view text, std::size_t at, std::size_t end);

/// The call of the motion in the line that begins at byte `begin`.
std::optional<UrCall> ur_call_in_line(std::string_view text, std::size_t begin);

/// The numbers of "[a,b,c,d,e,f]", joint values; empty for other text, and if a number is computed.
std::optional<UrNumbers> ur_list(std::string_view text, Span value);

/// The pose that `value` is; empty if it is not one, or if a number is computed.
std::optional<UrPose> ur_pose(std::string_view text, Span value);

/// The number that `value` is; empty if it is not a plain one.
std::optional<RobotNumber> ur_number(std::string_view text, Span value);

/// The name at byte `at`: letters, digits and '_'. Empty without one.
Span ur_name_at(std::string_view text, std::size_t at, std::size_t end);

/// Calls `visit` with the span of each name in `code`, but not with those in strings.
template <typename Visit>
void visit_ur_names(std::string_view text, Span code, const Visit& visit) {
  bool quoted = false;
  for (std::size_t at = code.begin; at < code.end;) {
    if (text[at] == '"') quoted = !quoted;
    const Span name = ur_name_at(text, at, code.end);
    at = std::max(at + 1, name.end);
    if (name.end > name.begin && !quoted) visit(name);
  }
}

/// The name of a call in an expression or a statement.
struct UrCallName {
  Span name;         ///< with its object: "server.next" of "server.next(3)"
  std::string word;  ///< "sin"; ".next" of a method
};

/// The calls in `code`, but not those in strings.
std::vector<UrCallName> ur_calls(std::string_view text, Span code);

/// The byte in the expression `value` at which another statement begins: an operand behind an operand. Empty
/// without one.
std::optional<std::size_t> ur_second_statement(std::string_view text, Span value);

/// The pose or the name in a target: of "P1", "pose_trans(plane, P1)" and "get_inverse_kin(P1, qnear=Q1)" it
/// is "P1".
Span ur_operand(std::string_view text, Span value);

/// The argument `name` of movej, movel, movep or movec, by name or by position; null without it.
const UrArgument* ur_argument(std::string_view text, const UrCall& call, std::string_view name);

}  // namespace counterflex
