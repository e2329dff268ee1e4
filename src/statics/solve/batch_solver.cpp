#include "counterflex/statics/batch_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/geometry/pose.hpp"
#include "statics/kernel/cells/offset_bounds.hpp"
#include "statics/kernel/machine/states.hpp"
#include "statics/solve/start_table.hpp"

namespace counterflex {
namespace {

template <int n>
void append(const Eigen::Matrix<double, n, 1>& v, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), v.begin(), v.end());
}

}  // namespace

/// Waypoints of one problem of the kernel, and its answers.
struct KernelBatch {
  std::vector<double> p, R, F, lag;
  std::vector<double> held;  ///< actuators, where the problem has no nominal machine
  std::vector<const kernel::StartCell*> cells, nominal_cells;
  std::vector<unsigned char> accepted, is_stiff;
  std::vector<int> iterations;
  std::vector<double> rho, tips, nominal_tips;
  std::vector<double> states;  ///< of the nominal machine, where it is alone

  void clear() {
    p.clear(), R.clear(), F.clear(), lag.clear(), held.clear();
    cells.clear(), nominal_cells.clear();
  }

  void add(const Vector3& wanted_p, const Matrix3& wanted_R, const kernel::StartCell& nominal_cell) {
    append(wanted_p, p);
    for (int i = 0; i < 9; ++i) R.push_back(wanted_R(i / 3, i % 3));
    nominal_cells.push_back(&nominal_cell);
  }

  void solve(const kernel::Problem& problem) {
    const std::size_t count = nominal_cells.size();
    if (count == 0) return;
    rho.resize(problem.machine().actuator_joint.size() * count), tips.resize(12 * count),
        nominal_tips.resize(12 * count);
    accepted.resize(count), is_stiff.resize(count), iterations.resize(count);
    kernel::Batch batch;
    batch.count = static_cast<int>(count);
    batch.p = p.data(), batch.R = R.data(), batch.actuators = rho.data();
    if (problem.nominal)
      batch.nominal_cells = nominal_cells.data(), batch.nominal_tip = nominal_tips.data();
    else
      batch.rho = held.data();
    batch.accepted = accepted.data(), batch.iterations = iterations.data();
    if (!problem.real) {
      states.resize(static_cast<std::size_t>(problem.machine().state_size()) * count);
      batch.state = states.data();
    } else {
      batch.F = F.data(), batch.cells = cells.data();
      batch.lag = lag.empty() ? nullptr : lag.data();
      batch.tip = tips.data(), batch.is_stiff = is_stiff.data();
    }
    kernel::instance_for(count).solve(problem, kernel::cell_schedule, batch);
  }

  Eigen::VectorXd rho_of(std::size_t i) const {
    const std::size_t actuators = rho.size() / nominal_cells.size();
    return Eigen::Map<const Eigen::VectorXd>(&rho[actuators * i], static_cast<Eigen::Index>(actuators));
  }
};

const char* kernel_instructions() {
  const int lanes = kernel::all_instances().back().lanes;
  return lanes == 8 ? "AVX-512" : lanes == 4 ? "AVX2" : "scalar";
}

StartTable::StartTable(const Model& model, bool at_platform)
    : impl_(std::make_unique<Impl>(model, at_platform)) {}
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
      .emplace(std::piecewise_construct, std::forward_as_tuple(key),
               std::forward_as_tuple(model, at_platform))
      .first->second;
}

struct BatchSolver::Impl {
  /// The cells of a waypoint, as long as the batch refers to them.
  struct Cells {
    std::shared_ptr<const KinematicsCell> kinematics;
    std::shared_ptr<const kernel::StartCell> target;
  };

  StartTable::Impl& table;
  KernelBatch batch;
  std::vector<std::size_t> asked;  ///< requests that have cells
  std::vector<Cells> cells;
  std::shared_ptr<const KinematicsCell> near;
  std::optional<CellIndex> last_index;  ///< of the cell that was looked for last
  std::shared_ptr<const KinematicsCell> last_kinematics;
  std::optional<CellIndex> line_index;  ///< of the cell that bounded a line last
  std::shared_ptr<const kernel::StartCell> line_cell;

  explicit Impl(StartTable::Impl& t) : table(t) {}

