// Targets of steps: the numbers, the frame and the tool of a position.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/robot/yaskawa/read.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {
namespace {

constexpr std::size_t pose_numbers = 6;
/// Where external axes are among those of a target: the rail, the station, and further axes of the arm.
constexpr std::size_t first_base = 0, first_station = 3, first_further = 5;

const JbiPosition& position_of(const JbiReading& r, const RobotLine& line, const JbiName& name) {
  if (const JbiPosition* position = r.job->positions.find(name.family, name.number)) return *position;
  refuse(r.robot.program.file, line, name.span.begin,
         fmt::format("the position '{}' has no values above //INST; give it a line there",
                     part(r.robot.program.text, name.span)));
}

std::vector<RobotNumber> numbers_of(const JbiReading& r, const JbiPosition& position) {
  const auto values = jbi_values(r.robot.program.text, position.line_begin);
  return values ? values->numbers : std::vector<RobotNumber>{};
}

/// Adds the axes of BC or EC as external axes `first` to `end - 1`. False if there are more.
bool add_external(const JbiReading& r, const RobotLine& line, const std::optional<JbiName>& name,
                  std::size_t first, std::size_t end, JbiTarget& target) {
  if (!name) return true;
  const auto numbers = numbers_of(r, position_of(r, line, *name));
  for (std::size_t i = 0; i < numbers.size() && first + i < end; ++i)
    target.numbers.external[first + i] = numbers[i].value;
  return numbers.size() <= end - first;
}

/// Why the values of a position variable are not those that the robot moves to.
std::string why_variable_is_unknown(const JbiReading& r, const JbiPosition* position, std::string_view name) {
  if (position == nullptr) return fmt::format("the position variable '{}' is not in this file", name);
  if (position->computed) return fmt::format("the position variable '{}' is changed at run time", name);
  if (r.call_line > 0)
    return fmt::format("the call in line {} may change the position variable '{}'", r.call_line, name);
  return {};
}

std::string why_frame_is_unknown(const JbiReading& r, const JbiSection& section) {
  if (!section.unknown.empty())
    return fmt::format("its position is below ///{}, which is not supported", section.unknown);
  if (section.type == "TOOL" || section.type == "MTOOL" || section.type == "MASTER")
    return fmt::format("its position has the type {}, which moves with the robot or a station", section.type);
  const auto& computed = r.job->computed_users;
  if (section.type == "USER" && (computed.contains(*section.user) || computed.contains(-1)))
    return fmt::format("MFRAME changes the user coordinate system {} at run time", *section.user);
  return {};
}

/// BASE is the frame of the robot without its rail; ROBOT moves on the rail. They are one frame while the
/// rail is at zero.
ProgramFrame frame_of(const JbiSection& section, const RobotTarget& target) {
  if (section.type == "USER") return {.work_offset = fmt::format("USER {}", *section.user)};
  const auto rail = target.external.begin() + first_base;
  const bool at_zero = std::all_of(rail, rail + (first_station - first_base),
                                   [](const auto& value) { return value.value_or(0) == 0; });
  if (section.type == "ROBOT" && !at_zero) return {.work_offset = "ROBOT"};
  return {.work_offset = "BASE", .pose_mm = Pose{}};
}

void set_pose(const std::vector<RobotNumber>& numbers, JbiTarget& target) {
  for (std::size_t i = 0; i < 3; ++i) {
    target.numbers.position[i] = numbers[i];
    target.numbers.orientation[i] = numbers[3 + i];
  }
  for (std::size_t i = pose_numbers; i < numbers.size(); ++i)
    if (const std::size_t axis = first_further + i - pose_numbers; axis < target.numbers.external.size())
      target.numbers.external[axis] = numbers[i].value;
}

}  // namespace

JbiTarget jbi_target(const JbiReading& r, const RobotLine& line, const JbiMotion& motion) {
  JbiTarget target;
  if (!motion.target) {
    target.why = fmt::format("the target '{}' is set at run time", motion.computed_target);
    return target;
  }
  const JbiName& name = *motion.target;
  const std::string_view text = part(r.robot.program.text, name.span);
  const JbiPosition* position = r.job->positions.find(name.family, name.number);
  if (is_variable(name.family))
    target.why = why_variable_is_unknown(r, position, text);
  else
    position = &position_of(r, line, name);
  if (position == nullptr) return target;
  target.position = static_cast<std::size_t>(position - r.job->positions.list.data());
  const JbiSection& section = r.job->positions.sections[position->section];
  target.tool = section.tool.value_or(0);
  target.is_pulse = !section.rectangular;
  const bool all_stated = add_external(r, line, motion.base, first_base, first_station, target) &&
                          add_external(r, line, motion.station, first_station, first_further, target);
  if (!all_stated && target.why.empty()) target.why = "its base or station has more axes than are supported";
  if (target.is_pulse) return target;
  if (target.why.empty()) target.why = why_frame_is_unknown(r, section);
  const std::vector<RobotNumber> numbers = numbers_of(r, *position);
  if (numbers.size() > pose_numbers + 1 && target.why.empty())
    target.why = "its position has more axes than are supported";
  if (!target.why.empty()) return target;
  set_pose(numbers, target);
  target.frame = frame_of(section, target.numbers);
  return target;
}

std::vector<Span> jbi_counts(const JbiReading& r) {
  const std::string_view text = r.robot.program.text;
  std::vector<Span> counts;
  if (!r.job) return counts;
  for (std::size_t i = 0; i < jbi_step_families && i < r.job->positions.counts.size(); ++i)
    counts.push_back(r.job->positions.counts[i]);
  for (std::size_t i = 0; i < r.job->positions.list.size(); ++i) {
    const JbiPosition& position = r.job->positions.list[i];
    if (is_variable(position.family)) continue;
    const RobotLine line = jbi_line_at(text, position.line_begin);
    const bool by_moves_alone = r.followed[i] == position.uses && !position.used_otherwise;
    if (r.followed[i] > 0 && by_moves_alone)
      counts.push_back(line.span);
    else if (const auto values = jbi_values(text, position.line_begin))
      counts.push_back(values->name.digits);
  }
  counts.insert(counts.end(), r.numbers.begin(), r.numbers.end());
  std::stable_sort(counts.begin(), counts.end(), [](Span a, Span b) { return a.begin < b.begin; });
  return counts;
}

}  // namespace counterflex
