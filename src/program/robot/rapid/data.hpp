#pragma once
/// Values of RAPID data in motions: targets, speeds, zones, tools, work objects.
#include "counterflex/program/read_program.hpp"
#include "program/robot/rapid/module.hpp"

namespace counterflex {

/// Where a statement looks for names.
struct RapidPlace {
  std::string_view text;
  const RapidModule& module;
  std::size_t at;  ///< of the statement
};

/// The target of a motion. Without `why` its numbers are known.
struct RapidOperand {
  enum class Form { list, name, derived };
  Form form = Form::derived;
  Span span;                  ///< in the statement
  Span numbers;               ///< the list that has the numbers: in the statement or in a declaration
  std::string configuration;  ///< confdata without blanks
  RobotTarget target;         ///< the position of a derived target is that of Offs or RelTool
  std::string why;            ///< why it is not followed
  bool malformed = false;     ///< `numbers` is not a target
};
RapidOperand rapid_operand(const RapidPlace& place, Span span);

/// Offs or RelTool with a target and three numbers or expressions.
struct RapidDisplacement {
  std::vector<Span> arguments;  ///< empty: another target
  bool in_tool = false;         ///< RelTool
};
RapidDisplacement rapid_displacement(std::string_view text, Span span);

/// The place of a jointtarget; empty if its numbers are not known.
std::optional<JointPlace> rapid_joints(const RapidPlace& place, Span span);

/// Speed of the tool centre point of a speeddata (mm/min); 0 if it is not known.
double rapid_speed(const RapidPlace& place, Span span);

struct RapidZone {
  bool passes = false;  ///< the robot does not stop at the target; false for an unknown zone
  double radius_mm = 0;
};
RapidZone rapid_zone(const RapidPlace& place, Span span);

/// The largest predefined zone with at most that radius. Below z0: a list of zonedata in the proportions of
/// z0.
std::string rapid_zone_within(double radius_mm);

/// A tool or a work object.
struct RapidFrame {
  std::string name;
  std::optional<Pose> pose_mm{};  ///< empty if the module does not give it with numbers
  std::optional<bool> held{};     ///< by the robot, if the module states it
  std::string why;                ///< why moves with it are not followed
};
RapidFrame rapid_tool(const RapidPlace& place, Span span);

/// `span` is empty for wobj0.
RapidFrame rapid_work_object(const RapidPlace& place, Span span);

}  // namespace counterflex
