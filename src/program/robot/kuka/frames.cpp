// $BASE and $TOOL, and the calls of BAS that select them.
#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "program/robot/kuka/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::string_view computed_frame_data = "FDAT_ACT";  // its values are not known

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

bool has_pose(const ProgramFrame& frame) {
  return frame.work_offset != "$BASE" || frame.pose_mm;
}

/// The pose that the text gives the variable `name`.
std::optional<Pose> named_pose(const KrlReading& r, std::string_view name) {
  const auto aggregate = named_aggregate(r, name);
  return aggregate ? pose_of(*aggregate) : std::nullopt;
}

/// A frame of the control that the program does not change is in the machine file. Base 0 is the world frame.
ProgramFrame numbered_base(const KrlReading& r, const std::string& name) {
  if (index_of(name, "BASE_DATA[") == 0) return {.work_offset = "$NULLFRAME", .pose_mm = Pose{}};
  if (computed_in(r, name)) return {.work_offset = "$BASE"};
  return {.work_offset = name, .pose_mm = named_pose(r, name)};
}

ProgramFrame base_of(const KrlReading& r, Span value) {
  const std::string_view text = r.robot.program.text;
  const std::string name = krl_word(part(text, value));
  if (name == "$NULLFRAME") return {.work_offset = name, .pose_mm = Pose{}};
  if (index_of(name, "BASE_DATA[")) return numbered_base(r, name);
  const auto aggregate = aggregate_at(text, value.begin, value.end);
  if (!aggregate) return {.work_offset = "$BASE", .pose_mm = named_pose(r, name)};
  const bool is_whole = aggregate->span.end == value.end;  // not {...}:{...}
  return {.work_offset = "$BASE", .pose_mm = is_whole ? pose_of(*aggregate) : std::nullopt};
}

/// Which frame a loop or a condition selects is not known behind it, unless it is the one before.
void select_frame(KrlReading& r, const RobotLine& line, const ProgramFrame& frame) {
  const bool is_same = r.robot.program.frames[r.robot.state.frame] == frame;
  if (!has_pose(frame) || (in_body(r) && !is_same)) return forget_krl_base(r, line);
  enter_robot_frame(r.robot, frame);
}

void select_tool(KrlReading& r, const RobotLine& line, const std::string& name, bool is_constant,
                 const std::optional<Pose>& tcp_mm) {
  if (is_constant && r.tool == name && r.lost_tool == 0) return;
  r.lost_tool = in_body(r) && r.tool != name ? line.line : 0;
  r.tool = name;
  enter_robot_tool(r.robot, as_tool(index_of(name, "TOOL_DATA[").value_or(0)), tcp_mm);
}

void select_numbered_tool(KrlReading& r, const RobotLine& line, const std::string& name) {
  select_tool(r, line, name, !computed_in(r, name), named_pose(r, name));
  if (computed_in(r, name)) r.lost_tool = line.line;
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

/// The motion parameters of the right side of an assignment: an aggregate, or the name of one.
std::optional<KrlAggregate> data_of(const KrlReading& r, const std::string& data) {
  if (auto aggregate = aggregate_at(data, 0, data.size())) return aggregate;
  return named_aggregate(r, krl_word(data));
}

/// The text that has the spans of `data_of`.
std::string_view text_of(const KrlReading& r, const std::string& data) {
  return data.starts_with('{') ? std::string_view(data) : r.robot.program.text;
}

/// The frames of the motion parameters FDAT_ACT: tool and base by number, or by the name of a variable.
void select_frame_data(KrlReading& r, const RobotLine& line) {
  const std::string& data = r.frame_data;
  if (data.empty()) return;
  const auto aggregate = data_of(r, data);
  const KrlComponent* tool = aggregate ? find_component(*aggregate, "TOOL_NO") : nullptr;
  const KrlComponent* base = aggregate ? find_component(*aggregate, "BASE_NO") : nullptr;
  const KrlComponent* mode = aggregate ? find_component(*aggregate, "IPO_FRAME") : nullptr;
  if (mode != nullptr && krl_word(part(text_of(r, data), mode->value)) == "#TCP")
    refuse_krl_fixed_tool(r, line, line.code.begin, "IPO_FRAME");
  const auto name_in = [&](std::string_view array, const KrlComponent* number) {
    if (number != nullptr && number->number)
      return fmt::format("{}[{}]", array, static_cast<long>(number->number->value));
    return aggregate || data == computed_frame_data ? std::string() : krl_word(data);
  };
  const std::string tool_name = name_in("TOOL_DATA", tool), base_name = name_in("BASE_DATA", base);
  if (tool_name.empty())
    r.lost_tool = line.line;
  else
    select_numbered_tool(r, line, tool_name);
  if (base_name.empty()) return forget_krl_base(r, line);
  select_frame(r, line, numbered_base(r, base_name));
}

/// ORI_TYP of the motion parameters LDAT_ACT, as BAS copies it to $ORI_TYPE.
void take_line_data(KrlReading& r) {
  const auto aggregate = data_of(r, r.line_data);
  const KrlComponent* type = aggregate ? find_component(*aggregate, "ORI_TYP") : nullptr;
  if (type == nullptr) return;
  set_krl_orientation_type(r, krl_word(part(text_of(r, r.line_data), type->value)));
}

}  // namespace

