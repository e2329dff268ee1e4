#pragma once
/// What tests of laws share: machines at hand, random poses and loads with fixed seeds, central differences.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <random>
#include <string>
#include <vector>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex::laws {

/// A machine, and how far from home and how hard it is tried.
struct Trial {
  std::string name;                  ///< of its file in tests/statics/data
  double reach = 0;                  ///< m, of each controlled coordinate about `centre`
  double turn = 0;                   ///< rad
  double force = 0;                  ///< N
  double moment = 0;                 ///< N m
  Vector3 centre = Vector3::Zero();  ///< from the home tip (m)
};

/// Machines whose tip is controlled in as many components as they have actuators.
inline std::vector<Trial> controlled_machines() {
  return {{"orthoglide_case_a", 0.09, 0, 200, 10, {0.02, 0.02, 0.02}},
          {"orthoglide_case_b", 0.09, 0, 200, 10, {0.02, 0.02, 0.02}},
          {"hexapod_free_joints", 0.08, 0.2, 600, 30},
          {"hexapod_joint_springs", 0.08, 0.2, 600, 30},
          {"serial6r_joints", 0.15, 0.2, 800, 60},
          {"serial6r_link6", 0.15, 0.2, 800, 60},
          {"laws_mixed", 0.03, 0.06, 150, 8}};
}

inline double largest_component(const Vector3& v) {
  return v.cwiseAbs().maxCoeff();
}

inline Machine machine_of(const std::string& name) {
  return load_machine(COUNTERFLEX_SOURCE_DIR "/tests/statics/data/" + name + ".toml");
}

inline Model model_of(const std::string& name) {
  return prepare(machine_of(name));
}

/// A model from the text of a machine file.
inline Model model_of_text(const std::string& text) {
  return prepare(read_machine("format = \"counterflex-machine 1\"\nname = \"test\"\n" + text, "test.toml"));
}

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  std::mt19937 engine;
  // Not std::uniform_real_distribution: its numbers differ between libraries.
  double number() {
    return 2.0 * static_cast<double>(engine()) / static_cast<double>(std::mt19937::max()) - 1.0;
  }
  // In this order for every compiler.
  Vector3 vector(double size) {
    const double x = number(), y = number(), z = number();
    return size * Vector3(x, y, z);
  }
  Vector6 six(double first, double last) {
    Vector6 v;
    v << vector(first), vector(last);
    return v;
  }
  Load load(const Trial& trial) { return {six(trial.force, trial.moment), number() > 0}; }
};

/// A tip pose about the home tip, and the nominal configuration there. Fails the test where no such
/// configuration exists.
inline NominalResult somewhere(const Model& model, const Trial& trial, Random& random) {
  const Pose home = tip(model.mechanism, model.home);
  Vector6 step = random.six(trial.reach, trial.turn);
  step.head<3>() += trial.centre;
  NominalResult result = follow(model, model.home, moved(home, step));
  REQUIRE(result.status == Status::converged);
  return result;
}

/// f'(0) from four points, exact to h^4: (8 (f(h) - f(-h)) - (f(2h) - f(-2h))) / 12h.
template <class Function>
auto central_difference(const Function& f, double h) {
  return decltype(f(h))((8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h));
}

/// The twist of a pose, by the same formula from (v, w) between f(-h) and f(h).
template <class Function>
Vector6 pose_difference(const Function& f, double h) {
  return (8 * difference(f(h), f(-h)) - difference(f(2 * h), f(-2 * h))) / (12 * h);
}

inline Vector6 unit(int k) {
  return Vector6::Unit(k);
}

/// Largest entry of a matrix in units of l and N: rows of wrenches and columns of twists made alike.
inline double size_in_units(const Matrix6& K, double l) {
  const Vector6 u = (Vector6() << 1, 1, 1, 1 / l, 1 / l, 1 / l).finished();
  return (u.asDiagonal() * K * u.asDiagonal()).cwiseAbs().maxCoeff();
}

}  // namespace counterflex::laws
