#pragma once
/// Waypoints that are solved at once, each from a start of its own.
#include "newton.hpp"

namespace counterflex::kernel {

/// Numbers of waypoint after waypoint; what is not asked for may be null.
struct Batch {
  int count = 0;
  const double* p = nullptr;      ///< 3 each: wanted tip, or a place near it (m)
  const double* R = nullptr;      ///< 9 each: wanted orientation, row by row; where it is controlled
  const double* F = nullptr;      ///< 6 each: wrench on the machine (N, N m), axes of M
  const double* rho = nullptr;    ///< commanded actuator values; where no target is asked
  const double* start = nullptr;  ///< states
  long start_stride = 0;          ///< numbers from start to start; 0: all have the same

  unsigned char* accepted = nullptr;
  int* iterations = nullptr;
  double* actuators = nullptr;        ///< commanded values that belong to the solution
  double* tip = nullptr;              ///< 12 each: R row by row, p
  double* state = nullptr;            ///< state_size each
  double* negative_pivots = nullptr;  ///< 0: stable with actuators held
};

/// The kernel for one kind of numbers.
struct Instance {
  void (*solve)(const FlatMachine&, const Question&, const Schedule&, Batch&);
  int lanes;
};

/// The scalar instance, and those of the vectors that the computer has.
extern const Instance scalar_instance;
std::vector<Instance> all_instances();

template <class T>
void put_state(const FlatMachine& machine, int l, const double* numbers, Work<T>& work) {
  for (int j = 0; j < machine.joints; ++j, ++numbers) {
    lane(at(work.state.q, j), l) = *numbers;
    lane(at(work.state.cosine, j), l) = std::cos(*numbers);
    lane(at(work.state.sine, j), l) = std::sin(*numbers);
  }
  const auto put = [&](Frame<T>& X) {
    for (int i = 0; i < 9; ++i) lane(X.R.c[i], l) = *numbers++;
    for (int i = 0; i < 3; ++i) lane(X.p[i], l) = *numbers++ - lane(work.origin[i], l);
  };
  for (Frame<T>& node : work.state.nodes) put(node);
  put(work.state.platform);
}

template <class T>
void get_state(int l, const Work<T>& work, double* numbers) {
  for (const T& q : work.state.q) *numbers++ = lane(q, l);
  const auto get = [&](const Frame<T>& X) {
    for (int i = 0; i < 9; ++i) *numbers++ = lane(X.R.c[i], l);
    for (int i = 0; i < 3; ++i) *numbers++ = lane(X.p[i], l) + lane(work.origin[i], l);
  };
  for (const Frame<T>& node : work.state.nodes) get(node);
  get(work.state.platform);
}

/// Fills the lanes of `work` with waypoints from `first` on; the last waypoint stands in for those that are
/// not there.
template <class T>
void put_waypoints(const Batch& batch, int first, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  for (int l = 0; l < lane_count<T>; ++l) {
    const int w = first + l < batch.count ? first + l : batch.count - 1;
    for (int i = 0; i < 3; ++i) lane(work.origin[i], l) = batch.p[3 * w + i];
    for (int i = 0; i < 6; ++i) lane(work.load[i], l) = batch.F[6 * w + i];
    if (batch.R != nullptr)
      for (int i = 0; i < 9; ++i) lane(work.wanted_R.c[i], l) = batch.R[9 * w + i];
    put_state(machine, l, batch.start + batch.start_stride * w, work);
    if (work.question.target) continue;
    for (int a = 0; a < static_cast<int>(machine.actuator_joint.size()); ++a) {
      const int j = at(machine.actuator_joint, a);
      const double q = batch.rho[static_cast<int>(machine.actuator_joint.size()) * w + a] +
                       work.question.gravity * at(machine.actuator_offset, a);
      lane(at(work.state.q, j), l) = q;
      lane(at(work.state.cosine, j), l) = std::cos(q);
      lane(at(work.state.sine, j), l) = std::sin(q);
    }
  }
}

template <class T>
void solve_batch(const FlatMachine& machine, const Question& question, const Schedule& schedule,
                 Batch& batch) {
  Work<T> work(machine);
  work.question = question;
  const int actuators = static_cast<int>(machine.actuator_joint.size());
  for (int first = 0; first < batch.count; first += lane_count<T>) {
    put_waypoints(batch, first, work);
    const Solved<T> solved = iterate<T>(schedule, work.origin[0] == work.origin[0], work);
    T pivots{};
    if (batch.negative_pivots != nullptr) pivots = count_negative_pivots(work);
    for (int l = 0; l < lane_count<T> && first + l < batch.count; ++l) {
      const int w = first + l;
      batch.accepted[w] = lane_of_mask<T>(solved.accepted, l);
      if (batch.iterations != nullptr) batch.iterations[w] = static_cast<int>(lane(solved.iterations, l));
      if (batch.actuators != nullptr)
        for (int a = 0; a < actuators; ++a)
          batch.actuators[actuators * w + a] = lane(at(work.state.q, at(machine.actuator_joint, a)), l) -
                                               question.gravity * at(machine.actuator_offset, a);
      if (batch.tip != nullptr) {
        for (int i = 0; i < 9; ++i) batch.tip[12 * w + i] = lane(work.equations.tip.R.c[i], l);
        for (int i = 0; i < 3; ++i)
          batch.tip[12 * w + 9 + i] = lane(work.equations.tip.p[i], l) + lane(work.origin[i], l);
      }
      if (batch.state != nullptr)
        get_state(l, work, batch.state + static_cast<long>(machine.state_size()) * w);
      if (batch.negative_pivots != nullptr) batch.negative_pivots[w] = lane(pivots, l);
    }
  }
}

}  // namespace counterflex::kernel
