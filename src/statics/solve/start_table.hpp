#pragma once
/// The cells in which the kernel starts, on a lattice of tip positions.
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "counterflex/statics/batch_solver.hpp"
#include "statics/kernel/cells/start_cell.hpp"

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

/// A cell by its place on the lattices of positions and, where the machine controls an orientation, of
/// rotation vectors against home.
struct CellIndex {
  std::array<long, 3> position{}, turn{};
  bool operator==(const CellIndex&) const = default;
};

/// The things made last, up to a number; null where nothing can be made. What is made depends on the index
/// alone: if two threads make the same thing at once, either may be kept.
template <class Thing>
class CellCache {
 public:
  using Pointer = std::shared_ptr<const Thing>;

  template <class Make>
  Pointer get(const CellIndex& index, std::size_t most, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = things_.find(index); found != things_.end()) return use(found->second);
    }
    Pointer made = make();
    const std::lock_guard lock(mutex_);
    if (things_.size() >= most) forget_oldest_quarter();
    return use(things_.try_emplace(index, Entry{std::move(made), 0}).first->second);
  }

 private:
  struct Entry {
    Pointer thing;
    unsigned long used;
  };
  struct Hash {
    std::size_t operator()(const CellIndex& i) const {
      constexpr std::array<long, 3> primes{73856093L, 19349663L, 83492791L};
      long hash = 0;
      for (std::size_t k = 0; k < 3; ++k) hash ^= (i.position[k] + 7919L * i.turn[k]) * primes[k];
      return static_cast<std::size_t>(hash);
    }
  };

  Pointer use(Entry& entry) {
    entry.used = ++clock_;
    return entry.thing;
  }

  void forget_oldest_quarter() {
    std::vector<unsigned long> times;
    for (const auto& [index, entry] : things_) times.push_back(entry.used);
    const auto kept = times.begin() + static_cast<long>(std::max<std::size_t>(1, times.size() / 4));
    std::nth_element(times.begin(), kept, times.end());
    std::erase_if(things_, [limit = *kept](const auto& item) { return item.second.used < limit; });
  }

  std::mutex mutex_;
  std::unordered_map<CellIndex, Entry, Hash> things_;
  unsigned long clock_ = 0;
};

struct StartTable::Impl {
  const Model& model;
  const bool at_platform;
  const kernel::Flat flat, rigid;
  const std::vector<kernel::Transform> perfect, real, rigid_transforms;
  const Matrix3 R_home;
  const bool is_able;             ///< the kernel solves the machine, which controls x, y and z
  const bool controls_positions;  ///< and no orientation
  const bool has_weights;
  const double edge;             ///< of a cell (m)
  const std::size_t most_cells;  ///< that are kept

  Impl(const Model& m, bool platform);

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

  CellCache<Configuration> landmarks_;
  CellCache<KinematicsCell> kinematics_;
  std::array<CellCache<kernel::StartCell>, 4> targets_;
};

}  // namespace counterflex
