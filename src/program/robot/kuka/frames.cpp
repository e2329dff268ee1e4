// $BASE and $TOOL, and the calls of BAS that select them.
#include <fmt/format.h>

#include <charconv>

#include "program/robot/kuka/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// n of "BASE_DATA[n]" with a plain number; empty for other text. `value` is squeezed.
std::optional<long> index_of(std::string_view value, std::string_view array) {
  if (!value.starts_with(array) || !value.ends_with(']')) return std::nullopt;
  value.remove_prefix(array.size());
  value.remove_suffix(1);
  long index = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), index);
  if (error != std::errc() || end != value.data() + value.size()) return std::nullopt;
  return index;
}

/// The pose of "{X 1,Y 2,Z 3,A 4,B 5,C 6}" (mm); empty if a number is missing or computed.
std::optional<Pose> pose_of(const KrlAggregate& aggregate) {
  const auto target = krl_target(aggregate);
  if (!target) return std::nullopt;
  Pose pose;
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!target->position[i] || !target->orientation[i]) return std::nullopt;
    pose.p[static_cast<Eigen::Index>(i)] = target->position[i]->value;
    numbers[i] = target->orientation[i]->value;
  }
  pose.R = rotation_of(OrientationForm::fixed_axes, numbers);
  return pose;
}

/// The pose that the text gives the variable `name`.
std::optional<Pose> named_pose(const KrlReading& r, std::string_view name) {
  const auto aggregate = named_aggregate(r, name);
  return aggregate ? pose_of(*aggregate) : std::nullopt;
}

ProgramFrame base_of(const KrlReading& r, Span value) {
  const std::string_view text = r.robot.program.text;
  const std::string name = krl_word(part(text, value));
  if (in_body(r)) return {.work_offset = "$BASE"};
  if (name == "$NULLFRAME") return {.work_offset = name, .pose_mm = Pose{}};
  if (index_of(name, "BASE_DATA[")) return {.work_offset = name, .pose_mm = named_pose(r, name)};
  if (const auto aggregate = aggregate_at(text, value.begin, value.end))
    return {.work_offset = "$BASE", .pose_mm = pose_of(*aggregate)};
  return {.work_offset = "$BASE", .pose_mm = named_pose(r, name)};
}

void select_tool(KrlReading& r, const std::string& name, bool is_constant,
                 const std::optional<Pose>& tcp_mm) {
  if (is_constant && r.tool == name) return;
  r.tool = name;
  enter_robot_tool(r.robot, as_tool(index_of(name, "TOOL_DATA[").value_or(0)), tcp_mm);
}

/// The arguments of a call in upper case without blanks: "#CP_PARAMS", "0.2".
std::vector<std::string> arguments_at(std::string_view text, std::size_t at, std::size_t end) {
  std::vector<std::string> arguments;
  at = behind_blanks(text, at, end);
  const std::size_t close = text.rfind(')', end - 1);
  if (at >= end || text[at] != '(' || close == std::string_view::npos || close < at) return arguments;
  for (std::size_t begin = at + 1; begin <= close;) {
    const std::size_t stop = std::min(text.find(',', begin), close);
    arguments.push_back(krl_word(text.substr(begin, stop - begin)));
    begin = stop + 1;
  }
  return arguments;
}

/// The frames of the motion parameters FDAT_ACT: tool and base by number, or by the name of a variable.
void select_frame_data(KrlReading& r) {
  const std::string& data = r.frame_data;
  if (data.empty()) return;
  const auto aggregate = aggregate_at(data, 0, data.size());
  const KrlComponent* tool = aggregate ? find_component(*aggregate, "TOOL_NO") : nullptr;
  const KrlComponent* base = aggregate ? find_component(*aggregate, "BASE_NO") : nullptr;
  const bool numbers = tool != nullptr && base != nullptr && tool->number && base->number;
  const auto number_of = [&](const KrlComponent& c) { return static_cast<long>(c.number->value); };
  const std::string name = numbers ? fmt::format("BASE_DATA[{}]", number_of(*base)) : krl_word(data);
  const std::string tool_name = numbers ? fmt::format("TOOL_DATA[{}]", number_of(*tool)) : krl_word(data);
  select_tool(r, tool_name, true, named_pose(r, tool_name));
  enter_robot_frame(r.robot, {.work_offset = name, .pose_mm = named_pose(r, name)});
}

}  // namespace

void assign_krl_base(KrlReading& r, const RobotLine& line, Span value) {
  const ProgramFrame frame = base_of(r, value);
  const bool computed = frame.work_offset == "$BASE" && !frame.pose_mm;
  // Another value of the same expression may be another frame.
  if (computed) forget_position(r.robot);
  if (computed) note_uncorrected(r.robot, line, "$BASE is computed at run time: its pose is not known");
  enter_robot_frame(r.robot, frame);
}

void assign_krl_tool(KrlReading& r, const RobotLine&, Span value) {
  const std::string_view text = r.robot.program.text;
  const std::string name = krl_word(part(text, value));
  const auto aggregate = aggregate_at(text, value.begin, value.end);
  const std::optional<Pose> numbers = aggregate ? pose_of(*aggregate) : std::nullopt;
  select_tool(r, name, !in_body(r) && (numbers || index_of(name, "TOOL_DATA[")),
              numbers ? numbers : named_pose(r, name));
}

void read_krl_bas(KrlReading& r, const RobotLine& line, std::size_t at) {
  const std::vector<std::string> arguments = arguments_at(r.robot.program.text, at, line.code.end);
  if (arguments.empty()) return;
  const std::string& what = arguments.front();
  const std::string value = arguments.size() > 1 ? arguments[1] : "";
  if (what == "#TOOL") {
    const std::string name = fmt::format("TOOL_DATA[{}]", value);
    select_tool(r, name, !in_body(r), named_pose(r, name));
  }
  if (what == "#BASE") {
    const std::string name = fmt::format("BASE_DATA[{}]", value);
    enter_robot_frame(r.robot, {.work_offset = name, .pose_mm = named_pose(r, name)});
  }
  if (what == "#FRAMES" || what == "#PTP_PARAMS" || what == "#CP_PARAMS") select_frame_data(r);
  if (what == "#VEL_CP" || what == "#CP_PARAMS") {
    const auto speed = number_at(value, 0);
    set_krl_speed(r, speed && speed->span.end == value.size() ? speed->value : 0);
  }
}

}  // namespace counterflex
