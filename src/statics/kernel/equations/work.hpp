#pragma once
/// What one solve of the kernel works on: the state, the equations at it, the factors of their tangent, and a
/// step.
#include <vector>

#include "statics/kernel/equations/spatial.hpp"
#include "statics/kernel/machine/flat_machine.hpp"
#include "statics/model/tolerances.hpp"

namespace counterflex::kernel {

inline constexpr int most_actuators_of_series = 12;

/// A machine, and what acts on it.
struct Question {
  const FlatMachine* machine = nullptr;
  /// Rigid transforms, with as much of the errors as acts.
  const std::vector<Transform>* transforms = nullptr;
  double load = 1, preload = 1, gravity = 1;  ///< how much of them acts
  double errors = 1;                          ///< and of the errors of motion

  bool operator==(const Question&) const = default;
};

/// The kinematics of a rigid machine without errors, of which `transforms` are.
inline Question nominal_question(const FlatMachine& rigid, const std::vector<Transform>& transforms) {
  return {.machine = &rigid, .transforms = &transforms, .load = 0, .preload = 0, .gravity = 0};
}

/// Unknowns. Positions are from the common point, the wanted tip.
template <class T>
struct JointState {
  T q, cosine, sine;
};
template <class T>
struct State {
  std::vector<JointState<T>> joints;  ///< of actuators, too
  std::vector<Frame<T>> nodes;
  Frame<T> platform;
};

template <class T>
struct JointTerms {
  Vec6<T> s;  ///< screw
  T r;        ///< residual (N, N m)
  T y;        ///< of the step: what is condensed, then the joint's step
};

template <class T>
struct ElementTerms {
  /// Gradient of its energy with respect to its end's twist: minus the wrench on what is behind.
  Vec6<T> phi;
  Vec6<T> stress;   ///< the phi with which tangents are made
  Vec3<T> p, turn;  ///< of a spring: place of its end; rotation vector of its deflection, in axes of R
  Mat3<T> R;        ///< of the frame at its start; not set for an isotropic spring, whose axes are those of M
};

/// The gradient of energy at a state, and the error of the tip.
template <class T>
struct Equations {
  std::vector<JointTerms<T>> joints;
  std::vector<ElementTerms<T>> elements;
  std::vector<Vec6<T>> nodes;    ///< residuals
  std::vector<Vec6<T>> hanging;  ///< by weight: gradients of those that are steps
  std::vector<Vec6<T>> ends;     ///< by series: wrench on its end
  Vec6<T> platform;              ///< residual
  Frame<T> tip;
  Vec6<T> tip_error;       ///< wanted less actual, in controlled components
  T largest_force;         ///< of the residuals (N; moments divided by l)
  T largest_wrench;        ///< of what acts on the platform (N; moments divided by l)
  T largest_turn_squared;  ///< of the springs (rad^2)
};

template <class T>
struct JointFactor {
  Vec6<T> u;  ///< its column over its pivot
  T inverse;  ///< of the pivot; zero where the joint turns freely about itself
};

template <class T>
struct NodeFactor {
  Sym6<T> L;
  T W[36];  ///< M^-1 (K + Lambda / 2), row by row
};

/// The tangent, eliminated block by block down to the platform.
template <class T>
struct Factors {
  std::vector<JointFactor<T>> joints;
  std::vector<NodeFactor<T>> nodes;
  std::vector<T> couplings;           ///< of joints to actuators, over the joints' pivots
  std::vector<Vec6<T>> node_columns;  ///< of nodes to actuators: most_actuators of them for each node
  std::vector<Vec6<T>> actuators;     ///< by actuator: its column on the platform
  Sym6<T> K;                          ///< of the platform
  Sym6<T> L;                          ///< K, factored
  std::vector<Vec6<T>> responses;     ///< by actuator: K^-1 times its column
};

template <class T>
struct Step {
  std::vector<Vec6<T>> nodes;
  std::vector<T> actuators;
  Vec6<T> platform;
  T size;  ///< largest component (m; angles times l)
  T turn;  ///< largest angle (rad)
};

template <class T>
struct Work {
  const FlatMachine& machine;
  State<T> state{};
  Equations<T> equations{};
  Factors<T> factors{};
  Step<T> step{};
  Question question{};
  Vec3<T> origin{};  ///< the common point in M
  Mat3<T> wanted_R{};
  Vec6<T> load{};                       ///< wrench at the machine's arm, axes of M
  std::vector<Vec6<T>> start_stress{};  ///< by element, as in StartCell
  std::vector<T> lag{};                 ///< by actuator: joint less commanded value; empty: nothing
  bool stressed = false;                ///< the tangent has the stress of its elements
  bool moves_actuators = false;         ///< they are unknowns
  bool predicts_stress = false;         ///< the next tangent takes the stress that this step predicts_stress

  explicit Work(const FlatMachine& m) : machine(m) {
    const auto joints = static_cast<std::size_t>(m.joints), nodes = static_cast<std::size_t>(m.nodes);
    const auto actuators = m.actuator_joint.size();
    state.joints.resize(joints), state.nodes.resize(nodes);
    start_stress.resize(m.elements.size());
    equations.joints.resize(joints), equations.elements.resize(m.elements.size()),
        equations.nodes.resize(nodes);
    equations.hanging.resize(m.weights.size()), equations.ends.resize(m.series.size());
    factors.joints.resize(joints), factors.nodes.resize(nodes);
    factors.couplings.resize(static_cast<std::size_t>(m.couplings));
    factors.node_columns.resize(nodes * static_cast<std::size_t>(m.most_actuators));
    factors.actuators.resize(actuators), factors.responses.resize(actuators);
    step.nodes.resize(nodes), step.actuators.resize(actuators);
  }
};

/// Indices of the flat machine are ints.
template <class Vector>
COUNTERFLEX_INLINE auto& at(Vector& vector, int i) {
  return vector[static_cast<std::size_t>(i)];
}

}  // namespace counterflex::kernel
