#include "counterflex/statics/lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "lane_cell.hpp"
#include "end_springs.hpp"

namespace counterflex {

namespace lane_grid {

/// Edge of a cell, in units of l, and cells along an edge of a zone. One chain that only slides has nominal kinematics without
/// bends, and to first order in the load a Hessian that is linear in the position.
struct Grid {
  double cell_share;
  long cells_along_zone;
};
constexpr Grid bent_grid{1.0 / 24, 3}, straight_grid{1.0 / 8, 8};
constexpr double reach_of_cells = 2;       // from their centres, in edges: so that batches are full
constexpr std::size_t most_zones = 512, least_cells = 64, most_cells = 1024, bytes_of_cells = 12'000'000;
constexpr double farthest_cell = 1e6;      // from the origin of M: nothing that is a machine
constexpr double slack = 1e-11;  // m: at a spring of a rigid machine
constexpr double same_branch = 1e-3;  // l or rad: another branch is further away

Vector3 no_position() { return Vector3::Constant(std::numeric_limits<double>::quiet_NaN()); }

struct Index {
  long x, y, z;
  bool operator==(const Index&) const = default;
};

struct IndexHash {
  std::size_t operator()(const Index& i) const {
    return static_cast<std::size_t>(i.x * 73856093L ^ i.y * 19349663L ^ i.z * 83492791L);
  }
};

bool are_neighbours(const Index& a, const Index& b) {
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 && std::abs(a.z - b.z) <= 1;
}

Index zone_of(const Index& cell, long cells_along_zone) {
  const auto along = [n = cells_along_zone](long i) { return i >= 0 ? i / n : -((n - 1 - i) / n); };
  return {along(cell.x), along(cell.y), along(cell.z)};
}

Vector3 centre_of(const Index& i, double edge) {
  return edge * (Vector3(static_cast<double>(i.x), static_cast<double>(i.y), static_cast<double>(i.z)).array() + 0.5);
}

bool only_slides(const Mechanism& mechanism) {
  return mechanism.chains.size() == 1 && std::all_of(mechanism.chains.begin(), mechanism.chains.end(), [](const Series& chain) {
    return std::all_of(chain.parts.begin(), chain.parts.end(), [](const Part& part) {
      const bool turns = part.kind == PartKind::actuator && part.joint.kind == JointKind::revolute;
      return !turns && part.kind != PartKind::passive && part.kind != PartKind::group;
    });
  });
}

/// How many cells are kept: a raster needs those of two of its lines, whatever the machine.
std::size_t kept_cells(const lanes::Program& program) {
  const auto numbers = static_cast<std::size_t>(program.tangents + (program.rows + 6) * 2 * lanes::most_monomials + 3 * program.states);
  return std::clamp(bytes_of_cells / (sizeof(double) * numbers), least_cells, most_cells);
}

/// The things made last, up to a number; null ones, for places where nothing can be made, too. What is made depends on the
/// index alone: two threads that make the same thing at once do no harm.
template <class Thing>
class Cache {
 public:
  using Pointer = std::shared_ptr<const Thing>;
  explicit Cache(std::size_t most) : most_(most) {}

  template <class Make>
  Pointer get(const Index& index, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = things_.find(index); found != things_.end()) return use(found->second);
    }
    Pointer made = make();
    const std::lock_guard lock(mutex_);
    if (things_.size() >= most_) forget_older_half();
    return use(things_.try_emplace(index, Entry{std::move(made), 0}).first->second);
  }

 private:
  struct Entry {
    Pointer thing;
    unsigned long used;
  };

  Pointer use(Entry& entry) {
    entry.used = ++clock_;
    return entry.thing;
  }

  void forget_older_half() {
    std::vector<unsigned long> times;
    for (const auto& [index, entry] : things_) times.push_back(entry.used);
    const auto middle = times.begin() + static_cast<long>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    std::erase_if(things_, [limit = *middle](const auto& item) { return item.second.used < limit; });
  }

  const std::size_t most_;
  std::mutex mutex_;
  std::unordered_map<Index, Entry, IndexHash> things_;
  unsigned long clock_ = 0;
};

}  // namespace lane_grid

using namespace lane_grid;

