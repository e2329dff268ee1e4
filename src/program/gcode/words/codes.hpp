#pragma once
/// Meanings of G and M codes, as data.
#include <cstdint>
#include <string_view>

#include "program/dialect.hpp"

namespace counterflex {

enum class Action : std::uint8_t {
  rapid,
  feed,
  arc,         ///< G2, G3
  cycle,       ///< G73, G74, G76, G81 to G89
  probe,       ///< G31, G38: moves with an unknown end
  spline,      ///< G5 of LinuxCNC: a curve of control points
  thread,      ///< G33, LinuxCNC's G76
  end_motion,  ///< G80
  pocket,      ///< G12, G13: cuts a round pocket about the tool's position, and ends there
  engrave,     ///< G47: engraves text from a position on, from R down to Z
  own_way,     ///< motion defined by the control: G29, G70 to G72 of Haas, G150
  call,        ///< G65: runs a macro
  dwell,
  inches,          ///< G20
  millimetres,     ///< G21
  machine_move,    ///< G53: positions of the machine
  reference_move,  ///< G28, G30
  tool_length,     ///< G43, G44, G43.1
  no_tool_length,  ///< G49
  work_offset,
  stop_once,  ///< G9
  g61,
  exact_stop,  ///< G61.1
  blend,       ///< G64
  smooth,      ///< G5.1, G187
  feed_per_minute,
  feed_per_turn,
  inverse_time,      ///< G93
  plane,             ///< G17, G18, G19
  absolute,          ///< G90
  relative,          ///< G91
  absolute_centres,  ///< G90.1
  relative_centres,  ///< G91.1
  cutter,            ///< G41, G42
  no_cutter,         ///< G40
  initial_level,     ///< G98
  retract_level,     ///< G99
  displace,          ///< displaces programmed positions; `what` is the reason
  end_displace,      ///< ends a `displace` of the same `bit`
  shift,             ///< G52: displaces unless its words are zero
  set_data,          ///< G10
  end_data,          ///< G11
  state,             ///< a state of the control without effect on moves; may have axis words
  limits,            ///< G25, G26 of a Sinumerik: of the working area, of the spindle's speed S
  surface_speed,     ///< G96
  spindle_speed,     ///< G97
  not_read           ///< known, but not supported
};

/// Codes of one group exclude each other in a block.
enum class CodeGroup : std::uint8_t {
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

/// States in which program coordinates are not those of the work offset.
enum Displacement : std::uint16_t {
  shifted = 1,        ///< G52
  set_position = 2,   ///< G92
  scaled = 4,         ///< G51
  rotated = 8,        ///< G68
  polar = 16,         ///< G16
  mirrored = 32,      ///< G101, G51.1
  tool_point = 64,    ///< tool centre point control, dynamic offsets
  modal_macro = 128,  ///< G66: every move calls a macro
  rotary = 256,       ///< an axis other than X, Y and Z is not at zero
  data = 512,         ///< G10 has changed the work offset
  kinematics = 1024,  ///< switched kinematics
  framed = 2048,      ///< TRANS, ROT, SCALE, MIRROR of a Sinumerik
  tilted = 4096,      ///< CYCLE800
  unknown = 8192      ///< an unknown code was executed; its effect on later blocks is unknown
};

struct GCode {
  int tenths = 0;  ///< G59.1 is 591
  Action action = Action::state;
  CodeGroup group = CodeGroup::none;
  std::string_view what{};         ///< of a code that is not supported or displaces: the name of its effect
  unsigned families = any_family;  ///< dialects in which it has this meaning
  std::uint16_t bit = 0;           ///< of a displacement
};

/// Replaces codes that the dialect does not know: the block has an unknown motion, and later blocks are not
/// followed.
const GCode& unknown_g_code();

/// The code `tenths` in `dialect`, or nullptr.
const GCode* find_g_code(int tenths, const Dialect& dialect);

enum class MAction : std::uint8_t {
  state,       ///< moves no axis, acts with or before the move of its block
  acts_after,  ///< stops, spindle off, coolant off: its block is not split
  tool_change,
  end,               ///< M2, M30
  call,              ///< M98: runs a subprogram
  return_from_call,  ///< M99; M47 of Mach3 repeats the program
  restore,           ///< M72: restores saved states
  kinematics,        ///< LinuxCNC's M428 to M430
  retract,           ///< M25: moves Z to its home on Centroid's controls
  machine            ///< defined by the machine builder: assumed not to move an axis, with a remark
};

MAction action_of_m(int code, const Dialect& dialect);

}  // namespace counterflex
