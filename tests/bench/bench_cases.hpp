#pragma once
/// The machines that are timed, each with a line of waypoints in the middle of its work and a load.
#include <string>
#include <vector>

#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex::bench {

inline constexpr Stage all{1, 1, 1, 1};

/// (215, -10, -25) N, (1, 21.5, 0) N m: the milling experiment of the paper, used on every machine.
inline Load milling_load() {
  Load load;
  load.F << 215, -10, -25, 1, 21.5, 0;
  return load;
}

/// A machine, and waypoints on a straight line: wanted poses with their nominal configurations.
struct Case {
  Model model;
  std::vector<Pose> wanted;
  std::vector<Configuration> nominal;
  std::string failure;  ///< not empty where a waypoint has no nominal configuration
};

using CaseOf = const Case& (*)();

inline std::string data_file(const std::string& name) {
  return std::string(COUNTERFLEX_SOURCE_DIR) + "/" + name;
}

/// 41 waypoints from `from` to `to`, both relative to the home position of the tip (mm).
inline Case line_case(const std::string& file, const Vector3& from, const Vector3& to) {
  constexpr int steps = 40;
  Case c{prepare(load_machine(data_file(file))), {}, {}, {}};
  const Pose home = tip(c.model.mechanism, c.model.home);
  NominalPath path(c.model, c.model.home);
  for (int i = 0; i <= steps; ++i) {
    const Pose X_MT{home.R, home.p + 1e-3 * (from + (to - from) * i / steps)};
    const Status status = path.go_to(X_MT);
    if (status != Status::converged) c.failure = std::string(to_string(status));
    c.wanted.push_back(X_MT);
    c.nominal.push_back(path.configuration());
  }
  return c;
}

/// The milling line of the paper, Q2 to Q5.
inline const Case& orthoglide() {
  static const Case c = line_case("tests/statics/data/orthoglide_case_b.toml",
                                  Vector3(-73.65, -73.65, -73.65), Vector3(-73.65, 126.35, -73.65));
  return c;
}
inline const Case& hexapod() {
  static const Case c =
      line_case("tests/statics/data/hexapod_joint_springs.toml", Vector3(-60, -40, 0), Vector3(60, 40, 30));
  return c;
}
inline const Case& robot_6r() {
  static const Case c =
      line_case("tests/statics/data/serial6r_joints.toml", Vector3(0, -100, 0), Vector3(0, 100, 0));
  return c;
}
/// Its links weigh 0.76 t.
inline const Case& robot_masses() {
  static const Case c =
      line_case("samples/robot-spindle/machine.toml", Vector3(0, -100, 0), Vector3(0, 100, 0));
  return c;
}
inline const Case& mill() {
  static const Case c =
      line_case("samples/mill3/machine.toml", Vector3(150, 100, -40), Vector3(210, 140, -46));
  return c;
}

}  // namespace counterflex::bench
