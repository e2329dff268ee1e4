#include "counterflex/statics/batch_solver.hpp"

#include <algorithm>
#include <cmath>

#include "start_table.hpp"

namespace counterflex {
namespace {

/// One tangent, with the stress of the cell, does for the steps behind it; late steps have their own. What needs more
/// steps is left to the continuation of single waypoints.
constexpr kernel::Schedule schedule{.tangents = 1U | ~0U << 5, .most = 12, .first = kernel::FirstStress::of_cells};
constexpr double command_tolerance = 1e-12;  // m: of a command whose orientation is home's
constexpr int most_command_rounds = 6;
constexpr double same_branch = 1e-3;  // l or rad: another branch is further away

const kernel::Instance& instance_for(std::size_t count) {
  static const kernel::Instance widest = kernel::all_instances().back();
  return count == 1 ? kernel::scalar_instance : widest;
}

void append(const Vector3& p, std::vector<double>& numbers) { numbers.insert(numbers.end(), p.begin(), p.end()); }

Pose pose_of(const double* numbers) {
  Pose X;
  for (int i = 0; i < 9; ++i) X.R(i / 3, i % 3) = numbers[i];
  for (int i = 0; i < 3; ++i) X.p[i] = numbers[9 + i];
  return X;
}

}  // namespace

/// Waypoints of one question of the kernel, and its answers.
struct KernelBatch {
  std::vector<double> p, place, R, F, rho;
  std::vector<const kernel::StartCell*> cells;
  std::vector<unsigned char> accepted, is_stiff;
  std::vector<int> iterations;
  std::vector<double> tips;

  void solve(const kernel::FlatMachine& machine, const Matrix3& orientation, const kernel::Question& question) {
    const std::size_t count = cells.size(), actuators = machine.actuator_joint.size();
    if (count == 0) return;
    while (R.size() < 9 * count) R.push_back(orientation(static_cast<Eigen::Index>(R.size() % 9 / 3), static_cast<Eigen::Index>(R.size() % 3)));
    F.resize(6 * count);
    rho.resize(actuators * count), tips.resize(12 * count);
    accepted.resize(count), is_stiff.resize(count), iterations.resize(count);
    kernel::Batch batch;
    batch.count = static_cast<int>(count);
    batch.p = p.data(), batch.R = R.data(), batch.F = F.data(), batch.cells = cells.data();
    batch.place = place.empty() ? nullptr : place.data();
    batch.rho = batch.actuators = rho.data();
    batch.accepted = accepted.data(), batch.iterations = iterations.data(), batch.tip = tips.data();
    if (!question.nominal) batch.is_stiff = is_stiff.data();
    instance_for(count).solve(machine, question, schedule, batch);
  }

  Eigen::VectorXd rho_of(std::size_t i) const {
    const std::size_t actuators = rho.size() / cells.size();
    return Eigen::Map<const Eigen::VectorXd>(&rho[actuators * i], static_cast<Eigen::Index>(actuators));
  }

  void clear() {
    p.clear(), place.clear(), F.clear(), rho.clear(), cells.clear();
  }
};

const char* kernel_instructions() {
  const int lanes = kernel::all_instances().back().lanes;
  return lanes == 8 ? "AVX-512" : lanes == 4 ? "AVX2" : "scalar";
}

StartTable::StartTable(const Model& model, bool at_platform) : impl_(std::make_unique<Impl>(model, at_platform)) {}
StartTable::~StartTable() = default;

struct StartTables::Impl {
  std::mutex mutex{};
  std::map<std::pair<const Model*, bool>, StartTable> tables{};
};

StartTables::StartTables() : impl_(std::make_unique<Impl>()) {}
StartTables::~StartTables() = default;
StartTables::StartTables(StartTables&&) noexcept = default;

const StartTable& StartTables::of(const Model& model, bool at_platform) const {
  const std::lock_guard lock(impl_->mutex);
  const auto key = std::make_pair(&model, at_platform);
  if (const auto found = impl_->tables.find(key); found != impl_->tables.end()) return found->second;
  return impl_->tables
      .emplace(std::piecewise_construct, std::forward_as_tuple(key), std::forward_as_tuple(model, at_platform))
      .first->second;
}

struct BatchSolver::Impl {
  /// A request that has cells.
  struct Waypoint {
    std::size_t request;
    Vector3 p;
    Vector6 F;
    std::shared_ptr<const KinematicsCell> kinematics;
    std::shared_ptr<const kernel::StartCell> target;
  };