struct LaneMachine::Impl {
  const std::optional<Model> sprung;  // what is solved for a rigid machine
  const Model& model;
  LaneModel lane_model;
  const bool able, weighs;
  const Grid grid;
  const double edge, reach;  // of a cell; largest correction
  Cache<LaneZone> zones{most_zones};
  Cache<LaneCell> cells{kept_cells(lane_model.program())};

  Impl(const Model& m, bool at_platform, double largest_correction)
      : sprung(is_rigid(m.mechanism) ? std::optional<Model>(with_end_springs(m)) : std::nullopt),
        model(sprung ? *sprung : m),
        lane_model(model, at_platform),
        able(LaneModel::can_do(model.mechanism)),
        weighs(has_weight(model.mechanism)),
        grid(only_slides(m.mechanism) ? straight_grid : bent_grid),
        edge(grid.cell_share * m.mechanism.length),
        reach(largest_correction) {}

  /// The cell that holds `p`; none where that is absurdly far or no number.
  std::optional<Index> index_of(const Vector3& p) const {
    const Vector3 n = (p / edge).array().floor();
    if (!(n.array().abs() <= farthest_cell).all()) return std::nullopt;
    return Index{static_cast<long>(n[0]), static_cast<long>(n[1]), static_cast<long>(n[2])};
  }

  Index zone_of(const Index& cell) const { return lane_grid::zone_of(cell, grid.cells_along_zone); }

  std::shared_ptr<const LaneCell> cell(const Index& index, StaticsWork& work) {
    return cells.get(index, [&]() -> std::shared_ptr<const LaneCell> {
      const Index at = zone_of(index);
      const double zone_edge = static_cast<double>(grid.cells_along_zone) * edge;
      const auto zone = zones.get(at, [&]() -> std::shared_ptr<const LaneZone> {
        return LaneZone::make(model, lane_model, centre_of(at, zone_edge), zone_edge / 2 + reach, work);
      });
      if (!zone) return nullptr;
      return LaneCell::make(model, lane_model, zone, centre_of(index, edge), reach_of_cells * edge, work);
    });
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
  const auto key = std::make_pair(&model, at_platform);
  if (const auto found = impl_->machines.find(key); found != impl_->machines.end()) return found->second;
  return impl_->machines
      .emplace(std::piecewise_construct, std::forward_as_tuple(key), std::forward_as_tuple(model, at_platform, impl_->reach))
      .first->second;
}

const char* lane_instructions() { return lanes::best_kernel().name; }

struct LaneSolver::Impl {
  LaneMachine::Impl& machine;
  StaticsWork work;
  LaneMemory memory;
  std::shared_ptr<const LaneCell> cell{};
  Index index{};
  Configuration rigid_nominal{};  // of a rigid machine, what `nominal_near` has found

  explicit Impl(LaneMachine::Impl& m) : machine(m), work(m.model.mechanism), memory(m.lane_model) {}

  /// What a stage lets act; none where a part of something acts.
  std::optional<lanes::Acting> acting(const Stage& stage) const {
    const auto is_whole = [](double part) { return part == 0 || part == 1; };
    if (!is_whole(stage.errors) || stage.preload != 1) return std::nullopt;
    if (!machine.weighs) return lanes::Acting{stage.errors == 1, true};
    if (!is_whole(stage.gravity)) return std::nullopt;
    return lanes::Acting{stage.errors == 1, stage.gravity == 1};
  }

  /// To the cell that holds `p`; false where lanes cannot do with it.
  bool go_to(const Vector3& p) {
    const std::optional<Index> at = machine.index_of(p);
    if (!at) return false;
    if (!cell || *at != index) cell = machine.cell(*at, work);
    index = *at;
    return cell != nullptr;
  }

  bool in_travel(int lane) const {
    const auto& travel = machine.model.mechanism.travel;
    for (std::size_t a = 0; a < travel.size(); ++a)
      if (const double rho = memory.rho(a, lane); !(rho >= travel[a].min && rho <= travel[a].max)) return false;
    return true;
  }

  // Lanes beyond the last request do what that does.
  template <class Position>  // Vector3(std::size_t request)
  void load_positions(std::size_t count, const Position& position) {
    for (int lane = 0; lane < lanes::width; ++lane) {
      const Vector3 p = position(std::min(static_cast<std::size_t>(lane), count - 1));
      for (int i = 0; i < 3; ++i) memory.batch.p[i][lane] = p[i];
    }
  }

