#pragma once
/// Waypoints solved by the kernel, and each of them by the solver of single waypoints, to compare.
#include "kernel/batch.hpp"
#include "kernel/cells/start_cell.hpp"
#include "kernel/machine/flatten.hpp"
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
  std::vector<unsigned char> accepted;
  std::vector<int> iterations;
  std::vector<double> actuators, tips, nominal_tips, states, pivots;
  int rigid_closures = 0;

  Eigen::VectorXd rho(std::size_t w) const {
    const std::size_t n = actuators.size() / accepted.size();
    return Eigen::Map<const Eigen::VectorXd>(actuators.data() + w * n, static_cast<Eigen::Index>(n));
  }
  /// Of unstable directions, actuators held.
  long negative_pivots(std::size_t w) const {
    const auto n = static_cast<std::ptrdiff_t>(pivots.size() / accepted.size()),
               first = n * static_cast<std::ptrdiff_t>(w);
    return std::count_if(pivots.begin() + first, pivots.begin() + first + n, [](double x) { return x < 0; }) -
           6 * rigid_closures;
  }
  Pose tip(std::size_t w) const { return pose_of(tips, w); }
  Pose nominal_tip(std::size_t w) const { return pose_of(nominal_tips, w); }

 private:
  static Pose pose_of(const std::vector<double>& numbers, std::size_t w) {
    Pose X;
    for (int i = 0; i < 9; ++i) X.R(i / 3, i % 3) = numbers[12 * w + static_cast<std::size_t>(i)];
    for (int i = 0; i < 3; ++i) X.p[i] = numbers[12 * w + 9 + static_cast<std::size_t>(i)];
    return X;
  }
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
                      const kernel::Schedule& schedule = {}) const {
    const std::size_t n = waypoints.size(), actuators = model.mechanism.travel.size();
    const kernel::FlatMachine& machine = problem.machine();
    const auto states = static_cast<std::size_t>(machine.state_size());
    std::vector<double> p, R, F, rho, start, nominal_start;
    for (const KernelWaypoint& w : waypoints) {
      for (int i = 0; i < 3; ++i) p.push_back(w.X_MT.p[i]);
      for (int i = 0; i < 9; ++i) R.push_back(w.X_MT.R(i / 3, i % 3));
      for (int i = 0; i < 6; ++i) F.push_back(w.F[i]);
      rho.insert(rho.end(), w.rho.begin(), w.rho.end());
      start.insert(start.end(), w.start.begin(), w.start.end());
      nominal_start.insert(nominal_start.end(), w.nominal_start.begin(), w.nominal_start.end());
    }
    KernelAnswers a;
    a.accepted.resize(n), a.iterations.resize(n), a.actuators.resize(n * actuators);
    a.tips.resize(12 * n), a.nominal_tips.resize(12 * n), a.states.resize(n * states);
    a.pivots.resize(n * static_cast<std::size_t>(machine.pivots()));
    a.rigid_closures = machine.rigid_closures;
    kernel::Batch batch;
    batch.count = static_cast<int>(n);
    batch.p = p.data(), batch.R = R.data(), batch.F = F.data(), batch.rho = rho.data();
    batch.start = start.data(), batch.start_stride = static_cast<long>(start.size() / n);
    batch.nominal_start = nominal_start.data();
    batch.nominal_start_stride = static_cast<long>(nominal_start.size() / n);
    std::vector<const kernel::StartCell*> cells, nominal_cells;
    for (const KernelWaypoint& w : waypoints) cells.push_back(w.cell);
    if (!cells.empty() && cells[0] != nullptr) {
      batch.start = batch.nominal_start = nullptr;
      batch.cells = cells.data();
      for (const KernelWaypoint& w : waypoints) nominal_cells.push_back(w.nominal_cell);
      batch.nominal_cells = nominal_cells.data();
    }
    batch.accepted = a.accepted.data(), batch.iterations = a.iterations.data(),
    batch.actuators = a.actuators.data();
    batch.tip = a.tips.data(), batch.nominal_tip = a.nominal_tips.data(), batch.state = a.states.data(),
    batch.pivots = a.pivots.data();
    instance.solve(problem, schedule, batch);
    return a;
  }
};

}  // namespace counterflex::laws
