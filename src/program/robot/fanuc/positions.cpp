#include "program/robot/fanuc/positions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::string_view tp_axes = "XYZ", tp_angles = "WPR";  // about X, Y, Z

/// "X = 1.0 mm", "UF : 5", "CONFIG : 'N U T, 0, 0, 0'".
struct TpComponent {
  std::string name;  ///< in upper case
  Span value;        ///< without blanks around it
};

/// Reads the components of a position one after the other.
class Components {
 public:
  Components(const std::string& file, std::string_view text, const TpPosition& position)
      : file_(file), text_(text), position_(position) {
    const std::size_t brace = text.find('{', position.span.begin);
    if (brace >= position.span.end)
      fail(position.span.begin, "the position has no '{' before its '}'; write P[1]{ ... };");
    at_ = brace + 1;
  }

  /// The next group "GP1:" or component. False behind the last one.
  bool next(TpComponent& component, int& group) {
    for (;;) {
      while (is_tp_space(text_[at_]) || text_[at_] == ',') ++at_;
      if (text_[at_] == '}') return false;
      Span name{at_, at_};
      while (is_identifier_character(text_[name.end])) ++name.end;
      component.name = tp_word(part(text_, name));
      at_ = name.end;
      while (is_tp_space(text_[at_])) ++at_;
      const bool is_group = component.name.starts_with("GP") && text_[at_] == ':';
      if (empty(name) || (text_[at_] != ':' && text_[at_] != '='))
        fail(name.begin, fmt::format("'{}' is not a part of a position; write X = 1.0 mm",
                                     part(text_, {name.begin, at_ + 1})));
      ++at_;
      if (!is_group) break;
      const auto number = tp_integer(component.name, 2);
      group = number ? static_cast<int>(std::min(number->value, 99L)) : 0;
    }
    component.value = value();
    return true;
  }

  [[noreturn]] void fail(std::size_t at, const std::string& message) const {
    RobotLine line;
    line.line_end.end = position_.span.begin;
    line.line = position_.line - 1;
    const std::size_t newline = text_.rfind('\n', position_.span.begin);
    line.line_end.end = newline == std::string_view::npos ? 0 : newline + 1;
    while (next_physical_line(text_, line) && line.line_end.end <= at && line.line_end.end < text_.size()) {
    }
    refuse(file_, line, at, message);
  }

 private:
  /// Up to a comma that is outside of quotes, a group or the end.
  Span value() {
    while (is_tp_space(text_[at_])) ++at_;
    Span value{at_, at_};
    bool quoted = false;
    for (; quoted || (text_[at_] != ',' && text_[at_] != '}' && !begins_group()); ++at_) {
      if (text_[at_] == '}') fail(value.begin, "the text in quotes does not end");
      if (text_[at_] == '\'') quoted = !quoted;
      if (!is_tp_space(text_[at_])) value.end = at_ + 1;
    }
    return value;
  }

  bool begins_group() const {
    return is_tp_space(text_[at_ - 1]) && text_.substr(at_, 2) == "GP" && is_digit(text_[at_ + 2]);
  }

  const std::string& file_;
  std::string_view text_;
  const TpPosition& position_;
  std::size_t at_ = 0;
};

/// The number of a component with its unit.
RobotNumber number_of(const Components& components, std::string_view text, const TpComponent& component,
                      std::string_view unit) {
  const Span value = component.value;
  if (part(text, value).find('*') != std::string_view::npos)
    components.fail(value.begin,
                    fmt::format("'{}' of the position is not recorded ({}); record the position, or remove "
                                "the motion",
                                component.name, part(text, value)));
  Span digits{value.begin, value.begin};
  while (digits.end < value.end && !is_tp_space(text[digits.end]) && !(is_letter(text[digits.end])))
    ++digits.end;
  auto number = number_at(text.substr(0, digits.end), digits.begin);
  if (!number || number->span.end != digits.end)
    components.fail(value.begin, fmt::format("'{}' of the position has no number: '{}'; write {} = 1.0 {}",
                                             component.name, part(text, value), component.name, unit));
  const std::string given = tp_word(part(text, {digits.end, value.end}));
  const bool any = unit.empty() && (given == "MM" || given == "DEG");
  if (!any && given != tp_word(unit))
    components.fail(value.begin, fmt::format("'{}' of the position has the unit '{}'; it must be {}",
                                             component.name, given, unit.empty() ? "mm or deg" : unit));
  return *number;
}

/// UF, UT: a number, or F for the one that is selected.
std::optional<long> selection_of(const Components& components, std::string_view text,
                                 const TpComponent& component) {
  if (tp_word(part(text, component.value)) == "F") return std::nullopt;
  const auto number = tp_integer(text, component.value.begin);
  if (!number || number->end != component.value.end)
    components.fail(component.value.begin,
                    fmt::format("'{}' of the position is '{}'; it must be a number or F", component.name,
                                part(text, component.value)));
  return number->value;
}

/// Index of a component of one letter in `letters`, or npos.
std::size_t index_in(std::string_view letters, const std::string& name) {
  return name.size() == 1 ? letters.find(name[0]) : std::string_view::npos;
}

/// n - 1 of "E2" and "J3".
std::size_t axis_of(const std::string& name) {
  return static_cast<std::size_t>(name[1] - '1');
}

bool is_numbered(const std::string& name, char letter, char last) {
  return name.size() == 2 && name[0] == letter && name[1] >= '1' && name[1] <= last;
}

void read_component(const Components& components, std::string_view text, const TpComponent& component,
                    TpPoint& point) {
  const std::string& name = component.name;
  const std::size_t axis = index_in(tp_axes, name), angle = index_in(tp_angles, name);
  if (axis != std::string_view::npos)
    point.target.position[axis] = number_of(components, text, component, "mm");
  else if (angle != std::string_view::npos)
    point.target.orientation[angle] = number_of(components, text, component, "deg");
  else if (name == "UF")
    point.frame = selection_of(components, text, component);
  else if (name == "UT")
    point.tool = selection_of(components, text, component);
  else if (name == "CONFIG")
    point.configuration = tp_word(part(text, component.value));
  else if (is_numbered(name, 'E', '6'))
    point.target.external[axis_of(name)] = number_of(components, text, component, "").value;
  else if (is_numbered(name, 'J', '9'))
    point.joints[axis_of(name)] = number_of(components, text, component, "").value;
  else
    components.fail(component.value.begin,
                    fmt::format("'{}' of the position is not known; use UF, UT, CONFIG, X, Y, Z, W, P, R, E1 "
                                "to E6 or J1 to J9",
                                name));
}

bool is_complete(const TpPoint& point) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!point.target.position[i] || !point.target.orientation[i]) return false;
  return true;
}

}  // namespace

TpPoint tp_point(const std::string& file, std::string_view text, const TpPosition& position) {
  TpPoint point;
  Components components(file, text, position);
  TpComponent component;
  int group = 1;
  while (components.next(component, group)) {
    if (group == 1)
      read_component(components, text, component, point);
    else if (component.name != "UF" && component.name != "UT" && component.name != "CONFIG")
      point.other_groups.push_back(number_of(components, text, component, "").value);
  }
  point.joint = std::ranges::any_of(point.joints, [](const auto& joint) { return joint.has_value(); });
  if (!point.joint && !is_complete(point))
    components.fail(position.span.begin, "the position needs X, Y, Z, W, P and R, or J1 to J6, of group GP1");
  return point;
}

}  // namespace counterflex