  void load_wrenches(std::span<const LaneRequest> requests) {
    for (int lane = 0; lane < lanes::width; ++lane) {
      const LaneRequest& request = requests[std::min(static_cast<std::size_t>(lane), requests.size() - 1)];
      for (int i = 0; i < 6; ++i) memory.batch.F[i][lane] = machine.sprung ? 0 : request.F[i];
    }
  }

  // Of a rigid machine: whether its closures hold without a spring's help.
  bool stands_rigid(int lane) const {
    return !machine.sprung || memory.largest_wrench(lane) <= slack * machine.model.mechanism.stiffest;
  }

  LaneAnswer answer(int lane) const {
    const lanes::Batch& batch = memory.batch;
    LaneAnswer result;
    for (int i = 0; i < 3; ++i) result.command[i] = batch.p[i][lane];
    for (int i = 0; i < 9; ++i) result.X_MT.R(i / 3, i % 3) = batch.tip[i][lane];
    for (int i = 0; i < 3; ++i) result.X_MT.p[i] = batch.tip[9 + i][lane];
    result.iterations = static_cast<int>(batch.iterations[lane]);
    result.solved =
        batch.converged[lane] && in_travel(lane) && cell->zone().holds(result.command) && stands_rigid(lane);
    return result;
  }

  bool bears(std::span<const LaneRequest> requests, lanes::Acting acting) {
    if (machine.sprung) return true;  // loads do not move it
    double force = 0, moment = 0;
    for (const LaneRequest& request : requests) {
      force = std::max(force, request.F.head<3>().norm());
      moment = std::max(moment, request.F.tail<3>().norm());
    }
    return cell->zone().bears(force, moment, acting, work);
  }

  // The largest loads of a batch may not be borne together; each with its own then.
  bool bears_any(std::span<const LaneRequest> requests, lanes::Acting acting) {
    for (std::size_t i = 0; i < requests.size(); ++i)
      if (bears(requests.subspan(i, 1), acting)) return true;
    return false;
  }

  template <class Take>  // void(std::size_t request, const LaneAnswer&)
  void solve_batch(const lanes::Question& question, std::size_t count, const Take& take) {
    memory.solve(cell->region(question.acting), question);
    for (std::size_t i = 0; i < count; ++i) take(i, answer(static_cast<int>(i)));
  }

  void solve_through(std::span<const LaneRequest> requests, std::span<const Vector3> originals, const LaneWritten& written,
                     std::span<LaneThrough> answers) {
    const std::size_t count = requests.size();
    load_wrenches(requests);
    load_positions(count, [&](std::size_t i) { return originals[i]; });
    solve_batch({.target = false, .kinematics = false, .acting = lanes::everything, .go_on = false}, count,
                [&](std::size_t i, const LaneAnswer& a) { answers[i].before = a; });
    load_positions(count, [&](std::size_t i) { return requests[i].p; });
    solve_batch({.target = true, .kinematics = false, .acting = lanes::everything, .go_on = true}, count,
                [&](std::size_t i, const LaneAnswer& a) { answers[i].target = a; });
    std::array<Vector3, lanes::width> commands;
    for (std::size_t i = 0; i < count; ++i)
      commands[i] = answers[i].target.solved ? written(i, answers[i].target.command) : no_position();
    load_positions(count, [&](std::size_t i) { return commands[i]; });
    solve_batch({.target = false, .kinematics = false, .acting = lanes::everything, .go_on = true}, count,
                [&](std::size_t i, const LaneAnswer& a) { answers[i].after = a; });
  }

