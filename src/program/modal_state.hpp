#pragma once
/// What a control remembers from block to block, as far as straight lines need it.
#include <array>
#include <optional>
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

enum class MotionMode {
  none,  ///< nothing programmed yet
  rapid,
  feed,
  cancelled,  ///< after G80, where that leaves no motion
  doubtful    ///< set in a block that '/' may skip
};

struct ModalState {
  MotionMode motion = MotionMode::none;
  std::optional<LengthUnit> unit;
  std::array<bool, 3> known{};
  Vector3 position_mm = Vector3::Zero();
  double feed = 0;                      ///< as programmed
  std::optional<LengthUnit> feed_unit;  ///< the unit when it was programmed
  bool feed_per_turn = false;
  double spindle_rpm = 0;
  std::size_t work_offset = 0;  ///< index into Program::work_offsets
  bool exact_stop = false;
  std::optional<double> tool_length;  ///< number of H; 0: off; none: not known
  std::optional<Vector6> force;
};

}  // namespace counterflex
