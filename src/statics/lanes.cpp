#include "counterflex/statics/lanes.hpp"

#include <cmath>
#include <cstdlib>
#include <unordered_map>

#include "lane_region.hpp"

namespace counterflex {

namespace lane_cells {

constexpr double region_share = 1.0 / 64;  // half an edge of a region, in units of l
constexpr std::size_t most_regions = 512;
constexpr double same_branch = 1e-3;  // l or rad: another branch is further away

struct Cell {
  long x, y, z;
  bool operator==(const Cell&) const = default;
};

struct CellHash {
  std::size_t operator()(const Cell& c) const {
    return static_cast<std::size_t>(c.x * 73856093L ^ c.y * 19349663L ^ c.z * 83492791L);
  }
};

using RegionPointer = std::shared_ptr<const LaneRegion>;

bool are_neighbours(const Cell& a, const Cell& b) {
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 && std::abs(a.z - b.z) <= 1;
}

struct AlignedFree {
  void operator()(double* memory) const { std::free(memory); }
};

}  // namespace lane_cells

using namespace lane_cells;

struct LaneMachine::Impl {
  const Model& model;
  LaneModel lane_model;
  bool able;
  double half, reach;
  std::mutex mutex{};
  std::unordered_map<Cell, RegionPointer, CellHash> regions{};

  Impl(const Model& m, bool at_platform, double r)
      : model(m), lane_model(m, at_platform), able(LaneModel::can_do(m.mechanism)), half(region_share * m.mechanism.length), reach(r) {}

  Cell cell_of(const Vector3& p) const {
    const Vector3 n = (p / (2 * half)).array().floor();
    return {static_cast<long>(n[0]), static_cast<long>(n[1]), static_cast<long>(n[2])};
  }

  // What is made for a cell depends on the cell alone; two threads may make the same one.
  RegionPointer region(const Cell& cell, StaticsWork& work) {
    {
      const std::lock_guard lock(mutex);
      if (const auto found = regions.find(cell); found != regions.end()) return found->second;
    }
    const Vector3 centre = 2 * half * (Vector3(static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)).array() + 0.5);
    RegionPointer made = LaneRegion::make(model, lane_model, centre, half, reach, work);
    const std::lock_guard lock(mutex);
    if (regions.size() >= most_regions) regions.clear();
    return regions.emplace(cell, std::move(made)).first->second;
  }
};

LaneMachine::LaneMachine(const Model& model, bool at_platform, double reach)
    : impl_(std::make_unique<Impl>(model, at_platform, reach)) {}
LaneMachine::~LaneMachine() = default;

struct LaneMachines::Impl {
  double reach;
  std::mutex mutex{};
  std::map<std::pair<const Model*, bool>, LaneMachine> machines{};
};

LaneMachines::LaneMachines(double reach) : impl_(new Impl{reach}) {}
LaneMachines::~LaneMachines() = default;
LaneMachines::LaneMachines(LaneMachines&&) noexcept = default;

const LaneMachine& LaneMachines::of(const Model& model, bool at_platform) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->machines.try_emplace({&model, at_platform}, model, at_platform, impl_->reach).first->second;
}

const char* lane_instructions() { return lanes::best_kernel().name; }

struct LaneSolver::Impl {
  LaneMachine::Impl& machine;
  StaticsWork work;
  lanes::Kernel kernel = lanes::best_kernel();
  std::unique_ptr<double, AlignedFree> memory;
  std::vector<double> rho;
  lanes::Batch batch{};
  RegionPointer region{};
  Cell cell{};

  explicit Impl(LaneMachine::Impl& m) : machine(m), work(m.model.mechanism), rho(m.model.mechanism.travel.size() * lanes::width) {
    const long count = (lanes::doubles_needed(m.lane_model.program()) + 7) / 8 * 8;
    memory.reset(static_cast<double*>(std::aligned_alloc(64, static_cast<std::size_t>(count) * sizeof(double))));
    batch.rho = rho.data();
  }

  void go_to(const Vector3& p) {
    const Cell at = machine.cell_of(p);
    if (region && at == cell) return;
    cell = at;
    region = machine.region(at, work);
  }

  bool in_travel(int lane) const {
    const auto& travel = machine.model.mechanism.travel;
    for (std::size_t a = 0; a < travel.size(); ++a) {
      const double value = rho[a * lanes::width + static_cast<std::size_t>(lane)];
      if (!(value >= travel[a].min && value <= travel[a].max)) return false;
    }
    return true;
  }

