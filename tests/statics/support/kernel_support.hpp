#pragma once
/// Waypoints solved by the kernel, and each of them by the solver of single waypoints, to compare.
#include "kernel/cells/start_cell.hpp"
#include "kernel/machine/states.hpp"
#include "statics/support/laws_weights.hpp"

namespace counterflex::laws {

/// The kernel's input at one waypoint, and its result.
struct KernelWaypoint {
  Configuration nominal;  ///< the start
  Pose X_MT;              ///< wanted tip
  Vector6 F = Vector6::Zero();
  std::vector<double> start{}, nominal_start{};
  Eigen::VectorXd rho{};                                             ///< actuators, where they are held
  const kernel::StartCell *cell = nullptr, *nominal_cell = nullptr;  ///< instead of `start`
};

struct KernelAnswers {
  kernel::Batch batch;
  int rigid_closures = 0;

  bool accepted(std::size_t w) const { return batch.accepted[w] != 0; }
  Eigen::VectorXd rho(std::size_t w) const {
    const std::size_t n = batch.actuators.size() / batch.accepted.size();
    return Eigen::Map<const Eigen::VectorXd>(batch.actuators.data() + w * n, static_cast<Eigen::Index>(n));
  }
  /// Of unstable directions, actuators held.
  long negative_pivots(std::size_t w) const {
    const auto n = static_cast<std::ptrdiff_t>(batch.pivots.size() / batch.accepted.size()),
               first = n * static_cast<std::ptrdiff_t>(w);
    const auto begin = batch.pivots.begin() + first;
    return std::count_if(begin, begin + n, [](double x) { return x < 0; }) - 6 * rigid_closures;
  }
  Pose tip(std::size_t w) const { return kernel::get_pose(&batch.tip[12 * w]); }
  Pose nominal_tip(std::size_t w) const { return kernel::get_pose(&batch.nominal_tip[12 * w]); }
};

/// A machine with its flat form.
struct FlatBench {
  Model model;
  kernel::Flat flat, rigid;
  std::vector<kernel::Transform> perfect, real, rigid_transforms;
  StaticsWork work{model.mechanism};

  explicit FlatBench(Model m)
      : model(std::move(m)),
        flat(kernel::flatten(model.mechanism, false)),
        rigid(kernel::flatten_rigid(model.mechanism)) {
    rigid_transforms = kernel::transforms_at(rigid, 0);
    perfect = kernel::transforms_at(flat, 0);
    real = kernel::transforms_at(flat, 1);
  }
  FlatBench(const FlatBench&) = delete;

  kernel::Question question(const Stage& stage = {}) const {
    kernel::Question q{.machine = &flat.machine};
    q.transforms = stage.errors == 0 ? &perfect : &real;
    q.load = stage.load, q.preload = stage.preload, q.gravity = stage.gravity, q.errors = stage.errors;
    return q;
  }
  kernel::Question nominal() const { return kernel::nominal_question(rigid.machine, rigid_transforms); }
  kernel::Problem kinematics() const { return {.real = {}, .nominal = nominal()}; }
  kernel::Problem held(const Stage& stage = {}) const { return {.real = question(stage), .nominal = {}}; }
  /// All controlled components are wanted of the real tip.
  kernel::Problem target(const Stage& stage = {}) const {
    return {.real = question(stage), .nominal = nominal()};
  }

  KernelWaypoint waypoint(const NominalResult& nominal, const Vector6& F) const {
    return {nominal.configuration,
            tip(model.mechanism, nominal.configuration),
            F,
            kernel::state_of(model.mechanism, flat, nominal.configuration, 0),
            kernel::state_of(model.mechanism, rigid, nominal.configuration, 0),
            actuator_values(model.mechanism, nominal.configuration)};
  }

  KernelAnswers solve(const kernel::Problem& problem, const std::vector<KernelWaypoint>& waypoints,
                      const kernel::Instance& instance = kernel::scalar_instance,
                      const kernel::Schedule& schedule = {}, kernel::Solver* solver = nullptr) const {
    kernel::Batch batch;
    for (const KernelWaypoint& w : waypoints) {
      for (int i = 0; i < 3; ++i) batch.p.push_back(w.X_MT.p[i]);
      for (int i = 0; i < 9; ++i) batch.R.push_back(w.X_MT.R(i / 3, i % 3));
      for (int i = 0; i < 6; ++i) batch.F.push_back(w.F[i]);
      batch.rho.insert(batch.rho.end(), w.rho.begin(), w.rho.end());
      if (w.cell != nullptr) {
        batch.cells.push_back(w.cell), batch.nominal_cells.push_back(w.nominal_cell);
        continue;
      }
      batch.start.insert(batch.start.end(), w.start.begin(), w.start.end());
      batch.nominal_start.insert(batch.nominal_start.end(), w.nominal_start.begin(), w.nominal_start.end());
    }
    batch.wants_states = batch.wants_pivots = true;
    kernel::Solver own;
    (solver != nullptr ? *solver : own).solve(problem, schedule, batch, &instance);
    return {std::move(batch), problem.machine().rigid_closures};
  }
};

}  // namespace counterflex::laws
