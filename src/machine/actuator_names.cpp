#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/machine.hpp"
#include "machine/walk.hpp"

namespace counterflex {
namespace {

constexpr double parallel = 1 - 1e-9;    // cosine
constexpr std::size_t least_of_arm = 4;  // rotary actuators in series

const Actuator* numbered(const Element& element) {
  const auto* actuator = std::get_if<Actuator>(&element);
  return actuator != nullptr && actuator->program_axis == 0 ? actuator : nullptr;
}

/// The letter of an actuator whose axis is parallel to a machine axis, with the orientation `R` of the frame
/// before it; 0 for any other.
char letter_of(const Joint& joint, const Matrix3& R) {
  const Vector3 axis = R * joint.axis;
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis[i]) > parallel) return joint.kind == JointKind::prismatic ? "XYZ"[i] : "ABC"[i];
  return 0;
}

/// The letters of a chain's own actuators at home, in their order.
std::string letters_of(const Chain& chain) {
  std::string letters;
  Matrix3 R = Matrix3::Identity();
  const auto turn = [&](const Joint& joint, double home) {
    if (joint.kind == JointKind::revolute) R = R * exp_so3(joint.axis * home);
  };
  for (const Element& element : chain.elements) {
    if (const auto* rigid = std::get_if<Rigid>(&element)) R = R * rigid->X.R;
    if (const auto* passive = std::get_if<Passive>(&element)) turn(passive->joint, passive->home);
    const auto* actuator = std::get_if<Actuator>(&element);
    if (actuator == nullptr) continue;
    if (actuator->program_axis == 0) letters.push_back(letter_of(actuator->joint, R));
    turn(actuator->joint, actuator->home);
  }
  return letters;
}

/// Names of the actuators of a serial machine directly in its chain; empty if they have only numbers.
std::vector<std::string> names_in_series(const Chain& chain) {
  const std::string letters = letters_of(chain);
  std::vector<std::string> names;
  std::vector<bool> rotary;
  for (const Element& element : chain.elements)
    if (const Actuator* actuator = numbered(element))
      rotary.push_back(actuator->joint.kind == JointKind::revolute);
  const bool arm = static_cast<std::size_t>(std::count(rotary.begin(), rotary.end(), true)) >= least_of_arm;
  int turning = 0;
  for (std::size_t i = 0; i < rotary.size(); ++i) {
    const bool alone = letters[i] != 0 && std::count(letters.begin(), letters.end(), letters[i]) == 1;
    if (arm && rotary[i])
      names.push_back(fmt::format("axis A{}", ++turning));
    else
      names.push_back(alone ? fmt::format("axis {}", letters[i]) : "");
  }
  return names;
}

std::size_t count_actuators(const Chain& chain) {
  std::size_t count = 0;
  for_each_element(chain.elements, [&](const Element& element) { count += numbered(element) != nullptr; });
  return count;
}

}  // namespace

std::vector<std::string> actuator_names(const Machine& machine) {
  std::vector<std::string> names;
  for (const Chain& chain : machine.chains) {
    const std::size_t count = count_actuators(chain), first = names.size();
    std::vector<std::string> own;
    if (machine.chains.size() == 1)
      own = names_in_series(chain);
    else if (count == 1)
      own = {fmt::format("chain {}", chain.name)};
    for (std::size_t i = 0; i < count; ++i) {
      const bool named = own.size() == count && !own[i].empty();
      names.push_back(named ? own[i] : fmt::format("actuator {}", first + i + 1));
    }
  }
  return names;
}

}  // namespace counterflex