  StartTable::Impl& table;
  StaticsWork work;
  KernelBatch nominal, real;
  std::vector<Waypoint> waypoints;
  std::shared_ptr<const KinematicsCell> near;

  explicit Impl(StartTable::Impl& t) : table(t), work(t.model.mechanism) {}

  std::shared_ptr<const KinematicsCell> kinematics_at(const Vector3& p) {
    const auto index = table.is_able ? table.index_of(p) : std::nullopt;
    return index ? table.kinematics(*index) : nullptr;
  }

  void collect(std::span<const BatchRequest> requests, Acting acting) {
    waypoints.clear();
    std::optional<CellIndex> last;
    Waypoint waypoint{};
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const auto index = table.index_of(requests[i].p);
      if (!index || !requests[i].F.allFinite()) continue;
      if (index != last) {
        waypoint.kinematics = table.kinematics(*index);
        waypoint.target = waypoint.kinematics ? table.target(*index, acting, work) : nullptr;
        last = index;
      }
      if (!waypoint.target) continue;
      waypoint.request = i, waypoint.p = requests[i].p, waypoint.F = requests[i].F;
      waypoints.push_back(waypoint);
    }
  }

  bool in_travel(const std::vector<double>& rho, std::size_t waypoint) const {
    const auto& travel = table.model.mechanism.travel;
    for (std::size_t a = 0; a < travel.size(); ++a)
      if (const double x = rho[travel.size() * waypoint + a]; !(x >= travel[a].min && x <= travel[a].max)) return false;
    return true;
  }

  /// Solves the waypoints for commands: nominal inverse kinematics, then the real machine.
  void solve_commands(std::span<const Vector3> commands, Acting acting) {
    nominal.clear(), real.clear();
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      const Waypoint& w = waypoints[i];
      append(commands[i], nominal.p);
      nominal.cells.push_back(&w.kinematics->start);
      append(commands[i] - command_offset(*w.target, commands[i], w.F), real.place);
      real.F.insert(real.F.end(), w.F.begin(), w.F.end());
      real.cells.push_back(w.target.get());
    }
    nominal.solve(table.flat.machine, table.R_home, nominal_question(table.perfect, true));
    real.p = nominal.p, real.rho = nominal.rho;
    real.solve(table.flat.machine, table.R_home, table.question(acting, false));
  }

  bool is_solved(std::size_t i) const {
    return nominal.accepted[i] != 0 && real.accepted[i] != 0 && real.is_stiff[i] != 0 && in_travel(nominal.rho, i);
  }

  void solve_forward(Acting acting, std::span<BatchAnswer> answers) {
    std::vector<Vector3> commands;
    for (const Waypoint& w : waypoints) commands.push_back(w.p);
    solve_commands(commands, acting);
    for (std::size_t i = 0; i < waypoints.size(); ++i)
      answers[waypoints[i].request] = {is_solved(i), commands[i], pose_of(&real.tips[12 * i]), nominal.rho_of(i),
                                       nominal.iterations[i] + real.iterations[i]};
  }

  /// Of machines that control positions only: actuators that bring the tip there, then the command that they are.
  void solve_positions(Acting acting, std::span<BatchAnswer> answers) {
    nominal.clear(), real.clear();
    for (const Waypoint& w : waypoints) {
      append(w.p, real.p);
      real.F.insert(real.F.end(), w.F.begin(), w.F.end());
      real.cells.push_back(w.target.get());
      append(w.p + command_offset(*w.target, w.p, w.F), nominal.place);
      nominal.cells.push_back(&w.kinematics->start);
    }
    real.solve(table.flat.machine, table.R_home, table.question(acting, true));
    nominal.p = real.p, nominal.rho = real.rho;
    nominal.solve(table.flat.machine, table.R_home, nominal_question(table.perfect, false));
    for (std::size_t i = 0; i < waypoints.size(); ++i)
      answers[waypoints[i].request] = {is_solved(i), pose_of(&nominal.tips[12 * i]).p, pose_of(&real.tips[12 * i]), {},
                                       nominal.iterations[i] + real.iterations[i]};
  }

  /// Of machines that control orientations, which are commanded as at home: the command is moved until the tip is
  /// there. The expansion of the cell says how a command changes with the place that it reaches.
  void solve_outer(Acting acting, std::span<BatchAnswer> answers) {
    std::vector<Vector3> commands;
    for (const Waypoint& w : waypoints) commands.push_back(w.p + command_offset(*w.target, w.p, w.F));
    std::vector<double> last_miss(waypoints.size(), 0);
    for (int round = 0; round < most_command_rounds && !waypoints.empty(); ++round) {
      solve_commands(commands, acting);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < waypoints.size(); ++i) {
        Waypoint& w = waypoints[i];
        BatchAnswer& answer = answers[w.request];
        answer.iterations += nominal.iterations[i] + real.iterations[i];
        if (!is_solved(i)) continue;
        answer.X_MT = pose_of(&real.tips[12 * i]);
        const Vector3 miss = answer.X_MT.p - w.p;
        const Vector3 next = commands[i] - miss + command_offset(*w.target, w.p, w.F) -
                             command_offset(*w.target, answer.X_MT.p, w.F);
        const double size = miss.norm();
        if (size <= command_tolerance || (round > 0 && size * size <= command_tolerance * last_miss[i])) {
          answer.solved = true;
          answer.command = next;
          answer.X_MT.p = w.p;
          continue;
        }
        last_miss[kept] = size;
        commands[kept] = next;
        waypoints[kept++] = w;
      }
      waypoints.resize(kept), commands.resize(kept);
    }
  }
};

