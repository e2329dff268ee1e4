#include "settings/values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/turn.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex::cli {
namespace {

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    std::string_view part = text.substr(0, comma);
    part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
    parts.push_back(part.substr(0, part.find_last_not_of(' ') + 1));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

std::string offset_name(std::string_view text, std::string_view option) {
  const auto name = work_offset_name(text);
  if (!name)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: '{}' is not a work offset; use {}", option, text, work_offset_names));
  return *name;
}

/// "X,Y,Z" behind "touched=" or "offset=", in m.
Vector3 lengths_of(std::string_view name, std::string_view text) {
  const std::size_t equals = text.find('=');
  const PoseText at = pose_of(fmt::format("{} {}", name, text.substr(0, equals)), text.substr(equals + 1));
  if (at.has_orientation)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: '{}' has 6 numbers, must be three lengths in mm", name, text));
  return at.X.p;
}

/// "machine", or "touched=X,Y,Z" in program coordinates, mm.
Datum datum_of(std::string_view name, std::string_view text) {
  if (text == "machine") return {.is_machine = true};
  if (!text.starts_with("touched="))
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: the datum is '{}', must be machine or touched=X,Y,Z", name, text));
  return {.touched_at = lengths_of(name, text)};
}

/// "DATUM", "offset=X,Y,Z" or "DATUM/offset=X,Y,Z".
void take_origin(std::string_view name, std::string_view text, WorkOffset& place) {
  const std::size_t slash = text.find('/');
  const std::string_view last = slash == std::string_view::npos ? text : text.substr(slash + 1);
  const bool has_offset = last.starts_with("offset=");
  if (has_offset) place.shown = lengths_of(name, last);
  if (!has_offset || slash != std::string_view::npos)
    place.datum = datum_of(name, has_offset ? text.substr(0, slash) : text);
}

}  // namespace

double number_of(std::string_view name, std::string_view text, Range range) {
  const auto value = read_number(text);
  if (value && (range.open ? *value > range.least : *value >= range.least)) return *value;
  throw InputError(ErrorKind::usage, {},
                   fmt::format("{} is '{}', must be a finite number {} {}", name, text,
                               range.open ? "above" : "of at least", range.least));
}

double number_of(std::string_view name, std::string_view text) {
  if (const auto value = read_number(text)) return *value;
  throw InputError(ErrorKind::usage, {}, fmt::format("{} is '{}', must be a finite number", name, text));
}

int integer_of(std::string_view name, std::string_view text, int least, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && value >= least && value <= most)
    return value;
  throw InputError(ErrorKind::usage, {},
                   fmt::format("{} is '{}', must be a whole number from {} to {}", name, text, least, most));
}

std::vector<double> numbers_of(std::string_view name, std::string_view text) {
  std::vector<double> values;
  for (const std::string_view part : split(text)) {
    const auto value = read_number(part);
    if (!value)
      throw InputError(ErrorKind::usage, {},
                       fmt::format("{}: '{}' in '{}' must be a finite number", name, part, text));
    values.push_back(*value);
  }
  return values;
}

PoseText pose_of(std::string_view name, std::string_view text) {
  const std::size_t count = split(text).size();
  if (count != 3 && count != 6)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("{}: '{}' has {} numbers, must be three lengths in mm, or these and three angles in "
                    "degrees",
                    name, text, count));
  std::vector<double> values = numbers_of(name, text);
  values.resize(6);
  return {Pose{from_rpy(Vector3(values[3], values[4], values[5]) * deg),
               Vector3(values[0], values[1], values[2]) * mm},
          count == 6};
}