  // Solves in batches of neighbours, those whose loads are borne. A waypoint whose load is not borne is withdrawn again.
  template <class Solve, class Withdraw>  // void(std::size_t first, std::size_t count), void(std::size_t request)
  void in_batches(lanes::Acting acting, std::span<const LaneRequest> requests, const Solve& solve, const Withdraw& withdraw) {
    if (!machine.able) return;
    for (std::size_t first = 0, count = 1; first < requests.size(); first += count, count = 1) {
      if (!go_to(requests[first].p)) continue;
      while (count < lanes::width && first + count < requests.size() && cell->holds(requests[first + count].p)) ++count;
      const auto batch = requests.subspan(first, count);
      const bool all_borne = bears(batch, acting);
      if (!all_borne && !bears_any(batch, acting)) continue;
      solve(first, count);
      for (std::size_t i = 0; !all_borne && i < count; ++i)
        if (!bears(batch.subspan(i, 1), acting)) withdraw(first + i);
    }
  }
};

LaneSolver::LaneSolver(const LaneMachine& machine) : impl_(std::make_unique<Impl>(machine.impl())) {}
LaneSolver::~LaneSolver() = default;
LaneSolver::LaneSolver(LaneSolver&&) noexcept = default;

void LaneSolver::solve(LaneQuestion question, const Stage& stage, std::span<const LaneRequest> requests,
                       std::span<LaneAnswer> answers) {
  std::fill(answers.begin(), answers.end(), LaneAnswer{});
  const std::optional<lanes::Acting> acting = impl_->acting(stage);
  if (!acting) return;
  const auto solve_some = [&](std::size_t first, std::size_t count) {
    impl_->load_wrenches(requests.subspan(first, count));
    impl_->load_positions(count, [&](std::size_t i) { return requests[first + i].p; });
    impl_->solve_batch({.target = question == LaneQuestion::target, .kinematics = false, .acting = *acting, .go_on = false}, count,
                       [&](std::size_t i, const LaneAnswer& a) { answers[first + i] = a; });
  };
  impl_->in_batches(*acting, requests, solve_some, [&](std::size_t i) { answers[i].solved = false; });
}

void LaneSolver::solve_through(std::span<const LaneRequest> requests, std::span<const Vector3> originals,
                               const LaneWritten& written, std::span<LaneThrough> answers) {
  std::fill(answers.begin(), answers.end(), LaneThrough{});
  const auto solve_some = [&](std::size_t first, std::size_t count) {
    const auto written_of = [&](std::size_t i, const Vector3& command) { return written(first + i, command); };
    impl_->solve_through(requests.subspan(first, count), originals.subspan(first, count), written_of,
                         answers.subspan(first, count));
  };
  impl_->in_batches(lanes::everything, requests, solve_some, [&](std::size_t i) { answers[i] = {}; });
}

bool LaneSolver::nominal_tip(const Vector3& p, Pose& X_MT) {
  if (!impl_->machine.able || !impl_->go_to(p)) return false;
  X_MT = {impl_->cell->zone().R_MT(p), p};
  return true;
}

bool LaneSolver::nominal_actuators(const Vector3& p, Eigen::VectorXd& rho) {
  if (!impl_->machine.able || !impl_->go_to(p)) return false;
  rho = impl_->cell->zone().rho_at(p);
  return true;
}

const Configuration* LaneSolver::nominal_near(const Vector3& p) {
  if (!impl_->machine.able || !impl_->go_to(p)) return nullptr;
  const Configuration& nominal = impl_->cell->zone().nominal();
  if (!impl_->machine.sprung) return &nominal;
  return &(impl_->rigid_nominal = without_end_springs(nominal));
}

// Neighbouring zones agree about a place between them; along a longer way the nominal machine is followed, from its very
// beginning: beside a singularity it would pass.
bool LaneSolver::joins(const Vector3& from, const Vector3& to) {
  if (!impl_->machine.able || !impl_->go_to(from)) return false;
  const std::shared_ptr<const LaneCell> begin = impl_->cell;
  const Index zone_from = impl_->machine.zone_of(impl_->index);
  if (!impl_->go_to(to)) return false;
  const Index zone_to = impl_->machine.zone_of(impl_->index);
  if (zone_from == zone_to) return true;
  const Model& model = impl_->machine.model;
  const Eigen::VectorXd there = impl_->cell->zone().rho_at(to);
  const double limit = same_branch * model.mechanism.length;
  if (are_neighbours(zone_from, zone_to) && (begin->zone().rho_at(to) - there).norm() < limit) return true;
  const Matrix3 R_MT = tip(model.mechanism, model.home).R;
  const NominalResult start = follow(model, begin->zone().nominal(), {R_MT, from});
  if (start.status != Status::converged) return false;
  const NominalResult followed = follow(model, start.configuration, {R_MT, to});
  return followed.status == Status::converged &&
         (actuator_values(model.mechanism, followed.configuration) - there).norm() < limit;
}

}  // namespace counterflex