// Another value of the same expression may be another frame.
void forget_krl_base(KrlReading& r, const RobotLine& line) {
  forget_position(r.robot);
  if (std::exchange(r.computed_base_line, line.line) != line.line) ++r.computed_bases;
  const std::string name = fmt::format("$BASE {}", r.computed_bases);
  note_uncorrected(
      r.robot, line,
      fmt::format("$BASE is computed at run time: its pose is not in the program, state it as [work.\"{}\"]",
                  name));
  enter_robot_frame(r.robot, {.work_offset = name});
}

void refuse_krl_fixed_tool(const KrlReading& r, const RobotLine& line, std::size_t at,
                           std::string_view variable) {
  refuse(r.robot.program.file, line, at,
         fmt::format("{0}=#TCP moves the workpiece to a fixed tool, which is not supported; use {0}=#BASE",
                     variable));
}

void assign_krl_base(KrlReading& r, const RobotLine& line, Span value) {
  select_frame(r, line, base_of(r, value));
}

void assign_krl_frame_data(KrlReading& r, Span value) {
  r.frame_data = in_body(r) ? computed_frame_data : part(r.robot.program.text, value);
}

void assign_krl_frame_member(KrlReading& r, std::string_view member, std::string_view value) {
  const bool selects = member == "TOOL_NO" || member == "BASE_NO" || member == "IPO_FRAME";
  const auto aggregate = data_of(r, r.frame_data);
  const KrlComponent* const found = aggregate ? find_component(*aggregate, member) : nullptr;
  if (!selects || (found == nullptr && value == "#BASE")) return;
  if (found == nullptr || in_body(r) || (member == "IPO_FRAME" && value != "#BASE")) {
    r.frame_data = computed_frame_data;
    return;
  }
  const std::string_view text = text_of(r, r.frame_data);
  r.frame_data = fmt::format("{}{}{}", part(text, {aggregate->span.begin, found->value.begin}), value,
                             part(text, {found->value.end, aggregate->span.end}));
}

void assign_krl_tool(KrlReading& r, const RobotLine& line, Span value) {
  const std::string_view text = r.robot.program.text;
  const std::string name = krl_word(part(text, value));
  if (index_of(name, "TOOL_DATA[")) return select_numbered_tool(r, line, name);
  const auto aggregate = aggregate_at(text, value.begin, value.end);
  const bool is_whole = aggregate && aggregate->span.end == value.end;
  const std::optional<Pose> numbers = is_whole ? pose_of(*aggregate) : std::nullopt;
  select_tool(r, line, name, numbers.has_value(), numbers ? numbers : named_pose(r, name));
}

void read_krl_bas(KrlReading& r, const RobotLine& line, std::size_t at) {
  const std::vector<std::string> arguments = arguments_at(r.robot.program.text, at, line.code.end);
  if (arguments.empty()) return;
  const std::string& what = arguments.front();
  const std::string value = arguments.size() > 1 ? arguments[1] : "";
  if (what == "#TOOL") select_numbered_tool(r, line, fmt::format("TOOL_DATA[{}]", value));
  if (what == "#BASE") select_frame(r, line, numbered_base(r, fmt::format("BASE_DATA[{}]", value)));
  const bool is_computed = !what.starts_with('#');
  if (what == "#EX_BASE" || is_computed)
    forget_krl_base(r, line);  // the base is on an external kinematic system
  if (is_computed) r.lost_tool = line.line;
  if (what == "#FRAMES" || what == "#PTP_PARAMS" || what == "#CP_PARAMS") select_frame_data(r, line);
  if (what == "#CP_PARAMS" || what == "#CP_DAT") take_line_data(r);
  if (what == "#VEL_CP" || what == "#CP_PARAMS") {
    const auto speed = number_at(value, 0);
    set_krl_speed(r, speed && speed->span.end == value.size() ? speed->value : 0);
  }
}

}  // namespace counterflex
