#pragma once
/// Words of Yaskawa INFORM jobs (JBI) and names of positions, as spans of the text.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/line.hpp"

namespace counterflex {

inline constexpr std::string_view jbi_comment = "'";

/// C, BC, EC: positions of the job's steps, of the robot, of its base axes and of a station.
/// P, BP, EX: position variables of the control, in the same order.
enum class JbiFamily : std::uint8_t { robot, base, station, robot_variable, base_variable, station_variable };

inline constexpr std::size_t jbi_step_families = 3;  ///< C, BC, EC

/// Whether `family` is a variable of the control, which other jobs can use too.
inline bool is_variable(JbiFamily family) {
  return static_cast<std::size_t>(family) >= jbi_step_families;
}

/// "C00012": P100 and P00100 are the same position.
struct JbiName {
  JbiFamily family = JbiFamily::robot;
  std::uint32_t number = 0;
  Span span;
  Span digits;
};

/// The name that is the whole of `word`. Empty for "LP000", "P[I000]" and other words.
std::optional<JbiName> jbi_name(std::string_view text, Span word);

/// The words between blanks.
std::vector<Span> jbi_words(std::string_view text, Span code);

/// The names of positions in a statement, also in brackets: "CALL JOB:A (P001)".
std::vector<JbiName> jbi_names(std::string_view text, Span code);

/// `text` in upper case.
std::string jbi_word(std::string_view text);

/// The line at byte `at`, without its number.
RobotLine jbi_line_at(std::string_view text, std::size_t at);

}  // namespace counterflex
