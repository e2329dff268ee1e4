#pragma once
/// Words and aggregates of KUKA KRL, as spans of the text.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/line.hpp"

namespace counterflex {

inline constexpr std::string_view krl_comment = ";";

/// "X 12.5", "S 2", "CP VEL": a component of an aggregate.
struct KrlComponent {
  std::string name;                   ///< in upper case
  Span span;                          ///< name and value
  Span value;                         ///< without blanks around it
  std::optional<RobotNumber> number;  ///< if the value is a plain number
};

/// "{X 1,Y 2,Z 3}", "{E6POS: X 1,Y 2,Z 3}".
struct KrlAggregate {
  Span span;  ///< with its braces
  std::vector<KrlComponent> components;
};

/// The aggregate that begins at byte `at` of `text` and ends before `end`; empty if it is not one.
std::optional<KrlAggregate> aggregate_at(std::string_view text, std::size_t at, std::size_t end);

/// The component with that name in upper case, or nullptr.
const KrlComponent* find_component(const KrlAggregate& aggregate, std::string_view name);

/// The name at byte `at`: letters, digits, '_' and '$'. Empty without one.
Span name_at(std::string_view text, std::size_t at, std::size_t end);

/// The variable at byte `at`: a name with indices and members, "P[3]", "$VEL.CP". Empty without one.
Span variable_at(std::string_view text, std::size_t at, std::size_t end);

/// Whether the statement of `line` begins a routine: DEF, DEFFCT, GLOBAL DEF.
bool begins_routine(std::string_view text, const RobotLine& line);

/// `text` in upper case without blanks: KRL does not distinguish case.
std::string krl_word(std::string_view text);

}  // namespace counterflex
