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

/// Whether a line from one cell to the other is inside the two.
bool share_a_face(const CellIndex& a, const CellIndex& b) {
  long steps = 0;
  for (std::size_t i = 0; i < 3; ++i) steps += std::abs(a.position[i] - b.position[i]);
  return steps <= 1;
}

}  // namespace

StartTable::StartTable(const Model& model, bool at_platform)
    : StartTable(model, at_platform, std::make_shared<CellCache>(bytes_of_cells)) {}
StartTable::StartTable(const Model& model, bool at_platform, std::shared_ptr<CellCache> cells)
    : impl_(std::make_unique<Impl>(model, at_platform, std::move(cells))) {}
StartTable::~StartTable() = default;

struct StartTables::Impl {
  const std::shared_ptr<CellCache> cells = std::make_shared<CellCache>(bytes_of_cells);
  std::mutex mutex{};
  std::map<std::pair<const Model*, bool>, StartTable> tables{};
};

StartTables::StartTables() : impl_(std::make_unique<Impl>()) {}
StartTables::~StartTables() = default;
StartTables::StartTables(StartTables&&) noexcept = default;

const StartTable& StartTables::of(const Model& model, bool at_platform) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->tables.try_emplace({&model, at_platform}, model, at_platform, impl_->cells).first->second;
}

struct BatchSolver::Impl {
  /// The cells of a waypoint, as long as the batch refers to them.
  struct Cells {
    std::shared_ptr<const KinematicsCell> kinematics;
    std::shared_ptr<const kernel::StartCell> target;
  };

  StartTable::Impl& table;
  kernel::Solver solver;
  kernel::Batch batch;
  std::vector<std::size_t> asked;  ///< requests that have cells
  std::vector<Cells> cells;
  std::optional<CellIndex> last_index;  ///< of the cell that was looked for last
  std::shared_ptr<const KinematicsCell> last_kinematics;
  std::optional<CellIndex> line_index;  ///< of the cell that bounded a line last
  std::shared_ptr<const kernel::StartCell> line_cell;

  explicit Impl(StartTable::Impl& t) : table(t) {}

  const std::shared_ptr<const KinematicsCell>& kinematics_at(const TurnedPlace& place) {
    const auto index = table.is_able ? table.index_of(place.p, place.turn) : std::nullopt;
    if (index != last_index) last_kinematics = index ? table.kinematics(*index) : nullptr;
    last_index = index;
    return last_kinematics;
  }

  /// The cell of the whole machine; null if it has no cell.
  const std::shared_ptr<const kernel::StartCell>& target_at(const CellIndex& index) {
    if (index != line_index) line_cell = table.target(index, {});
    line_index = index;
    return line_cell;
  }

  Matrix3 orientation_of(const TurnedPlace& place) const {
    return place.turn.isZero(0) ? table.R_home : Matrix3(exp_so3(place.turn) * table.R_home);
  }

  void begin() { batch.clear(), asked.clear(), cells.clear(); }

  void add(const TurnedPlace& place, const kernel::StartCell& nominal_cell) {
    append(place.p, batch.p);
    if (!table.controls_positions) {
      const Matrix3 R = orientation_of(place);
      for (int i = 0; i < 9; ++i) batch.R.push_back(R(i / 3, i % 3));
    }
    batch.nominal_cells.push_back(&nominal_cell);
  }

  Eigen::Map<const Eigen::VectorXd> rho_of(std::size_t i) const {
    const std::size_t actuators = batch.actuators.size() / batch.accepted.size();
    return {batch.actuators.data() + actuators * i, static_cast<Eigen::Index>(actuators)};
  }

  void collect(std::span<const BatchRequest> requests, const Stage& stage) {
    begin();
    std::optional<CellIndex> last;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const TurnedPlace& at = requests[i].at;
      const auto index = table.index_of(at.p, at.turn);
      if (!index || !requests[i].F.allFinite()) continue;
      if (index != last) {
        Cells& found = cells.emplace_back();
        found.kinematics = table.kinematics(*index);
        if (found.kinematics) found.target = table.target(*index, stage);
        last = index;
      }
      if (!cells.back().target) continue;
      add(at, cells.back().kinematics->start);
      append(requests[i].F, batch.F);
      if (stage.errors == 1) append(lag_of(table.model.mechanism, requests[i].directions), batch.lag);
      if (requests[i].rho != nullptr)
        batch.rho.insert(batch.rho.end(), requests[i].rho->begin(), requests[i].rho->end());
      batch.cells.push_back(cells.back().target.get());
      asked.push_back(i);
    }
  }

  void solve_kinematics() {
    solver.solve({.real = {}, .nominal = table.nominal()}, kernel::cell_schedule, batch);
  }

  /// Nominal kinematics of the places that have cells. A place of which `is_known(i, cell)` is left out.
  template <class IsKnown>
  void solve_kinematics(std::span<const TurnedPlace> places, bool wants_states, const IsKnown& is_known) {
    begin();
    batch.wants_states = wants_states;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& cell = kinematics_at(places[i]);
      if (!cell || is_known(i, *cell)) continue;
      add(places[i], cell->start);
      asked.push_back(i);
      cells.push_back({cell, nullptr});
    }
    solve_kinematics();
  }

  void solve(BatchQuestion question, const Stage& stage, std::span<const BatchRequest> requests,
             std::span<BatchAnswer> answers) {
    collect(requests, stage);
    const bool is_forward = question == BatchQuestion::forward;
    kernel::Problem problem{.real = table.question(stage)};
    if (batch.rho.empty()) problem.nominal = table.nominal();
    for (std::size_t j = 0; j < 6; ++j)
      problem.of_command[j] = is_forward || (question == BatchQuestion::target && j >= 3);
    solver.solve(problem, kernel::cell_schedule, batch);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      BatchAnswer& answer = answers[asked[i]];
      answer.solved =
          batch.accepted[i] != 0 && batch.is_stiff[i] != 0 && within_travel(table.model.mechanism, rho_of(i));
      if (problem.nominal) answer.command = kernel::get_pose(&batch.nominal_tip[12 * i]);
      if (is_forward) answer.command.p = requests[asked[i]].at.p;
      answer.X_MT = kernel::get_pose(&batch.tip[12 * i]);
      answer.iterations = batch.iterations[i];
      if (is_forward && problem.nominal) answer.rho = rho_of(i);
    }
  }
};