  void load(std::span<const LaneRequest> requests) {
    for (int lane = 0; lane < lanes::width; ++lane) {
      const LaneRequest& request = requests[std::min<std::size_t>(static_cast<std::size_t>(lane), requests.size() - 1)];
      for (int i = 0; i < 3; ++i) batch.p[i][lane] = request.p[i];
      for (int i = 0; i < 6; ++i) batch.F[i][lane] = request.F[i];
    }
  }

  LaneAnswer answer(int lane) const {
    LaneAnswer result;
    for (int i = 0; i < 3; ++i) result.command[i] = batch.p[i][lane];
    for (int i = 0; i < 9; ++i) result.X_MT.R(i / 3, i % 3) = batch.tip[i][lane];
    for (int i = 0; i < 3; ++i) result.X_MT.p[i] = batch.tip[9 + i][lane];
    result.iterations = static_cast<int>(batch.iterations[lane]);
    result.solved = batch.converged[lane] && in_travel(lane) && region->holds(result.command);
    return result;
  }

  // All of one region.
  void solve_batch(LaneQuestion question, bool errors, std::span<const LaneRequest> requests, std::span<LaneAnswer> answers, bool go_on) {
    double size = 0;
    bool moments = false;
    for (const LaneRequest& request : requests) {
      size = std::max({size, request.F.head<3>().norm(), request.F.tail<3>().norm() / machine.model.mechanism.length});
      moments = moments || !request.F.tail<3>().isZero(0);
    }
    if (!region->bears(size, moments, errors, work)) return;
    load(requests);
    kernel.solve(machine.lane_model.program(), region->flat(), {question == LaneQuestion::target, errors, go_on}, batch, memory.get());
    for (std::size_t i = 0; i < requests.size(); ++i) answers[i] = answer(static_cast<int>(i));
  }
};

LaneSolver::LaneSolver(const LaneMachine& machine) : impl_(std::make_unique<Impl>(machine.impl())) {}
LaneSolver::~LaneSolver() = default;
LaneSolver::LaneSolver(LaneSolver&&) noexcept = default;

void LaneSolver::solve(LaneQuestion question, bool errors, std::span<const LaneRequest> requests, std::span<LaneAnswer> answers) {
  std::fill(answers.begin(), answers.end(), LaneAnswer{});
  if (!impl_->machine.able) return;
  const LaneRegion* before = nullptr;
  for (std::size_t first = 0; first < requests.size();) {
    impl_->go_to(requests[first].p);
    std::size_t count = 1;
    while (count < lanes::width && first + count < requests.size() && impl_->machine.cell_of(requests[first + count].p) == impl_->cell)
      ++count;
    if (impl_->region) {
      impl_->solve_batch(question, errors, requests.subspan(first, count), answers.subspan(first, count),
                         before == impl_->region.get());
    }
    before = impl_->region.get();
    first += count;
  }
}

const Configuration* LaneSolver::nominal_near(const Vector3& p) {
  if (!impl_->machine.able) return nullptr;
  impl_->go_to(p);
  return impl_->region ? &impl_->region->nominal() : nullptr;
}

// Neighbouring regions agree about a place between them; along a longer way the nominal machine is followed.
bool LaneSolver::joins(const Vector3& from, const Vector3& to) {
  if (!impl_->machine.able) return false;
  const Cell cell_from = impl_->machine.cell_of(from), cell_to = impl_->machine.cell_of(to);
  impl_->go_to(from);
  const RegionPointer begin = impl_->region;
  if (cell_from == cell_to) return begin != nullptr;
  impl_->go_to(to);
  const RegionPointer end = impl_->region;
  if (!begin || !end) return false;
  const Eigen::VectorXd there = end->rho_at(to);
  const double l = impl_->machine.model.mechanism.length;
  if (are_neighbours(cell_from, cell_to)) return (begin->rho_at(to) - there).norm() < same_branch * l;
  const NominalResult followed =
      follow(impl_->machine.model, begin->nominal(), {tip(impl_->machine.model.mechanism, impl_->machine.model.home).R, to});
  return followed.status == Status::converged &&
         (actuator_values(impl_->machine.model.mechanism, followed.configuration) - there).norm() < same_branch * l;
}

bool LaneSolver::nominal_tip(const Vector3& p, Pose& X_MT) {
  if (!impl_->machine.able) return false;
  impl_->go_to(p);
  if (!impl_->region) return false;
  X_MT = {impl_->region->R_MT(p), p};
  return true;
}

}  // namespace counterflex
