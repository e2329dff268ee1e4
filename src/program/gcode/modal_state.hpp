#pragma once
/// The modal state of a control that determines the path of the tool.
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

enum class MotionMode : std::uint8_t {
  none,  ///< no motion was programmed yet
  rapid,
  feed,
  clockwise,
  counter_clockwise,
  cycle,
  probe,
  spline,
  thread,
  cancelled  ///< after G80 on controls without a motion afterwards
};

enum class FeedUnit : std::uint8_t { per_minute, per_turn, inverse_time };

/// Modal states whose value is unknown: set in a block that '/' may skip, in a condition or in a called
/// subprogram. A block that sets the state makes it known again.
enum UnknownMode : std::uint16_t {
  unknown_motion = 1,
  unknown_distance = 2,
  unknown_plane = 4,
  unknown_unit = 8,
  unknown_offset = 16,
  unknown_centres = 32,
  unknown_level = 64,
  unknown_cutter = 128,
  all_unknown_modes = 255,  ///< of coordinates and motions
  unknown_feed_mode = 256,
  unknown_tool = 512  ///< in the spindle
};

/// Sticky words of a canned cycle (mm), absolute or differences as programmed.
struct CycleState {
  std::optional<double> bottom, retract;
  std::optional<double> initial;  ///< Z at which the series of cycles began
  bool relative = false;          ///< the sticky words are differences
  bool begun = false;
  /// The tool is at the retract plane: after a hole with G99, or at the begin of a series without R.
  bool left_at_retract = false;
  /// The last hole left Z unknown, because the corrected text may have another R: `initial` stays known.
  bool left_at_earlier_retract = false;
  /// Z was programmed in a hole that is not followed or may be skipped: the Z that an inserted word would
  /// replace is unknown.
  bool bottom_unknown = false;
};

/// Shift and rotation of the coordinates of a work offset by plain numbers.
struct FrameShifts {
  Vector3 set_mm = Vector3::Zero();          ///< by G92
  Vector3 local_mm = Vector3::Zero();        ///< by G52
  Vector3 turn_centre_mm = Vector3::Zero();  ///< of G68, in shifted coordinates
  double turn_rad = 0;                       ///< about Z, counter-clockwise
};

/// A work offset changed by G10.
struct SetOffset {
  std::array<std::optional<double>, 3> set_mm{};  ///< position in machine coordinates, by axis: L2
  Vector3 moved_mm = Vector3::Zero();             ///< shift from its position: L20

  bool operator==(const SetOffset&) const = default;
};

/// Position of the current move relative to a contour under G41 or G42.
enum class Contour : std::uint8_t {
  none,
  inside,      ///< G41 or G42 is active
  taking_off,  ///< after G40, until the next move: a feed move ends the compensation
  leaving      ///< after that move, until the next move along X or Y
};

struct ModalState {
  MotionMode motion = MotionMode::none;
  std::optional<LengthUnit> unit;
  bool unit_is_of_lengths = false;  ///< G70 or G71 of a Sinumerik: F has the unit of the control
  std::array<bool, 3> known{};
  Vector3 position_mm = Vector3::Zero();
  bool turns_tool = false;  ///< a word of A, B or C was read as the tool's orientation
  std::array<bool, 3> known_angles{};
  Vector3 angles_deg = Vector3::Zero();  ///< A, B, C
  double feed = 0;                       ///< as programmed; 0: unknown
  std::optional<LengthUnit> feed_unit;   ///< the unit when it was programmed
  FeedUnit feed_mode = FeedUnit::per_minute;
  double spindle_rpm = 0;            ///< 0: unknown
  bool surface_speed = false;        ///< G96: S is a cutting speed
  bool spindle_off = false;          ///< behind M5, or perhaps
  double feed_share = 1;             ///< OVR= of a Sinumerik; 0: unknown
  bool feed_of_axes = false;         ///< FGROUP of a Sinumerik: F is the feed of some axes only
  std::optional<long> main_spindle;  ///< by SETMS; empty: unknown
  int normal = 2;                    ///< axis normal to the plane
  bool relative = false;             ///< G91
  bool absolute_centres = false;
  bool returns_to_retract = false;  ///< G99
  bool level_is_stated = false;     ///< G98 or G99 was read
  CycleState cycle;
  std::size_t frame = 0;  ///< index into Program::frames
  FrameShifts shifts{};   ///< shifts of that frame
  /// Sinumerik: the change of each coordinate by frames since the axis moved last.
  Vector3 untravelled_mm = Vector3::Zero();
  bool exact_stop = false;
  std::optional<double> tool_length;     ///< number of H; 0: off; empty: unknown
  std::optional<double> tool_length_mm;  ///< empty: unknown
  std::optional<long> tool_chosen = 0;   ///< T; empty: unknown
  long tool = 0;                         ///< in the spindle
  std::optional<Vector6> force;
  std::uint16_t unknown_modes = 0;
  std::uint16_t displaced = 0;      ///< bits of Displacement
  std::uint32_t mirrored_axes = 0;  ///< letters of the axes of `mirrored`, A in the lowest bit
  int modal_macros = 0;             ///< number of calls by G66 that act
  std::uint16_t offsets_set = 0;    ///< by G10: a bit for each of G54 to G59.3, the highest for others
  bool entering_data = false;       ///< between G10 L50 and G11, where blocks are parameters
  Contour contour = Contour::none;
  int group = 0;                              ///< number of the contour
  CutterSide cutter_side = CutterSide::none;  ///< of the contour, if it is in the plane X Y
  std::optional<double> cutter_diameter_mm;   ///< D of G41.1 and G42.1; empty: of the tool, or unknown
  bool beside_contour = false;  ///< in a contour: a move across has brought the cutter to its side
};

/// F and S are unknown until a word gives them.
inline void forget_speeds(ModalState& state) {
  state.feed = state.spindle_rpm = 0;
}

}  // namespace counterflex