BatchSolver::BatchSolver(const StartTable& table) : impl_(std::make_unique<Impl>(table.impl())) {}
BatchSolver::~BatchSolver() = default;
BatchSolver::BatchSolver(BatchSolver&&) noexcept = default;

void BatchSolver::solve(BatchQuestion question, const Stage& stage, std::span<const BatchRequest> requests,
                        std::span<BatchAnswer> answers) {
  std::fill(answers.begin(), answers.end(), BatchAnswer{});
  const auto of_cells = stage_of_cells(stage, impl_->table.has_weights);
  if (of_cells && impl_->table.is_able) impl_->solve(question, *of_cells, requests, answers);
}

void BatchSolver::nominal_tips(std::span<const TurnedPlace> places, std::span<NominalAnswer> answers) {
  std::fill(answers.begin(), answers.end(), NominalAnswer{});
  impl_->solve_kinematics(places, false, [&](std::size_t i, const KinematicsCell& cell) {
    answers[i].solved = cell.R_MT && places[i].turn.isZero(0);
    if (answers[i].solved) answers[i].X_MT = {*cell.R_MT, places[i].p};
    return answers[i].solved;
  });
  const kernel::Batch& batch = impl_->batch;
  for (std::size_t k = 0; k < impl_->asked.size(); ++k)
    answers[impl_->asked[k]] = {batch.accepted[k] != 0, kernel::get_pose(&batch.nominal_tip[12 * k])};
}

LineBend BatchSolver::bend_along(const BatchLine& line) {
  constexpr LineBend unknown{std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity()};
  StartTable::Impl& table = impl_->table;
  // The expansion of a cell misses the bends of error tables inside it, and the knees of joints.
  if (!table.is_able || !table.flat.machine.motions.empty() || table.flat.machine.has_knees) return unknown;
  const auto begin = table.index_of(line.p0), end = table.index_of(line.p1);
  if (!begin || !end || !share_a_face(*begin, *end)) return unknown;
  const double length = table.flat.machine.length;
  const auto size = [length](const Vector6& F) {
    return std::sqrt(F.head<3>().squaredNorm() + F.tail<3>().squaredNorm() / (length * length));
  };
  kernel::LineSizes sizes{.way = (line.p1 - line.p0).norm(),
                          .load_change = size(line.F1 - line.F0),
                          .crosses = !(*begin == *end)};
  for (const Vector6& dF : line.dF) sizes.kink = std::max(sizes.kink, size(dF));
  sizes.load = std::max(size(line.F0), size(line.F1)) + sizes.kink;
  LineBend bend{0, 0};
  const std::array<CellIndex, 2> cells{*begin, *end};
  for (const CellIndex& index : std::span(cells).first(sizes.crosses ? 2 : 1)) {
    const auto& cell = impl_->target_at(index);
    if (!cell) return unknown;
    const kernel::ChordBounds bounds = chord_bounds(cell->bounds, sizes);
    if (!std::isfinite(bounds.command) || !std::isfinite(bounds.gain)) return unknown;
    bend = {std::max(bend.command, bounds.command), std::max(bend.gain, bounds.gain)};
  }
  return bend;
}

void BatchSolver::nominals(std::span<const TurnedPlace> places, std::span<NominalResult> answers) {
  for (NominalResult& answer : answers) answer.status = Status::not_converged;
  impl_->solve_kinematics(places, true, [](std::size_t, const KinematicsCell&) { return false; });
  const StartTable::Impl& table = impl_->table;
  const kernel::Batch& batch = impl_->batch;
  const auto size = static_cast<std::size_t>(table.rigid.machine.state_size());
  for (std::size_t k = 0; k < impl_->asked.size(); ++k)
    if (batch.accepted[k] != 0)
      answers[impl_->asked[k]] = {Status::converged,
                                  nominal_of(table.model.mechanism, table.rigid, &batch.state[size * k],
                                             impl_->cells[k].kinematics->nominal)};
}

const Configuration* BatchSolver::nominal_near(const TurnedPlace& place) {
  const auto& cell = impl_->kinematics_at(place);
  return cell ? &cell->nominal : nullptr;
}

// Neighbouring cells have the same actuators at a place between them.
bool BatchSolver::joins(const TurnedPlace& from, const TurnedPlace& to) {
  const std::shared_ptr<const KinematicsCell> begin = impl_->kinematics_at(from),
                                              end = impl_->kinematics_at(to);
  if (!begin || !end) return false;
  if (begin == end) return true;
  if ((from.p - to.p).cwiseAbs().maxCoeff() > impl_->table.edge) return false;
  impl_->begin();
  for (const auto& cell : {end, begin}) impl_->add(to, cell->start);
  impl_->solve_kinematics();
  const Mechanism& mechanism = impl_->table.model.mechanism;
  return impl_->batch.accepted[0] != 0 && impl_->batch.accepted[1] != 0 &&
         actuator_distance(mechanism, impl_->rho_of(0), impl_->rho_of(1)) < same_place * mechanism.length;
}

}  // namespace counterflex
