#pragma once
/// Nominal forward kinematics of imported arms, by the product of the transforms of their elements, and what
/// the tests of all sources check.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/machine/shown.hpp"

namespace counterflex {

/// Pose of the platform in M; `values` of the joints, m or rad.
inline Pose platform_pose(const Machine& machine, const std::vector<double>& values) {
  REQUIRE(machine.chains.size() == 1);
  Pose X;
  std::size_t next = 0;
  for (const Element& element : machine.chains[0].elements) {
    if (const auto* rigid = std::get_if<Rigid>(&element)) X = X * rigid->X;
    const auto* actuator = std::get_if<Actuator>(&element);
    if (actuator == nullptr) continue;
    const double q = values[next++];
    X = X * (actuator->joint.kind == JointKind::revolute ? rotation(exp_so3(actuator->joint.axis * q))
                                                         : translation(actuator->joint.axis * q));
  }
  REQUIRE(next == values.size());
  return X;
}

/// The poses of the imported machine are those of `source` (shown joint values to the pose of the tip) at
/// 1000 random joint vectors.
inline void check_poses(const std::string& text,
                        const std::function<Pose(const std::vector<double>&)>& source,
                        double largest = 1e-9) {
  const Machine machine = read_machine(text, "imported.toml");
  const std::size_t n = actuators(machine).size();
  std::mt19937 random(22);
  std::uniform_real_distribution<double> angle(-3.2, 3.2);
  double position = 0, orientation = 0;
  for (int k = 0; k < 1000; ++k) {
    std::vector<double> shown(n);
    for (double& value : shown) value = angle(random);
    std::vector<double> values(n);
    const std::vector<Actuator> all = actuators(machine);
    for (std::size_t i = 0; i < n; ++i) {
      values[i] = shown[i] - all[i].shown.zero;
      for (const ShownValue::Coupling& coupling : all[i].shown.coupled)
        values[i] -= coupling.factor * shown[coupling.actuator];
      values[i] *= all[i].shown.sign;
    }
    const Vector6 d = difference(platform_pose(machine, values), source(shown));
    position = std::max(position, d.head<3>().norm());
    orientation = std::max(orientation, d.tail<3>().norm());
  }
  MESSAGE("largest difference: " << position << " m, " << orientation << " rad");
  CHECK(position < largest);
  CHECK(orientation < largest);
}

/// The diagnostic of `import`, or "none".
template <class Import>
std::string diagnostic(const Import& import) {
  try {
    import();
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    return error.what();
  }
  return "none";
}

/// `text` with the first `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != text.npos);
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace counterflex
