#include "statics/solve/start_table.hpp"

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/pose.hpp"

namespace counterflex {
namespace {

constexpr double farthest_cell = 1e9;  // from the origin of M, in edges: their numbers fit

// Kinds of what is kept; a target adds two bits for its stage.
constexpr int of_landmark = 0, of_kinematics = 1, of_target = 2;

/// The cell in the middle of a cube of cells.
CellIndex landmark_of(const CellIndex& index) {
  constexpr long cells = 5;  // along an edge of the cube: 9: the same time
  const auto middle = [](long i) {
    return cells * static_cast<long>(std::floor((static_cast<double>(i) + 0.5) / cells)) + cells / 2;
  };
  CellIndex landmark;
  for (std::size_t i = 0; i < 3; ++i) {
    landmark.position[i] = middle(index.position[i]);
    landmark.turn[i] = middle(index.turn[i] + cells / 2) - cells / 2;  // that of home turns by nothing
  }
  return landmark;
}

std::size_t bytes_of(const kernel::Polynomials& polynomials) {
  return sizeof(kernel::Term) * polynomials.terms.capacity() +
         sizeof(double) * polynomials.coefficients.capacity();
}

std::size_t bytes_of(const std::vector<SeriesState>& chains) {
  std::size_t bytes = 0;
  for (const SeriesState& chain : chains) {
    bytes += sizeof(SeriesState) +
             sizeof(double) * static_cast<std::size_t>(chain.x.size() + chain.x_nominal.size());
    for (const GroupState& group : chain.groups) bytes += sizeof(GroupState) + bytes_of(group.branches);
  }
  return bytes;
}

}  // namespace

std::size_t bytes_of(const Configuration& configuration) {
  return sizeof(Configuration) + bytes_of(configuration.chains);
}

std::size_t bytes_of(const kernel::StartCell& cell) {
  std::size_t numbers = 0;
  for (const auto* own : {&cell.state, &cell.cosine, &cell.sine, &cell.stress, &cell.pivots})
    numbers += own->capacity();
  return sizeof(cell) + sizeof(double) * numbers + bytes_of(cell.changes) + bytes_of(cell.stress_changes) +
         bytes_of(cell.offset_changes);
}

std::size_t bytes_of(const KinematicsCell& cell) {
  return sizeof(cell) + bytes_of(cell.nominal) + bytes_of(cell.start);
}

std::optional<Stage> stage_of_cells(const Stage& stage, bool has_weight) {
  const Stage of_cells{.errors = stage.errors, .gravity = has_weight ? stage.gravity : 1};
  const auto is_whole = [](double part) { return part == 0 || part == 1; };
  if (!is_whole(of_cells.errors) || !is_whole(of_cells.gravity) || stage.preload != 1) return std::nullopt;
  return of_cells;
}

StartTable::Impl::Impl(const Model& m, bool platform, std::shared_ptr<CellCache> cells)
    : model(m),
      at_platform(platform),
      flat(kernel::flatten(m.mechanism, platform)),
      rigid(kernel::flatten_rigid(m.mechanism)),
      perfect(kernel::transforms_at(flat, 0)),
      real(kernel::transforms_at(flat, 1)),
      rigid_transforms(kernel::transforms_at(rigid, 0)),
      R_home(tip(m.mechanism, m.home).R),
      is_able(flat.is_solvable && m.mechanism.controlled.size() == m.mechanism.travel.size() &&
              controls(m.mechanism, Component::x) && controls(m.mechanism, Component::y) &&
              controls(m.mechanism, Component::z)),
      controls_positions(m.mechanism.controlled.size() == 3),
      has_weights(has_weight(m.mechanism)),
      edge((only_slides(m.mechanism) ? straight_edge : bent_edge) * m.mechanism.length),
      cells_(std::move(cells)) {}

std::optional<CellIndex> StartTable::Impl::index_of(const Vector3& p, const Vector3& turn) const {
  CellIndex index;
  for (std::size_t i = 0; i < 3; ++i) {
    const double n = p[static_cast<Eigen::Index>(i)] / edge,
                 m = controls_positions ? 0 : turn[static_cast<Eigen::Index>(i)] / turn_edge;
    if (!(std::abs(n) <= farthest_cell) || !(std::abs(m) <= farthest_cell)) return std::nullopt;
    index.position[i] = static_cast<long>(n);  // and down, without a call of floor
    if (static_cast<double>(index.position[i]) > n) --index.position[i];
    if (m != 0) index.turn[i] = std::lround(m);
  }
  return index;
}

kernel::CellPlace StartTable::Impl::place_of(const CellIndex& index) const {
  Vector3 corner, turn;
  for (std::size_t i = 0; i < 3; ++i) {
    corner[static_cast<Eigen::Index>(i)] = static_cast<double>(index.position[i]);
    turn[static_cast<Eigen::Index>(i)] = static_cast<double>(index.turn[i]);
  }
  return {exp_so3(turn_edge * turn) * R_home, !controls_positions, edge * (corner.array() + 0.5), edge / 2};
}

kernel::Question StartTable::Impl::question(const Stage& stage) const {
  return {.machine = &flat.machine,
          .transforms = stage.errors == 1 ? &real : &perfect,
          .gravity = stage.gravity,
          .errors = stage.errors};
}

std::shared_ptr<const KinematicsCell> StartTable::Impl::kinematics(const CellIndex& index) {
  return cells_->get<KinematicsCell>({this, of_kinematics, index}, [&] { return make_kinematics(index); });
}

std::shared_ptr<const kernel::StartCell> StartTable::Impl::target(const CellIndex& index,
                                                                  const Stage& stage) {
  const int kind = of_target + (stage.errors == 1 ? 1 : 0) + (stage.gravity == 1 ? 2 : 0);
  return cells_->get<kernel::StartCell>({this, kind, index}, [&] { return make_target(index, stage); });
}

NominalResult StartTable::Impl::nominal_at(const CellIndex& index) {
  const auto pose_of = [&](const CellIndex& at) {
    const kernel::CellPlace place = place_of(at);
    return Pose{place.R, place.centre};
  };
  const CellIndex landmark = landmark_of(index);
  const auto from = cells_->get<Configuration>(
      {this, of_landmark, landmark}, [&]() -> std::shared_ptr<const Configuration> {
        NominalResult there = follow(model, model.home, pose_of(landmark));
        if (there.status != Status::converged) return nullptr;
        return std::make_shared<const Configuration>(std::move(there.configuration));
      });
  if (from) {
    NominalResult near = follow(model, *from, pose_of(index));
    if (near.status == Status::converged) return near;
  }
  return follow(model, model.home, pose_of(index));
}

std::shared_ptr<const KinematicsCell> StartTable::Impl::make_kinematics(const CellIndex& index) {
  const kernel::CellPlace place = place_of(index);
  NominalResult nominal = nominal_at(index);
  if (nominal.status != Status::converged) return nullptr;
  auto start = make_kinematics_cell(this->nominal(), place,
                                    state_of(model.mechanism, rigid, nominal.configuration, 0));
  if (!start) return nullptr;
  std::optional<Matrix3> R_MT;
  if (start->only_translates) R_MT = tip(model.mechanism, nominal.configuration).R;
  return std::make_shared<const KinematicsCell>(
      KinematicsCell{std::move(nominal.configuration), std::move(*start), R_MT});
}

// The solver of single waypoints judges the machine at the centre without a load. In the cell the kernel then
// compares pivots with those of the centre.
std::shared_ptr<const kernel::StartCell> StartTable::Impl::make_target(const CellIndex& index,
                                                                       const Stage& stage) {
  const auto near = kinematics(index);
  if (!near) return nullptr;
  const kernel::CellPlace place = place_of(index);
  auto cell = make_target_cell(question(stage), nominal(), place,
                               state_of(model.mechanism, flat, near->nominal, 0), near->start);
  if (!cell) return nullptr;
  const Pose X_MT{place.R, place.centre};
  StaticsWork work(model.mechanism);
  const Equilibrium alone =
      solve_target(model, near->nominal, X_MT, {Vector6::Zero(), at_platform}, stage, work);
  if (alone.status != Status::converged) return nullptr;
  const Eigen::VectorXd rho = actuator_values(model.mechanism, alone.configuration);
  for (Eigen::Index a = 0; a < rho.size(); ++a) {
    const double found =
        cell->state[static_cast<std::size_t>(flat.machine.actuator_joint[static_cast<std::size_t>(a)])];
    const double offset = stage.gravity * flat.machine.actuator_offset[static_cast<std::size_t>(a)];
    if (!(std::abs(found - offset - rho[a]) < same_place * model.mechanism.length)) return nullptr;
  }
  return std::make_shared<const kernel::StartCell>(std::move(*cell));
}

}  // namespace counterflex
