#include "machine/describe/describe_elements.hpp"

#include <fmt/format.h>

#include <cmath>

#include "machine/describe/phrases.hpp"

namespace counterflex {
namespace {

template <class... Cases>
struct Match : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Match(Cases...) -> Match<Cases...>;  // Clang 14 does not deduce it

struct Line {
  std::string kind;
  std::string what;
};

std::string starting(const Joint& joint, double home) {
  return home == 0 ? "" : ", starts at " + phrase_value(joint, home);
}

std::string resting(const Passive& passive) {
  if (passive.stiffness == 0) return "";
  const std::string rest =
      passive.rest_at_home ? "the home configuration" : phrase_value(passive.joint, passive.rest);
  return fmt::format(", spring of {} at rest at {}", phrase_stiffness(passive.joint, passive.stiffness),
                     rest);
}

std::string passive_range(const Passive& passive) {
  if (!std::isfinite(passive.min) && !std::isfinite(passive.max)) return "";
  return ", " + phrase_range(passive.joint, passive.min, passive.max);
}

Line line_of(const Actuator& a, ActuatorNumbers& numbers) {
  const std::string what = fmt::format("{}, {}", phrase(a.joint), phrase_range(a.joint, a.min, a.max));
  if (a.program_axis > 0)
    return {fmt::format("axis E{}", a.program_axis),
            fmt::format("{}, at {} unless the program gives it", what, phrase_value(a.joint, a.home))};
  const int number = ++numbers.last;
  const std::string start = starting(a.joint, numbers.shown_homes[number - 1]), shown = phrase_shown(a);
  return {fmt::format("actuator {}", number), what + start + (shown.empty() ? "" : ", " + shown)};
}

Line line_of(const Element& element, ActuatorNumbers& numbers) {
  return std::visit(
      Match{
          [](const Rigid& rigid) {
            return Line{"rigid", is_identity(rigid.X) ? "identity" : phrase(rigid.X)};
          },
          [](const AssemblyError& error) {
            return Line{"error", error.name + ": " + phrase(error.X)};
          },
          [&](const Actuator& a) { return line_of(a, numbers); },
          [](const Passive& p) {
            return Line{"passive",
                        phrase(p.joint) + passive_range(p) + starting(p.joint, p.home) + resting(p)};
          },
          [](const Spring& spring) {
            return Line{"spring", spring.name};
          },
          [](const Compliance& c) {
            std::string text = phrase(c.joint) + ", " + phrase_stiffness(c.joint, c.stiffness);
            if (c.beyond)
              text += fmt::format(", above {:.6g} {} {}", c.beyond->knee,
                                  c.joint.kind == JointKind::prismatic ? "N" : "N m",
                                  phrase_stiffness(c.joint, c.beyond->stiffness));
            return Line{"compliance", text};
          },
          [](const Group& group) {
            return Line{"parallel", counted(static_cast<int>(group.branches.size()), "branch", "branches")};
          },
          [](const PointMass& mass) {
            return Line{"mass", phrase_mass(mass.kg) + " at " + phrase_mm(mass.at)};
          },
      },
      element);
}

}  // namespace

void describe_elements(const std::vector<Element>& elements, int indent, ActuatorNumbers& numbers,
                       std::string& text) {
  int number = 0;
  for (const Element& element : elements) {
    const Line line = line_of(element, numbers);
    // A mass is in the entry of the element before it.
    const std::string place = std::holds_alternative<PointMass>(element) ? "" : fmt::format("{}", ++number);
    text += fmt::format("{:{}}{:>2}  {:<12} {}\n", "", indent, place, line.kind, line.what);
    const auto* group = std::get_if<Group>(&element);
    if (group == nullptr) continue;
    for (const Branch& branch : group->branches) {
      text += fmt::format("{:{}}branch {}\n", "", indent + 6, branch.name);
      describe_elements(branch.elements, indent + 6, numbers, text);
    }
  }
}

}  // namespace counterflex