  std::shared_ptr<const KinematicsCell> kinematics_at(const TurnedPlace& place) {
    const auto index = table.is_able ? table.index_of(place.p, place.turn) : std::nullopt;
    if (index != last_index) last_kinematics = index ? table.kinematics(*index) : nullptr;
    last_index = index;
    return last_kinematics;
  }

  /// The cell of the whole machine; null if it has no cell.
  const kernel::StartCell* target_at(const Vector3& p) {
    const auto index = table.is_able ? table.index_of(p, Vector3::Zero()) : std::nullopt;
    if (index != line_index) line_cell = index ? table.target(*index, {}) : nullptr;
    line_index = index;
    return line_cell.get();
  }

  Matrix3 orientation_of(const TurnedPlace& place) const {
    return place.turn.isZero(0) ? table.R_home : Matrix3(exp_so3(place.turn) * table.R_home);
  }

  void collect(std::span<const BatchRequest> requests, Acting acting) {
    batch.clear(), asked.clear(), cells.clear();
    std::optional<CellIndex> last;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const TurnedPlace& at = requests[i].at;
      const auto index = table.index_of(at.p, at.turn);
      if (!index || !requests[i].F.allFinite()) continue;
      if (index != last) {
        Cells& found = cells.emplace_back();
        found.kinematics = table.kinematics(*index);
        if (found.kinematics) found.target = table.target(*index, acting);
        last = index;
      }
      if (!cells.back().target) continue;
      batch.add(at.p, orientation_of(at), cells.back().kinematics->start);
      append(requests[i].F, batch.F);
      if (acting.errors) append(lag_of(table.model.mechanism, requests[i].directions), batch.lag);
      if (requests[i].rho != nullptr)
        batch.held.insert(batch.held.end(), requests[i].rho->begin(), requests[i].rho->end());
      batch.cells.push_back(cells.back().target.get());
      asked.push_back(i);
    }
  }

  bool in_travel(std::size_t waypoint) const {
    const Mechanism& mechanism = table.model.mechanism;
    return within_travel(mechanism, batch.rho.data() + mechanism.travel.size() * waypoint);
  }

  void solve_kinematics() { batch.solve({.real = {}, .nominal = table.nominal()}); }

  void solve(BatchQuestion question, Acting acting, std::span<const BatchRequest> requests,
             std::span<BatchAnswer> answers) {
    collect(requests, acting);
    const bool is_forward = question == BatchQuestion::forward;
    kernel::Problem problem{.real = table.question(acting)};
    if (batch.held.empty()) problem.nominal = table.nominal();
    for (std::size_t j = 0; j < 6; ++j)
      problem.of_command[j] = is_forward || (question == BatchQuestion::target && j >= 3);
    batch.solve(problem);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      BatchAnswer& answer = answers[asked[i]];
      answer.solved = batch.accepted[i] != 0 && batch.is_stiff[i] != 0 && in_travel(i);
      if (problem.nominal) answer.command = kernel::get_pose(&batch.nominal_tips[12 * i]);
      if (is_forward) answer.command.p = requests[asked[i]].at.p;
      answer.X_MT = kernel::get_pose(&batch.tips[12 * i]);
      answer.iterations = batch.iterations[i];
      if (is_forward && problem.nominal) answer.rho = batch.rho_of(i);
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
  impl_->solve(question, *acting, requests, answers);
}

void BatchSolver::nominal_tips(std::span<const TurnedPlace> places, std::span<NominalAnswer> answers) {
  KernelBatch& batch = impl_->batch;
  batch.clear();
  std::vector<std::shared_ptr<const KinematicsCell>> cells;
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const TurnedPlace& place = places[i];
    const auto cell = impl_->kinematics_at(place);
    answers[i].solved = cell && cell->R_MT && place.turn.isZero(0);
    if (answers[i].solved) answers[i].X_MT = {*cell->R_MT, place.p};
    if (!cell || answers[i].solved) continue;
    asked.push_back(i);
    batch.add(place.p, impl_->orientation_of(place), cell->start);
    cells.push_back(cell);
  }
  impl_->solve_kinematics();
  for (std::size_t k = 0; k < asked.size(); ++k)
    answers[asked[k]] = {batch.accepted[k] != 0, kernel::get_pose(&batch.nominal_tips[12 * k])};
}

