#include "program/robot/ur/still_functions.hpp"

#include <algorithm>
#include <array>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Functions of the control that do not move the robot.
constexpr auto motionless_calls = std::to_array<std::string_view>({
    "sleep",
    "sync",
    "textmsg",
    "popup",
    "stopj",
    "stopl",
    "set_digital_out",
    "set_standard_digital_out",
    "set_configurable_digital_out",
    "set_tool_digital_out",
    "set_analog_out",
    "set_standard_analog_out",
    "set_tool_voltage",
    "set_payload",
    "set_payload_mass",
    "set_payload_cog",
    "set_target_payload",
    "set_gravity",
    "set_flag",
    "set_runstate_outputs",
    "set_analog_inputrange",
    "set_analog_outputdomain",
    "set_tool_communication",
    "set_tool_output_mode",
    "set_tool_digital_output_mode",
    "set_standard_analog_input_domain",
    "set_tool_analog_input_domain",
    "set_standard_digital_input_action",
    "set_tool_digital_input_action",
    "set_configurable_digital_input_action",
    "set_gp_boolean_input_action",
    "set_input_actions_to_default",
    "zero_ftsensor",
    "end_force_mode",
    "stop_conveyor_tracking",
    "path_offset_disable",
    "path_offset_get",
    "end_freedrive_mode",
    "end_teach_mode",
    "end_screw_driving",
    "set_conveyor_tick_count",
    "conveyor_pulse_decode",
    "position_deviation_warning",
    "tool_contact",
});
constexpr auto motionless_prefixes =
    std::to_array<std::string_view>({"get_", "is_", "read_", "write_", "socket_", "modbus_", "rtde_", "rpc_",
                                     "str_", "to_", "encoder_", "request_", "set_runstate_"});
/// Functions that only compute a value from their arguments: the same, module urmath. A point begins methods
/// of lists.
constexpr auto computing = std::to_array<std::string_view>({
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sqrt",
    "pow",
    "exp",
    "log",
    "floor",
    "ceil",
    "norm",
    "normalize",
    "inv",
    "transpose",
    "d2r",
    "r2d",
    "length",
    "size",
    "force",
    "random",
    "time",
    "struct",
    "point_dist",
    "pose_dist",
    "pose_inv",
    "pose_add",
    "pose_sub",
    "pose_trans",
    "wrench_trans",
    "interpolate_pose",
    "rotvec2rpy",
    "rpy2rotvec",
    "binary_list_to_integer",
    "integer_to_binary_list",
    "make_list",
    ".append",
    ".capacity",
    ".clear",
    ".exclude",
    ".extend",
    ".insert",
    ".length",
    ".pop",
    ".remove",
    ".slice",
    ".to_string",
});
/// Words before a bracket that are not functions.
constexpr auto operators = std::to_array<std::string_view>(
    {"if", "elif", "while", "for", "in", "switch", "case", "return", "not", "and", "or", "xor", "run"});

}  // namespace

bool is_ur_motionless_call(std::string_view name) {
  const auto has = [&](const auto& list) { return std::ranges::find(list, name) != list.end(); };
  return has(motionless_calls) || has(computing) || has(operators) ||
         std::ranges::any_of(motionless_prefixes,
                             [&](std::string_view prefix) { return name.starts_with(prefix); });
}

UrFunctions ur_still_functions(const UrNames& names, const CallNames& harmless) {
  UrFunctions still;
  for (const auto& entry : names.functions) still.insert(entry.first);
  const auto moves = [&](const std::string& called) {
    if (names.functions.contains(called)) return !still.contains(called);
    return !is_ur_motionless_call(called) && !harmless.contains(upper_case(called));
  };
  const auto calls_motion = [&](const std::string& function) {
    return std::ranges::any_of(names.functions.find(function)->second, moves);
  };
  while (std::erase_if(still, calls_motion) > 0) {
  }
  return still;
}

}  // namespace counterflex
