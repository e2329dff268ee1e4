#pragma once
/// What G and M codes mean to this reader, as data.
#include <string_view>

#include "program/dialect.hpp"

namespace counterflex {

enum class Action {
  rapid,
  feed,
  end_motion,  ///< G80
  dwell,
  inch,
  mm,
  machine_move,    ///< G53: positions of the machine
  reference_move,  ///< G28, G30
  tool_length,     ///< G43, G44
  no_tool_length,  ///< G49
  work_offset,
  stop_once,  ///< G9
  g61,
  exact_stop,  ///< G61.1
  blend,       ///< G64
  smooth,      ///< G5.1, G187
  feed_per_minute,
  feed_per_turn,
  state,    ///< followed by the control, harmless to straight lines
  not_read  ///< known, and refused
};

/// Codes of one group exclude each other in a block.
enum class Group {
  none,
  motion,
  distance,
  unit,
  feed_mode,
  plane,
  offset,
  tool_length,
  cutter,
  path,
  arc,
  retract,
  spindle
};

struct GCode {
  int tenths = 0;  ///< G59.1 is 591
  Action action = Action::state;
  Group group = Group::none;
  std::string_view what{};  ///< of a code that is not read: what it would start
  bool shop_only = false;   ///< not a code of linuxcnc and grbl
};

/// The code `tenths` in `dialect`, or nullptr.
const GCode* find_g_code(int tenths, const Dialect& dialect);

enum class MAction {
  state,       ///< moves nothing, acts with or before the move of its block
  acts_after,  ///< stops, spindle off, coolant off: a block that holds one is not split
  tool_change,
  end,      ///< M2, M30
  machine,  ///< meaning set by the machine's builder: taken as moving nothing, with a remark
  not_read
};

MAction action_of_m(int code, const Dialect& dialect);

}  // namespace counterflex
