#pragma once
/// The plan of a program for people and for programs.
#include <nlohmann/json.hpp>
#include <string>

#include "counterflex/report/motion_plan.hpp"

namespace counterflex::cli {

/// How many blocks are corrected, hold a shift, or stay as they are, with reasons and first lines; and what
/// kinds of moves there are.
std::string plan_text(const MotionPlan& plan);
nlohmann::ordered_json plan_json(const MotionPlan& plan);

}  // namespace counterflex::cli
