#include "program/robot/ur/still_functions.hpp"

#include <algorithm>
#include <array>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto motionless_calls = std::to_array<std::string_view>({"sleep",
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
                                                                   "zero_ftsensor",
                                                                   "end_force_mode",
                                                                   "stop_conveyor_tracking",
                                                                   "path_offset_disable",
                                                                   "end_freedrive_mode",
                                                                   "end_teach_mode",
                                                                   "set_conveyor_tick_count"});
constexpr auto motionless_prefixes = std::to_array<std::string_view>(
    {"get_", "is_", "read_", "write_", "socket_", "modbus_", "rtde_", "rpc_", "str_", "to_"});
/// Functions that only compute a value from their arguments.
constexpr auto computing = std::to_array<std::string_view>({"sin",        "cos",        "tan",
                                                            "asin",       "acos",       "atan",
                                                            "atan2",      "sqrt",       "pow",
                                                            "exp",        "log",        "floor",
                                                            "ceil",       "norm",       "d2r",
                                                            "r2d",        "length",     "size",
                                                            "force",      "random",     "point_dist",
                                                            "pose_dist",  "pose_inv",   "pose_add",
                                                            "pose_sub",   "pose_trans", "interpolate_pose",
                                                            "rotvec2rpy", "rpy2rotvec"});
/// Words before a bracket that are not functions.
constexpr auto operators = std::to_array<std::string_view>(
    {"if", "elif", "while", "for", "in", "switch", "case", "return", "not", "and", "or", "xor"});

}  // namespace

bool is_ur_motionless_call(std::string_view name) {
  return std::ranges::find(motionless_calls, name) != motionless_calls.end() ||
         std::ranges::any_of(motionless_prefixes,
                             [&](std::string_view prefix) { return name.starts_with(prefix); });
}

UrFunctions ur_still_functions(const UrNames& names, const CallNames& harmless) {
  UrFunctions still;
  for (const auto& entry : names.functions) still.insert(entry.first);
  const auto moves = [&](const std::string& called) {
    if (names.functions.contains(called)) return !still.contains(called);
    return std::ranges::find(computing, called) == computing.end() &&
           std::ranges::find(operators, called) == operators.end() && !is_ur_motionless_call(called) &&
           !harmless.contains(upper_case(called));
  };
  const auto calls_motion = [&](const std::string& function) {
    return std::ranges::any_of(names.functions.find(function)->second, moves);
  };
  while (std::erase_if(still, calls_motion) > 0) {
  }
  return still;
}

}  // namespace counterflex