LineBend BatchSolver::bend_along(const BatchLine& line) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const kernel::StartCell* cell = impl_->target_at((line.p0 + line.p1) / 2);
  // The expansion of a cell misses the bends of error tables inside it.
  // They miss the knees of joints, too.
  if (cell == nullptr || !impl_->table.flat.machine.motions.empty() || impl_->table.flat.machine.has_knees)
    return {infinity, infinity};
  const Vector3 centre(cell->centre[0], cell->centre[1], cell->centre[2]);
  for (const Vector3& p : {line.p0, line.p1})
    if (!((p - centre).cwiseAbs().maxCoeff() <= cell->bounds.half_edge)) return {infinity, infinity};
  const double length = impl_->table.flat.machine.length;
  const auto size = [length](const Vector6& F) {
    return std::sqrt(F.head<3>().squaredNorm() + F.tail<3>().squaredNorm() / (length * length));
  };
  kernel::LineSizes sizes{.way = (line.p1 - line.p0).norm(), .load_change = size(line.F1 - line.F0)};
  for (const Vector6& dF : line.dF) sizes.kink = std::max(sizes.kink, size(dF));
  sizes.load = std::max(size(line.F0), size(line.F1)) + sizes.kink;
  const kernel::ChordBounds bounds = chord_bounds(cell->bounds, sizes);
  return {bounds.command, bounds.gain};
}

void BatchSolver::nominals(std::span<const TurnedPlace> places, std::span<NominalResult> answers) {
  KernelBatch& batch = impl_->batch;
  batch.clear();
  std::vector<std::shared_ptr<const KinematicsCell>> cells;
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < places.size(); ++i) {
    answers[i].status = Status::not_converged;
    const auto cell = impl_->kinematics_at(places[i]);
    if (!cell) continue;
    asked.push_back(i);
    batch.add(places[i].p, impl_->orientation_of(places[i]), cell->start);
    cells.push_back(cell);
  }
  impl_->solve_kinematics();
  const StartTable::Impl& table = impl_->table;
  const auto size = static_cast<std::size_t>(table.rigid.machine.state_size());
  for (std::size_t k = 0; k < asked.size(); ++k)
    if (batch.accepted[k] != 0)
      answers[asked[k]] = {Status::converged, nominal_of(table.model.mechanism, table.rigid,
                                                         &batch.states[size * k], cells[k]->nominal)};
}

const Configuration* BatchSolver::nominal_near(const TurnedPlace& place) {
  impl_->near = impl_->kinematics_at(place);
  return impl_->near ? &impl_->near->nominal : nullptr;
}

// Neighbouring cells have the same actuators at a place between them. Along a longer way the nominal machine
// is followed.
bool BatchSolver::joins(const TurnedPlace& from, const TurnedPlace& to) {
  const auto begin = impl_->kinematics_at(from), end = impl_->kinematics_at(to);
  if (!begin || !end) return false;
  if (begin == end) return true;
  const StartTable::Impl& table = impl_->table;
  KernelBatch& batch = impl_->batch;
  batch.clear();
  for (const auto& cell : {end, begin}) batch.add(to.p, impl_->orientation_of(to), cell->start);
  impl_->solve_kinematics();
  const double limit = same_place * table.model.mechanism.length;
  const bool are_neighbours = (from.p - to.p).cwiseAbs().maxCoeff() <= table.edge;
  if (are_neighbours && batch.accepted[0] != 0 && batch.accepted[1] != 0 &&
      actuator_distance(table.model.mechanism, batch.rho_of(0), batch.rho_of(1)) < limit)
    return true;
  const NominalResult start = follow(table.model, begin->nominal, {impl_->orientation_of(from), from.p});
  if (start.status != Status::converged) return false;
  const NominalResult followed = follow(table.model, start.configuration, {impl_->orientation_of(to), to.p});
  return followed.status == Status::converged && batch.accepted[0] != 0 &&
         actuator_distance(table.model.mechanism,
                           actuator_values(table.model.mechanism, followed.configuration),
                           batch.rho_of(0)) < limit;
}

}  // namespace counterflex
