#pragma once
/// Reads a machining program.
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

/// Joint values at which a robot is, as its control shows them.
struct JointPlace {
  std::array<double, 6> joints{};                   ///< rad
  std::array<std::optional<double>, 6> external{};  ///< E1 to E6, mm or deg
  std::optional<Pose> tcp_mm{};                     ///< of the program, if it gives its numbers
  bool other_tool = false;                          ///< the program has selected more than one tool
};

/// Pose of the tool frame T of this library in coordinates of `frame` (position in mm) for the control, which
/// knows no error of the machine. `tool` is as in Move. Empty: not known.
using JointKinematics =
    std::function<std::optional<Pose>(const JointPlace&, std::int32_t tool, const ProgramFrame& frame)>;

using CallNames = std::set<std::string, std::less<>>;  ///< in upper case without blanks

struct ReadOptions {
  /// auto, linuxcnc, grbl, fanuc, haas, mach3, siemens, heidenhain, kuka, abb, ur, apt, fanuc_tp, yaskawa.
  /// auto inspects the first megabyte: BEGIN PGM means heidenhain; DEF NAME( ) means kuka; MODULE means abb;
  /// def NAME( ): means ur; PARTNO or GOTO/ means apt; /PROG means fanuc_tp; /JOB means yaskawa; words of a
  /// Sinumerik mean siemens; an O-number or a name behind '%' means fanuc, or haas or mach3 if only they know
  /// all codes. All other
  /// programs are linuxcnc, or mach3 if only mach3 knows all codes, or grbl if a comment names it.
  std::string dialect = "auto";
  std::optional<LengthUnit> unit;  ///< used if the program has no G20 or G21 before its first move
  /// Axes of "XYZ" that are unknown after a tool change; default: no axis for linuxcnc and grbl, all axes for
  /// other dialects.
  std::optional<std::vector<char>> tool_change_moves;
  IntegerWords integer_words = IntegerWords::unspecified;
  bool absolute_centres = false;  ///< I, J, K of arcs are coordinates, until the program changes it (G91.1)
  /// By H, or by the active tool if G43 has no H: if both lengths are known, Z stays known at a tool change.
  std::map<long, double> tool_lengths_mm{};
  bool evaluate = false;  ///< evaluates variables that the program sets to constants, and expressions of them
  /// LinuxCNC: A, B and C are the tool's orientation (degrees about X, Y and Z, fixed axes, in this order),
  /// as the kinematics of a six-axis machine have it; else words of these axes that are not zero end
  /// correction.
  bool tool_orientation = false;
  /// Of the control's tool frame, in which programs of robots and six-axis machines give orientations.
  SpindleAxis spindle_axis = SpindleAxis::z;
  /// Of the robot: where the tool is at targets that give joint values. Without it that is not known.
  JointKinematics kinematics{};
  /// Programs that calls name and that are not in the text: they neither move the machine nor change a state
  /// that is read. "O9001" for numbers.
  CallNames harmless_calls{};
  /// Replaces calls by M98, CALL LBL and O-words with plain numbers by the bodies.
  bool expand_subprograms = false;
};

/// Whether `dialect` is the language of a robot.
bool is_robot_dialect(std::string_view dialect);

/// The name of the language of a robot dialect, "KUKA KRL"; empty for other dialects.
std::string_view robot_language_of(std::string_view dialect);

/// Error text if `dialect` is not a known dialect; empty otherwise.
std::optional<std::string> unknown_dialect(const std::string& dialect);

/// Reads `text` and keeps every byte. `file` is its name in diagnostics. Throws `InputError` with line and
/// column for invalid text and for words that are not supported (ErrorKind::program_text;
/// ErrorKind::machine_or_force for a FORCE comment; ErrorKind::usage for an unknown dialect). No word is
/// ignored silently.
Program read_program(std::string text, const std::string& file, const ReadOptions& options);

/// The first word without a decimal point in the moves up to `line` that may mean units or increments, with a
/// remark that names the option. Empty if all such words have a known meaning.
std::optional<Remark> ambiguous_integer_word(const Program& window, int line);

/// Whether `text` has the header of a corrected program (a comment that begins with "COUNTERFLEX 1").
bool is_corrected(const Program& program);

}  // namespace counterflex
