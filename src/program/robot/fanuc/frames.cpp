// Frames and tools of FANUC TP, and the position registers that set them.
#include <fmt/format.h>

#include "program/robot/fanuc/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// The number that is the whole of `text`, also in parentheses: "(-5)".
std::optional<double> plain_number(std::string_view text) {
  if (text.starts_with('(') && text.ends_with(')')) text = text.substr(1, text.size() - 2);
  const auto number = number_at(text, 0);
  return number && number->span.end == text.size() ? std::optional(number->value) : std::nullopt;
}

/// n of "UFRAME[n]=..." and what is behind it.
struct Indexed {
  long number;
  std::string_view behind;
};
std::optional<Indexed> indexed(std::string_view statement, std::string_view array) {
  if (!statement.starts_with(array)) return std::nullopt;
  const auto number = tp_integer(statement, array.size());
  return number ? std::optional(Indexed{number->value, statement.substr(number->end)}) : std::nullopt;
}

/// The selected number of "UFRAME_NUM=n".
std::optional<long> selected(const TpReading& r, std::string_view value) {
  const auto number = tp_integer(value, 0);
  const bool plain = number && number->end == value.size() && r.robot.open_bodies == 0;
  return plain ? std::optional(number->value) : std::nullopt;
}

/// PR[n,i]=number is known; any other assignment makes the register unknown.
void assign_register(TpReading& r, std::string_view statement) {
  const auto target = indexed(statement, "PR[");
  if (!target) return r.registers.clear();
  const auto element = indexed(target->behind, ",");
  const bool known_element = element && element->number >= 1 && element->number <= 6;
  if (!known_element || !element->behind.starts_with("]=") || r.robot.open_bodies > 0) {
    r.registers.erase(target->number);
    return;
  }
  r.registers[target->number][static_cast<std::size_t>(element->number - 1)] =
      plain_number(element->behind.substr(2));
}

/// The pose of a register whose six numbers are known (mm, deg).
std::optional<Pose> pose_of_register(const TpReading& r, std::string_view value) {
  const auto source = indexed(value, "PR[");
  if (!source || source->behind != "]" || r.robot.open_bodies > 0) return std::nullopt;
  const auto found = r.registers.find(source->number);
  if (found == r.registers.end()) return std::nullopt;
  Pose pose;
  OrientationNumbers angles{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!found->second[i] || !found->second[i + 3]) return std::nullopt;
    pose.p[static_cast<Eigen::Index>(i)] = *found->second[i];
    angles[i] = *found->second[i + 3];
  }
  pose.R = rotation_of(OrientationForm::fixed_axes, angles);
  return pose;
}

void forget_frame(TpReading& r, std::optional<long> number, int line) {
  if (number) {
    r.frames[*number] = {.line = line};
  } else {
    r.frames.clear();
    r.any_frame_in = line;
  }
}

/// Another value of the frame may be another place.
void assign_frame(TpReading& r, const RobotLine& line, std::string_view statement) {
  const auto target = indexed(statement, "UFRAME[");
  const bool plain = target && target->behind.starts_with("]=");
  const auto pose = plain ? pose_of_register(r, target->behind.substr(2)) : std::nullopt;
  forget_position(r.robot);
  r.robot.state.moved_by_machine = true;
  if (pose) {
    r.frames[target->number] = {.pose_mm = pose};
    return;
  }
  forget_frame(r, plain ? std::optional(target->number) : std::nullopt, line.line);
  note_uncorrected(r.robot, line, "UFRAME is computed at run time: its pose is not known");
}

/// Selects a frame by UFRAME_NUM; empty for an unknown one.
void select_frame(TpReading& r, std::optional<long> number) {
  r.frame = number;
  r.selects_no_frame = false;
}

/// Another value of a tool moves its centre.
void assign_tool(TpReading& r) {
  r.last_tool.reset();
  enter_robot_tool(r.robot, 0);
}

/// $MNUFRAMENUM[1], $MNUFRAME[1,2], $MNUTOOLNUM[1], ...: false for other variables of the control.
bool assign_variable(TpReading& r, const RobotLine& line, std::string_view statement) {
  const std::string_view variable = statement.substr(0, statement.find('='));
  const auto contains = [&](std::string_view name) { return variable.find(name) != std::string_view::npos; };
  if (contains("UFRAMENUM"))
    select_frame(r, std::nullopt);
  else if (contains("UFRAME"))
    assign_frame(r, line, statement);
  else if (contains("UTOOLNUM"))
    r.tool.reset();
  else if (contains("UTOOL"))
    assign_tool(r);
  else
    return false;
  return true;
}

}  // namespace

bool read_tp_assignment(TpReading& r, const RobotLine& line, const std::string& statement) {
  constexpr std::string_view frame_number = "UFRAME_NUM=", tool_number = "UTOOL_NUM=";
  const std::string_view text = statement;
  if (text.starts_with(frame_number)) {
    select_frame(r, selected(r, text.substr(frame_number.size())));
  } else if (text.starts_with(tool_number)) {
    r.tool = selected(r, text.substr(tool_number.size()));
  } else if (text.starts_with("UFRAME[")) {
    assign_frame(r, line, text);
  } else if (text.starts_with("UTOOL[")) {
    assign_tool(r);
  } else if (text.starts_with("PR[")) {
    assign_register(r, text);
  } else if (text.starts_with("$")) {
    return assign_variable(r, line, text);
  } else {
    return false;
  }
  return true;
}

ProgramFrame tp_frame(const TpReading& r, std::optional<long> number) {
  if (!number) number = r.frame;
  if (!number) return {};
  ProgramFrame frame{.work_offset = fmt::format("UF {}", *number)};
  const auto found = r.frames.find(*number);
  if (*number == 0)
    frame.pose_mm = Pose{};  // the world frame
  else if (found != r.frames.end())
    frame.pose_mm = found->second.pose_mm;
  return frame;
}

std::string why_unknown_frame(const TpReading& r, std::optional<long> number) {
  if (!number) number = r.frame;
  if (!number && r.selects_no_frame) return {};
  if (!number)
    return "UF : F is the selected frame, which is not known; program UFRAME_NUM=1 or another number before "
           "the motion, behind calls and labels";
  const auto found = r.frames.find(*number);
  if (*number == 0 || (found != r.frames.end() && found->second.pose_mm)) return {};
  const int line = found != r.frames.end() ? found->second.line : r.any_frame_in;
  return line > 0 ? fmt::format("UFRAME[{}] may be set at run time in line {}", *number, line) : "";
}

void forget_tp_frames(TpReading& r, int line) {
  for (auto& entry : r.frames)
    if (entry.second.pose_mm) entry.second = {.line = line};
}

void forget_tp_frames_at_label(TpReading& r, int line) {
  const int jump = r.file.first_jump;
  for (const auto& [number, last] : r.file.frames)
    if (last > line || (jump > 0 && jump < last)) forget_frame(r, number, last);
  if (r.file.last_call > line) forget_tp_frames(r, r.file.last_call);
}

}  // namespace counterflex
