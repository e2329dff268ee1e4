#pragma once
/// What a control remembers from block to block, as far as the way of the tool needs it.
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

enum class MotionMode : std::uint8_t {
  none,  ///< nothing programmed yet
  rapid,
  feed,
  clockwise,
  counter_clockwise,
  cycle,
  probe,
  spline,
  thread,
  cancelled  ///< after G80, where that leaves no motion
};

enum class FeedUnit : std::uint8_t { per_minute, per_turn, inverse_time };

/// States that may be what the text says or not: a block that '/' may skip, a condition or a subprogram that
/// was called has set them. A block that sets them anew ends the doubt.
enum Doubt : std::uint16_t {
  doubtful_motion = 1,
  doubtful_distance = 2,
  doubtful_plane = 4,
  doubtful_unit = 8,
  doubtful_offset = 16,
  doubtful_centres = 32,
  doubtful_level = 64,
  doubtful_cutter = 128,
  all_doubts = 255
};

/// Sticky words of a canned cycle, in mm, absolute or differences as they were programmed.
struct CycleState {
  std::optional<double> bottom, retract;
  std::optional<double> initial;  ///< Z where the series of cycles began
  bool relative = false;          ///< the sticky words are differences
  bool begun = false;
  bool left_at_retract = false;  ///< the tool stands at the retract plane: the last hole has left it there,
                                 ///< or the series begins, whose plane is there unless R says another
  bool bottom_in_doubt = false;  ///< Z was programmed in a hole that is not followed or may be skipped: what
                                 ///< a Z that is put into a later hole replaces is not known
};

/// By how much plain numbers shift and turn the coordinates of a work offset.
struct FrameShifts {
  Vector3 set_mm = Vector3::Zero();          ///< by G92
  Vector3 local_mm = Vector3::Zero();        ///< by G52
  Vector3 turn_centre_mm = Vector3::Zero();  ///< of G68, in coordinates that are shifted
  double turn_rad = 0;                       ///< about Z, counter-clockwise
};

/// What G10 has made of a work offset.
struct SetOffset {
  std::array<std::optional<double>, 3> set_mm{};  ///< its place in machine coordinates, by axis: L2
  Vector3 moved_mm = Vector3::Zero();             ///< from its place: L20
};

/// Where the moves stand to a contour under G41 or G42.
enum class Contour : std::uint8_t {
  none,
  inside,      ///< G41 or G42 acts
  taking_off,  ///< after G40, until the next move: a feed move takes the compensation off
  leaving      ///< after that move, until the next one along X or Y
};

struct ModalState {
  MotionMode motion = MotionMode::none;
  std::optional<LengthUnit> unit;
  std::array<bool, 3> known{};
  Vector3 position_mm = Vector3::Zero();
  double feed = 0;                      ///< as programmed
  std::optional<LengthUnit> feed_unit;  ///< the unit when it was programmed
  FeedUnit feed_mode = FeedUnit::per_minute;
  double spindle_rpm = 0;
  int normal = 2;         ///< axis that the plane's normal is
  bool relative = false;  ///< G91
  bool absolute_centres = false;
  bool returns_to_retract = false;  ///< G99
  CycleState cycle;
  std::size_t frame = 0;        ///< index into Program::frames
  FrameShifts shifts{};         ///< of which it is made
  bool exact_stop = false;
  std::optional<double> tool_length;     ///< number of H; 0: off; none: not known
  std::optional<double> tool_length_mm;  ///< where it is known
  long tool_chosen = 0;                  ///< T
  long tool = 0;                         ///< in the spindle
  std::optional<Vector6> force;
  std::uint16_t doubts = 0;
  std::uint16_t displaced = 0;    ///< bits of Displacement
  std::uint16_t offsets_set = 0;  ///< by G10: a bit for each of G54 to G59.3, the highest for others
  bool entering_data = false;     ///< between G10 L50 and G11 blocks hold parameters
  Contour contour = Contour::none;
  int group = 0;  ///< of the contour
  bool beside_contour = false;  ///< inside, the cutter has come to its side by a move across
};

}  // namespace counterflex
