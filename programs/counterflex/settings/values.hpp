#pragma once
/// Parses values of command line arguments. All throw `InputError` (ErrorKind::usage) with the argument and
/// the allowed values.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex::cli {

/// A finite number of at least `least`, or above it if `open`.
struct Range {
  double least = 0;
  bool open = false;
};
double number_of(std::string_view name, std::string_view text, Range range);

/// Any finite number.
double number_of(std::string_view name, std::string_view text);

/// An integer in [least, most].
int integer_of(std::string_view name, std::string_view text, int least, int most);

/// "X,Y,Z" or "X,Y,Z,R,P,Y": mm, and roll, pitch, yaw in degrees (default: identity).
struct PoseText {
  Pose X;
  bool has_orientation = false;
};
PoseText pose_of(std::string_view name, std::string_view text);

/// "0,-90,90": any finite numbers.
std::vector<double> numbers_of(std::string_view name, std::string_view text);

/// How the numbers of a pose are written, by the maker of the control.
inline const std::vector<std::string_view> pose_writers = {"kuka", "fanuc", "abb", "ur"};

/// "X,Y,Z" in mm and the numbers of the orientation: KUKA's A,B,C or FANUC's W,P,R in degrees, ABB's q1 to
/// q4, or the rotation vector of UR in rad. `as` is one of `pose_writers`.
Pose written_pose_of(std::string_view name, std::string_view text, std::string_view as);

/// "z" or "1,0,1": a direction in the machine frame, made a unit vector.
Vector3 direction_of(std::string_view name, std::string_view text);

/// "z=0:-12:24" or "1,0,1=0:5:10": a direction in the machine frame (made a unit vector), and the first and
/// last displacement (mm) and the number of steps between them.
struct CurveText {
  Vector3 direction;
  double from = 0, to = 0;  ///< m
  int steps = 1;
};
CurveText curve_of(std::string_view name, std::string_view text);

/// A value of --work: "G54=X,Y,Z[,RX,RY,RZ][/DATUM][/offset=X,Y,Z]" with DATUM "machine" or "touched=X,Y,Z",
/// and the numbers of the offset on the control; or only "machine".
struct WorkText {
  std::string offset;  ///< as in programs; empty: program coordinates are machine coordinates
  WorkOffset place;
};
WorkText work_of(std::string_view text, std::string_view name = "--work");

/// "T1=50": the tool's number and its length in mm.
std::pair<long, double> tool_length_of(std::string_view name, std::string_view text);

/// The index in `allowed`.
std::size_t choice_of(std::string_view name, std::string_view text,
                      const std::vector<std::string_view>& allowed);

/// "true" or "false".
bool truth_of(std::string_view name, std::string_view text);

}  // namespace counterflex::cli
