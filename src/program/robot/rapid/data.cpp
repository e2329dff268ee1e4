#include "program/robot/rapid/data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "program/text/lex.hpp"

namespace counterflex {
namespace {

bool is_name(std::string_view text, Span span) {
  const RapidToken token = rapid_token_at(text, span.begin, span.end);
  return token.kind == RapidTokenKind::name && token.span.end == span.end;
}

/// The declared datum of the name `span`. Null for other text and for a name that is not declared.
const RapidDatum* datum_at(const RapidPlace& place, Span span) {
  return is_name(place.text, span) ? place.module.find(part(place.text, span), place.at) : nullptr;
}

/// Why the value of a datum is not known; empty if it is. `what` names its kind.
std::string why_unknown(const RapidDatum& datum, std::string_view what) {
  if (datum.type.empty()) return fmt::format("the {} '{}' is a parameter of the routine", what, datum.name);
  if (datum.array) return fmt::format("the {} '{}' is an array", what, datum.name);
  if (datum.computed_in > 0)
    return fmt::format("the {} '{}' is computed at run time in line {}", what, datum.name, datum.computed_in);
  return {};
}

/// The list literal of a declared datum or of the argument itself, with the text that it is in.
struct Literal {
  std::string_view text;
  std::optional<RapidList> list{};
};

Literal literal_at(const RapidPlace& place, Span span) {
  const RapidDatum* datum = datum_at(place, span);
  if (datum != nullptr && !why_unknown(*datum, "").empty()) return {};
  const std::string_view text = datum != nullptr ? std::string_view(datum->value) : place.text;
  return {text,
          datum != nullptr ? rapid_list_at(text, 0, text.size()) : rapid_list_at(text, span.begin, span.end)};
}

std::optional<double> number_of(std::string_view text, const RapidList& value) {
  const auto number = number_at(text, value.span.begin);
  return !value.is_list && number && number->span.end == value.span.end ? std::optional(number->value)
                                                                        : std::nullopt;
}

template <std::size_t size>
std::optional<std::array<double, size>> numbers_of_list(std::string_view text, const RapidList& list) {
  std::array<double, size> numbers{};
  if (list.items.size() != size) return std::nullopt;
  for (std::size_t i = 0; i < size; ++i) {
    const auto number = number_of(text, list.items[i]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

/// The pose "[[x,y,z],[q1,q2,q3,q4]]" (mm).
std::optional<Pose> pose_of(std::string_view text, const RapidList& list) {
  if (list.items.size() != 2) return std::nullopt;
  const auto p = numbers_of_list<3>(text, list.items[0]);
  const auto q = numbers_of_list<4>(text, list.items[1]);
  if (!p || !q || *q == std::array<double, 4>{}) return std::nullopt;
  return Pose{rotation_of(OrientationForm::quaternion, *q), {(*p)[0], (*p)[1], (*p)[2]}};
}

/// TRUE or FALSE.
std::optional<bool> flag_of(std::string_view text, const RapidList& value) {
  const std::string word = rapid_word(part(text, value.span));
  if (word != "TRUE" && word != "FALSE") return std::nullopt;
  return word == "TRUE";
}

/// The number behind a letter: "v100", "z5".
std::optional<int> number_behind(const std::string& word, char letter) {
  int number = 0;
  if (word.size() < 2 || word[0] != letter) return std::nullopt;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data() + 1, end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

template <std::size_t size>
bool contains(const std::array<int, size>& values, int value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

// Predefined data: ABB, Technical reference manual, RAPID Instructions, Functions and Data types, 3HAC16581,
// "speeddata" and "zonedata". The radius of z0 is 0.3 mm.
constexpr std::array speeds{5,   10,  20,  30,   40,   50,   60,   80,   100,  150,  200,  300, 400,
                            500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000};
constexpr std::array zones{0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200};
constexpr std::array<std::string_view, zones.size()> zone_names{
    "z0", "z1", "z5", "z10", "z15", "z20", "z30", "z40", "z50", "z60", "z80", "z100", "z150", "z200"};
constexpr double smallest_zone_mm = 0.3;

/// The arguments of "Offs(p, 1, 2, 3)"; empty for another function.
std::vector<Span> arguments_of(std::string_view text, Span span, std::string_view function) {
  const RapidToken name = rapid_token_at(text, span.begin, span.end);
  const RapidToken open = rapid_token_at(text, name.span.end, span.end);
  if (rapid_word(part(text, name.span)) != function || !is_symbol(text, open, '(')) return {};
  if (text[span.end - 1] != ')') return {};
  return rapid_arguments(text, {open.span.end, span.end - 1});
}

/// A target that is a list or a name.
RapidOperand plain_operand(const RapidPlace& place, Span span) {
  RapidOperand operand{.form = RapidOperand::Form::list, .span = span, .numbers = span};
  if (const RapidDatum* datum = datum_at(place, span)) {
    operand.form = RapidOperand::Form::name;
    operand.numbers = datum->span;
    operand.why = why_unknown(*datum, "target");
    if (operand.why.empty() && datum->type != "ROBTARGET")
      operand.why = fmt::format("'{}' is not a robtarget", datum->name);
    if (operand.why.empty() && empty(datum->span))
      operand.why = fmt::format("the target '{}' is declared without numbers", datum->name);
    if (!operand.why.empty()) return operand;
  } else if (empty(span) || place.text[span.begin] != '[') {
    operand.why = is_name(place.text, span)
                      ? fmt::format("the target '{}' is not in this file", part(place.text, span))
                      : "the target is computed at run time";
    return operand;
  }
  const auto list = rapid_list_at(place.text, operand.numbers.begin, operand.numbers.end);
  const bool whole = list && list->span.end == operand.numbers.end;
  operand.malformed = place.text[operand.numbers.begin] == '[' && (!whole || !is_robtarget(*list));
  const auto target = whole && !operand.malformed ? rapid_target(place.text, *list) : std::nullopt;
  if (target) operand.configuration = rapid_word(part(place.text, list->items[2].span));
  if (target)
    operand.target = *target;
  else
    operand.why = "the target is computed at run time";
  return operand;
}

OrientationNumbers quaternion_of(const RobotTarget& target) {
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = target.orientation[i]->value;
  return numbers;
}

/// Offs displaces a target along the axes of the work object, RelTool along those of the tool.
RapidOperand derived_operand(const RapidPlace& place, Span span, const std::vector<Span>& arguments,
                             bool in_tool) {
  RapidOperand operand = plain_operand(place, arguments[0]);
  operand.form = RapidOperand::Form::derived;
  operand.span = span;
  if (!operand.why.empty() || operand.malformed) return operand;
  Vector3 d_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = number_at(place.text, arguments[i + 1].begin);
    if (!number || number->span.end != arguments[i + 1].end) {
      operand.why =
          fmt::format("the displacement of {} is computed at run time", in_tool ? "RelTool" : "Offs");
      return operand;
    }
    d_mm[static_cast<Eigen::Index>(i)] = number->value;
  }
  if (in_tool) d_mm = rotation_of(OrientationForm::quaternion, quaternion_of(operand.target)) * d_mm;
  for (std::size_t i = 0; i < 3; ++i) operand.target.position[i]->value += d_mm[static_cast<Eigen::Index>(i)];
  return operand;
}

}  // namespace

RapidDisplacement rapid_displacement(std::string_view text, Span span) {
  constexpr std::size_t with_displacement = 4;
  for (const bool in_tool : {false, true}) {
    std::vector<Span> arguments = arguments_of(text, span, in_tool ? "RELTOOL" : "OFFS");
    if (arguments.size() == with_displacement) return {std::move(arguments), in_tool};
  }
  return {};
}

RapidOperand rapid_operand(const RapidPlace& place, Span span) {
  const auto [arguments, in_tool] = rapid_displacement(place.text, span);
  return arguments.empty() ? plain_operand(place, span) : derived_operand(place, span, arguments, in_tool);
}

std::optional<JointPlace> rapid_joints(const RapidPlace& place, Span span) {
  const Literal literal = literal_at(place, span);
  if (!literal.list || literal.list->items.size() != 2) return std::nullopt;
  const auto axes = numbers_of_list<6>(literal.text, literal.list->items[0]);
  const auto external = numbers_of_list<6>(literal.text, literal.list->items[1]);
  if (!axes || !external) return std::nullopt;
  JointPlace joints;
  for (std::size_t i = 0; i < axes->size(); ++i) {
    joints.joints[i] = (*axes)[i] * deg;
    if ((*external)[i] < rapid_not_connected) joints.external[i] = (*external)[i];
  }
  return joints;
}

double rapid_speed(const RapidPlace& place, Span span) {
  constexpr double mm_min = 60;  // in 1 mm/s
  const Literal literal = literal_at(place, span);
  if (literal.list) {
    const auto numbers = numbers_of_list<4>(literal.text, *literal.list);
    return numbers ? mm_min * (*numbers)[0] : 0;
  }
  const auto number = number_behind(rapid_word(part(place.text, span)), 'V');
  return number && contains(speeds, *number) && datum_at(place, span) == nullptr ? mm_min * *number : 0;
}

RapidZone rapid_zone(const RapidPlace& place, Span span) {
  const Literal literal = literal_at(place, span);
  if (literal.list) {
    constexpr std::size_t components = 7;
    const auto& items = literal.list->items;
    if (items.size() != components) return {};
    const auto stops = flag_of(literal.text, items[0]);
    const auto radius_mm = number_of(literal.text, items[1]);
    return stops && !*stops && radius_mm ? RapidZone{true, *radius_mm} : RapidZone{};
  }
  const auto number = number_behind(rapid_word(part(place.text, span)), 'Z');
  if (!number || !contains(zones, *number) || datum_at(place, span) != nullptr) return {};
  return {true, *number == 0 ? smallest_zone_mm : *number};
}

std::string rapid_zone_within(double radius_mm) {
  if (radius_mm >= smallest_zone_mm) {
    std::size_t i = zones.size() - 1;
    while (i > 0 && zones[i] > radius_mm) --i;
    return std::string(zone_names[i]);
  }
  constexpr double step_mm = 1e-4;
  const double size = std::max(std::floor(radius_mm / step_mm + 1e-6), 1.0) * step_mm;
  return fmt::format("[FALSE,{0:.6g},{0:.6g},{0:.6g},{1:.6g},{0:.6g},{1:.6g}]", size, size / 10);
}

RapidFrame rapid_tool(const RapidPlace& place, Span span) {
  RapidFrame tool{.name = rapid_word(part(place.text, span))};
  const RapidDatum* datum = datum_at(place, span);
  if (datum == nullptr && !is_name(place.text, span)) tool.why = "the tool is selected at run time";
  if (datum == nullptr && tool.name == "TOOL0") tool.pose_mm = Pose{};
  if (datum == nullptr) return tool;
  tool.why = why_unknown(*datum, "tool");
  const Literal literal = literal_at(place, span);
  if (!literal.list || literal.list->items.empty()) return tool;
  tool.held = flag_of(literal.text, literal.list->items[0]);
  if (literal.list->items.size() > 1) tool.pose_mm = pose_of(literal.text, literal.list->items[1]);
  return tool;
}

RapidFrame rapid_work_object(const RapidPlace& place, Span span) {
  constexpr std::size_t components = 5;  // robhold, ufprog, ufmec, uframe, oframe
  RapidFrame object{.name = std::string(part(place.text, span))};
  const RapidDatum* datum = datum_at(place, span);
  const bool is_world = datum == nullptr && (empty(span) || rapid_word(object.name) == "WOBJ0");
  if (is_world) return {.name = "wobj0", .pose_mm = Pose{}};
  if (datum == nullptr && !is_name(place.text, span)) object.why = "the work object is selected at run time";
  if (datum == nullptr) return object;
  object.name = datum->name;
  object.why = why_unknown(*datum, "work object");
  const Literal literal = literal_at(place, span);
  if (!literal.list || literal.list->items.size() != components) return object;
  const auto& items = literal.list->items;
  object.held = flag_of(literal.text, items[0]);
  const auto user = pose_of(literal.text, items[3]), own = pose_of(literal.text, items[4]);
  if (user && own) object.pose_mm = *user * *own;
  if (flag_of(literal.text, items[1]) == false)
    object.why = fmt::format("a mechanical unit moves the work object '{}'", datum->name);
  return object;
}

}  // namespace counterflex