BatchSolver::BatchSolver(const StartTable& table) : impl_(std::make_unique<Impl>(table.impl())) {}
BatchSolver::~BatchSolver() = default;
BatchSolver::BatchSolver(BatchSolver&&) noexcept = default;

void BatchSolver::solve(BatchQuestion question, const Stage& stage, std::span<const BatchRequest> requests,
                        std::span<BatchAnswer> answers) {
  std::fill(answers.begin(), answers.end(), BatchAnswer{});
  const auto acting = acting_in(stage, impl_->table.has_weights);
  if (!acting || !impl_->table.is_able) return;
  impl_->collect(requests, *acting);
  if (question == BatchQuestion::forward)
    impl_->solve_forward(*acting, answers);
  else if (impl_->table.controls_positions)
    impl_->solve_positions(*acting, answers);
  else
    impl_->solve_outer(*acting, answers);
}

void BatchSolver::solve_nominal(std::span<const Vector3> p, std::span<NominalAnswer> answers) {
  KernelBatch& batch = impl_->nominal;
  batch.clear();
  std::vector<std::shared_ptr<const KinematicsCell>> cells;
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < p.size(); ++i) {
    answers[i].solved = false;
    auto cell = impl_->kinematics_at(p[i]);
    if (!cell) continue;
    asked.push_back(i);
    append(p[i], batch.p);
    batch.cells.push_back(&cell->start);
    cells.push_back(std::move(cell));
  }
  const StartTable::Impl& table = impl_->table;
  batch.solve(table.flat.machine, table.R_home, nominal_question(table.perfect, true));
  for (std::size_t k = 0; k < asked.size(); ++k) {
    NominalAnswer& answer = answers[asked[k]];
    answer.solved = batch.accepted[k] != 0;
    answer.X_MT = pose_of(&batch.tips[12 * k]);
    answer.rho = batch.rho_of(k);
  }
}

const Configuration* BatchSolver::nominal_near(const Vector3& p) {
  impl_->near = impl_->kinematics_at(p);
  return impl_->near ? &impl_->near->nominal : nullptr;
}

// Neighbouring cells agree about a place between them. Along a longer way the nominal machine is followed.
bool BatchSolver::joins(const Vector3& from, const Vector3& to) {
  const auto begin = impl_->kinematics_at(from), end = impl_->kinematics_at(to);
  if (!begin || !end) return false;
  if (begin == end) return true;
  const Model& model = impl_->table.model;
  const NominalResult start = follow(model, begin->nominal, {impl_->table.R_home, from});
  if (start.status != Status::converged) return false;
  const NominalResult followed = follow(model, start.configuration, {impl_->table.R_home, to});
  NominalAnswer there;
  solve_nominal({&to, 1}, {&there, 1});
  return followed.status == Status::converged && there.solved &&
         (actuator_values(model.mechanism, followed.configuration) - there.rho).norm() <
             same_branch * model.mechanism.length;
}

}  // namespace counterflex
