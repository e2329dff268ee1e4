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

/// Whether the point `target` is on the circle of CIRCLE/. The first point behind CIRCLE/ always is. Leaves
/// the circle if it is not.
bool stays_on_circle(AptReading& r, const RobotTarget& target, Motion motion) {
  constexpr double equal_mm = 0.1;  // generous: a post finds the points of the circle with its own tolerance
  if (!r.circle) return false;
  AptCircle& circle = *r.circle;
  if (!circle.is_known) return true;
  const Vector3 p_mm(target.position[0]->value, target.position[1]->value, target.position[2]->value);
  const double radius = radius_mm(circle, p_mm);
  if (!circle.radius_mm) {
    circle.radius_mm = radius;
    return true;
  }
  if (motion == Motion::feed && std::abs(radius - *circle.radius_mm) < equal_mm) return true;
  r.circle.reset();
  return false;
}

/// Why the point is not followed; empty if it is.
std::string why_not_followed(AptReading& r, const RobotTarget& target, Motion motion) {
  if (has_axis_of_no_length(target)) return "the tool axis has no direction: its numbers are 0";
  // A post computes the arc from the centre in CIRCLE/ and from the points.
  if (stays_on_circle(r, target, motion))
    return r.circle->is_known
               ? "the points lie on the circle of CIRCLE/, whose centre is not corrected: post "
                 "lines without CIRCLE/"
               : "the numbers of CIRCLE/ are not plain: points may lie on its circle";
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
  const std::string why = target ? why_not_followed(r, *target, motion) : why_no_target(statement);
  if (!why.empty()) return add_unfollowed_move(r.robot, line, why);
  add_target_move(r.robot, line, *target, {.motion = motion, .passes = true, .rounds = false});
  if (!r.may_skip) return;
  r.robot.program.moves.back().block_delete = true;
  forget_position(r.robot);
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
}

}  // namespace counterflex
