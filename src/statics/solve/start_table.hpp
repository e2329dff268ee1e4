#pragma once
/// The cells in which the kernel starts, on a lattice of tip positions.
#include <memory>
#include <optional>
#include <vector>

#include "counterflex/statics/batch_solver.hpp"
#include "statics/solve/cell_cache.hpp"

namespace counterflex {

/// The stage of the cells in which the kernel starts in `stage`: errors and weights act or not, everything
/// else does. None where a part of something acts.
std::optional<Stage> stage_of_cells(const Stage& stage, bool has_weight);

/// Nominal kinematics around the centre of a cell.
struct KinematicsCell {
  Configuration nominal;  ///< at the centre, reached straight from home or from the landmark of the cell
  kernel::StartCell start;
  std::optional<Matrix3> R_MT;  ///< of the nominal tip, where it does not depend on the position
};

std::size_t bytes_of(const KinematicsCell& cell);

struct StartTable::Impl {
  const Model& model;
  const bool at_platform;
  const kernel::Flat flat, rigid;
  const std::vector<kernel::Transform> perfect, real, rigid_transforms;
  const Matrix3 R_home;
  const bool is_able;             ///< the kernel solves the machine, which controls x, y and z
  const bool controls_positions;  ///< and no orientation
  const bool has_weights;
  const double edge;  ///< of a cell (m)

  Impl(const Model& m, bool platform, std::shared_ptr<CellCache> cells);

  /// The cell that holds `p` and the rotation vector `turn`; none where that is absurdly far or no number.
  std::optional<CellIndex> index_of(const Vector3& p, const Vector3& turn = Vector3::Zero()) const;

  std::shared_ptr<const KinematicsCell> kinematics(const CellIndex& index);
  std::shared_ptr<const kernel::StartCell> target(const CellIndex& index, const Stage& stage);

  /// The real machine, and the nominal one.
  kernel::Question question(const Stage& stage) const;
  kernel::Question nominal() const { return kernel::nominal_question(rigid.machine, rigid_transforms); }

 private:
  std::shared_ptr<const KinematicsCell> make_kinematics(const CellIndex& index);
  /// The nominal configuration at the centre of a cell. It is reached straight from that of its landmark, a
  /// cell near it that depends on the index alone; if that fails, from home.
  NominalResult nominal_at(const CellIndex& index);
  std::shared_ptr<const kernel::StartCell> make_target(const CellIndex& index, const Stage& stage);
  kernel::CellPlace place_of(const CellIndex& index) const;

  const std::shared_ptr<CellCache> cells_;
};

}  // namespace counterflex