Pose written_pose_of(std::string_view name, std::string_view text, std::string_view as) {
  const std::vector<double> values = numbers_of(name, text);
  const bool is_quaternion = as == "abb";
  if (values.size() != (is_quaternion ? 7u : 6u))
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("{}: '{}' has {} numbers, must be three lengths in mm and {}", name, text, values.size(),
                    is_quaternion  ? "the quaternion q1 to q4"
                    : as == "ur"   ? "a rotation vector in rad"
                    : as == "kuka" ? "A, B, C in degrees"
                                   : "W, P, R in degrees"));
  OrientationNumbers numbers{};
  std::copy(values.begin() + 3, values.end(), numbers.begin());
  if (as == "kuka") std::swap(numbers[0], numbers[2]);
  if (const double norm = Eigen::Vector4d(numbers.data()).norm(); is_quaternion && std::abs(norm - 1) > 1e-3)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: the quaternion in '{}' has the norm {:.6g}, must be 1 within 0.001",
                                 name, text, norm));
  const OrientationForm form = is_quaternion ? OrientationForm::quaternion
                               : as == "ur"  ? OrientationForm::rotation_vector
                                             : OrientationForm::fixed_axes;
  return {rotation_of(form, numbers), Vector3(values[0], values[1], values[2]) * mm};
}

Vector3 direction_of(std::string_view name, std::string_view text) {
  if (text == "x" || text == "y" || text == "z") return Vector3::Unit(text[0] - 'x');
  const std::vector<double> values = numbers_of(name, text);
  if (values.size() != 3)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("{}: the direction '{}' must be x, y, z or three numbers, as 1,0,1", name, text));
  const Vector3 direction(values[0], values[1], values[2]);
  if (direction.norm() == 0)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: the direction '{}' must not be zero", name, text));
  return direction.normalized();
}

CurveText curve_of(std::string_view name, std::string_view text) {
  const std::size_t equals = text.find('='), first = text.find(':', equals),
                    second = text.find(':', first + 1);
  if (equals == std::string_view::npos || first == std::string_view::npos || second == std::string_view::npos)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("{}: '{}' must be a direction, two displacements in mm and a number of steps, "
                    "as z=0:-12:24 or 1,0,1=0:5:10",
                    name, text));
  CurveText curve{direction_of(name, text.substr(0, equals))};
  curve.from = number_of(name, text.substr(equals + 1, first - equals - 1)) * mm;
  curve.to = number_of(name, text.substr(first + 1, second - first - 1)) * mm;
  curve.steps = integer_of(name, text.substr(second + 1), 1, 10000);
  return curve;
}

WorkText work_of(std::string_view text, std::string_view name) {
  if (text == "machine") return {};
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: '{}' must be an offset and its pose, as G54=X,Y,Z[,RX,RY,RZ], or "
                                 "'machine'",
                                 name, text));
  const std::string offset = offset_name(text.substr(0, equals), name);
  const std::string label = fmt::format("{} {}", name, offset);
  const std::string_view place = text.substr(equals + 1);
  const std::size_t slash = place.find('/');
  WorkText work{offset, {pose_of(label, place.substr(0, slash)).X, {}}};
  if (slash != std::string_view::npos) take_origin(label, place.substr(slash + 1), work.place);
  return work;
}

std::pair<long, double> tool_length_of(std::string_view name, std::string_view text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  const auto tool = read_tool_number(text.substr(0, equals));
  if (!tool || equals == text.size())
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: '{}' must be a tool and its length in mm, as T1=50", name, text));
  const std::string_view length = text.substr(equals + 1);
  if (length.find(',') != std::string_view::npos)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{}: '{}' must be one tool and its length in mm; repeat {} for each tool",
                                 name, text, name));
  return {*tool, number_of(fmt::format("{} T{}", name, *tool), length)};
}

std::size_t choice_of(std::string_view name, std::string_view text,
                      const std::vector<std::string_view>& allowed) {
  const auto found = std::find(allowed.begin(), allowed.end(), text);
  if (found == allowed.end())
    throw InputError(ErrorKind::usage, {},
                     fmt::format("{} is '{}', must be {}", name, text, fmt::join(allowed, " or ")));
  return static_cast<std::size_t>(found - allowed.begin());
}

bool truth_of(std::string_view name, std::string_view text) {
  return choice_of(name, text, {"true", "false"}) == 0;
}

}  // namespace counterflex::cli
