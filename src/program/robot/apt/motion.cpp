#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "program/robot/apt/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::size_t position_alone = 3, with_axis = 6;

LengthUnit unit_of(const AptReading& r, const RobotLine& line) {
  if (r.unit) return *r.unit;
  refuse(r.robot.program.file, line, line.code.begin,
         "a point before the unit is known: write UNITS/MM or UNITS/INCHES, or give --units mm or --units "
         "inch");
}

/// The numbers of a point; empty if one is not plain. Without an axis, or with one of length 0, it has none.
std::optional<RobotTarget> target_of(const AptReading& r, const AptStatement& statement) {
  RobotTarget target;
  const std::size_t count = statement.parameters.size();
  if (count != position_alone && count != with_axis) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = apt_number(r.robot.program.text, statement.parameters[i]);
    if (!number) return std::nullopt;
    (i < position_alone ? target.position[i] : target.orientation[i - position_alone]) = number;
  }
  for (std::size_t i = 0; i < position_alone; ++i) target.position[i]->value *= mm_per(*r.unit);
  return target;
}

bool has_axis_of_no_length(const RobotTarget& target) {
  return target.orientation[0] && std::ranges::all_of(target.orientation, [](const auto& number) {
           return !number || number->value == 0;
         });
}

std::string why_no_target(const AptStatement& statement) {
  const std::size_t count = statement.parameters.size();
  if (count == position_alone || count == with_axis)
    return fmt::format("the point of {}/ is not given by plain numbers", statement.head);
  return fmt::format("{}/ has {} numbers, not 3 or 6", statement.head, count);
}

double radius_mm(const AptCircle& circle, const Vector3& p_mm) {
  const Vector3 arm = p_mm - circle.centre_mm;
  return (arm - arm.dot(circle.normal) * circle.normal).norm();
}

/// Whether `move` ends on the circle on which it starts. Leaves the circle if not.
bool stays_on_circle(AptReading& r, const Move& move) {
  constexpr double equal_mm = 0.02;
  const bool known = r.circle->is_known && all_known(move.known_start) && all_known(move.known_end);
  if (known && std::abs(radius_mm(*r.circle, move.start_mm) - radius_mm(*r.circle, move.end_mm)) < equal_mm)
    return true;
  if (!r.begins_circle) r.circle.reset();
  return false;
}

/// Greatest distance of the circle from the chord `move`.
double height_over_chord_mm(const AptCircle& circle, const Move& move) {
  const double radius = radius_mm(circle, move.start_mm);
  const Vector3 chord = move.end_mm - move.start_mm;
  const double half = (chord - chord.dot(circle.normal) * circle.normal).norm() / 2;
  return half >= radius ? radius : radius - std::sqrt(radius * radius - half * half);
}

/// Why the path to a point behind CIRCLE/ is not its chord; empty if it is.
std::string why_no_chord(AptReading& r, const Move& move) {
  constexpr double most_mm = 0.01;
  if (!r.circle) return "";
  if (!stays_on_circle(r, move))
    return r.circle
               ? "the path behind CIRCLE/ is not known: its numbers are not, or its points do not lie on it"
               : "";
  if (height_over_chord_mm(*r.circle, move) <= most_mm) return "";
  return "the points behind CIRCLE/ are too far from each other to be read as chords of the circle";
}

/// Why the control does not go to the points; empty if it does.
std::string why_not_followed(const AptReading& r) {
  if (r.in_cycle) return "the points are holes of CYCLE/, which is not supported";
  if (r.in_cutcom) return "the control shifts the points by the tool's radius (CUTCOM/)";
  return "";
}

}  // namespace

std::optional<RobotNumber> apt_number(std::string_view text, Span parameter) {
  auto number = number_at(text, parameter.begin);
  if (number && number->span.end != parameter.end) number.reset();
  return number;
}

void read_apt_point(AptReading& r, const RobotLine& line, const AptStatement& statement) {
  r.robot.state.unit = unit_of(r, line);
  const Motion motion = std::exchange(r.rapid, false) ? Motion::rapid : Motion::feed;
  const auto target = target_of(r, statement);
  std::string why = why_not_followed(r);
  if (!target) why = why_no_target(statement);
  if (target && has_axis_of_no_length(*target)) why = "the tool axis has no direction: its numbers are 0";
  if (!why.empty()) {
    r.circle.reset();
    return add_unfollowed_move(r.robot, line, why);
  }
  Move move = begin_robot_move(r.robot, line, motion);
  end_at_target(r.robot, *target, {.motion = motion, .passes = true, .rounds = false}, move);
  const bool behind_circle = r.circle.has_value();
  why = why_no_chord(r, move);
  r.begins_circle = false;
  if (!why.empty()) return add_unfollowed_move(r.robot, line, why);
  // An inserted point would be the end of the circle.
  if (behind_circle && r.circle) move.may_split = move.may_jump = false;
  r.robot.program.moves.push_back(std::move(move));
}

void read_apt_circle(AptReading& r, const AptStatement& statement) {
  std::array<double, 6> numbers{};
  bool is_known = r.unit && statement.parameters.size() >= numbers.size();
  for (std::size_t i = 0; is_known && i < numbers.size(); ++i) {
    const auto number = apt_number(r.robot.program.text, statement.parameters[i]);
    is_known = number.has_value();
    if (number) numbers[i] = number->value;
  }
  const Vector3 normal(numbers[3], numbers[4], numbers[5]);
  is_known = is_known && !normal.isZero(0);
  const double unit = is_known ? mm_per(*r.unit) : 1;
  r.circle =
      AptCircle{unit * Vector3(numbers[0], numbers[1], numbers[2]), normal.stableNormalized(), is_known};
  r.begins_circle = true;
}

}  // namespace counterflex
