#pragma once
/// The plan of a program as text and as JSON.
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "counterflex/report/motion_plan.hpp"

namespace counterflex::cli {

/// Numbers of blocks that are corrected, held or not corrected, with reasons and first lines, and the kinds
/// of moves.
std::string plan_text(const MotionPlan& plan);
nlohmann::ordered_json plan_json(const MotionPlan& plan);

/// Number of feed moves of unknown length.
std::size_t unknown_moves(const MotionPlan& plan);

}  // namespace counterflex::cli
