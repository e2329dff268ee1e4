#pragma once
/// Which functions of a URScript do not move the robot.
#include <string_view>

#include "counterflex/program/read_program.hpp"
#include "program/robot/ur/names.hpp"

namespace counterflex {

/// Whether `name`, a word of `ur_calls`, is a function of the control that does not move the robot and keeps
/// its tool, a method of a list, or an operator.
bool is_ur_motionless_call(std::string_view name);

/// The functions and threads of a text that call nothing else than such functions, routines that are stated
/// as `harmless`, and each other.
UrFunctions ur_still_functions(const UrNames& names, const CallNames& harmless);

}  // namespace counterflex
