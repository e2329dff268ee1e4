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

/// Another value of the frame may be another place.
void assign_frame(TpReading& r, const RobotLine& line, std::string_view statement) {
  const auto target = indexed(statement, "UFRAME[");
  const bool plain = target && target->behind.starts_with("]=");
  const auto pose = plain ? pose_of_register(r, target->behind.substr(2)) : std::nullopt;
  forget_position(r.robot);
  r.robot.state.moved_by_machine = true;
  if (!plain) r.frames.clear();
  if (pose) r.frames.insert_or_assign(target->number, *pose);
  if (pose) return;
  if (plain) r.frames.erase(target->number);
  note_uncorrected(r.robot, line, "UFRAME is computed at run time: its pose is not known");
}

}  // namespace

bool read_tp_assignment(TpReading& r, const RobotLine& line, const std::string& statement) {
  constexpr std::string_view frame_number = "UFRAME_NUM=", tool_number = "UTOOL_NUM=";
  const std::string_view text = statement;
  if (text.starts_with(frame_number)) {
    r.frame = selected(r, text.substr(frame_number.size()));
  } else if (text.starts_with(tool_number)) {
    r.tool = selected(r, text.substr(tool_number.size()));
  } else if (text.starts_with("UFRAME[")) {
    assign_frame(r, line, text);
  } else if (text.starts_with("UTOOL[")) {
    r.last_tool.reset();
    enter_robot_tool(r.robot, 0);
  } else if (text.starts_with("PR[")) {
    assign_register(r, text);
  } else {
    return false;
  }
  return true;
}

ProgramFrame tp_frame(const TpReading& r, long number) {
  ProgramFrame frame{.work_offset = fmt::format("UF {}", number)};
  if (number == 0) frame.pose_mm = Pose{};  // the world frame
  if (const auto found = r.frames.find(number); found != r.frames.end()) frame.pose_mm = found->second;
  return frame;
}

}  // namespace counterflex
