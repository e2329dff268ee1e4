#pragma once
/// What touching off with the machine finds: where the tip of the unloaded machine is, relative to where
/// it should. Lengths in m but for program coordinates, which are in mm.
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "counterflex/program/program.hpp"
#include "counterflex/statics/batch_solver.hpp"
#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// A place on a feed move.
struct PathPlace {
  Vector3 p_mm = Vector3::Zero();  ///< coordinates of the work offset
  long tool = 0;                   ///< in the spindle
};

/// Places on the feed moves of a program, for each work offset at equal distances along its moves: at most
/// 64, and at least 32 on a path above a millimetre. Where the program is cut into windows changes nothing.
class PathPlaces {
 public:
  static constexpr std::size_t most = 64;

  /// The next window of the program. Moves whose start or end is not known, or whose offset the program sets,
  /// are passed over.
  void add(const Program& window);

  /// Of the work offset of that name.
  std::span<const PathPlace> of(const std::string& offset) const;

 private:
  struct OfOffset {
    double spacing_mm = 1e-3, way_mm = 0;
    std::vector<PathPlace> places;  ///< place k is at k times the spacing
  };
  static void add(const Move& move, const ProgramFrame& frame, OfOffset& of);

  std::map<std::string, OfOffset> offsets_;
};

/// The position of the unloaded machine's tip relative to the nominal one, axes of M; errors and weights act.
/// Meaningful where `status` is converged.
struct UnloadedDeviation {
  Status status = Status::not_converged;
  Vector3 d = Vector3::Zero();
};

/// At `p_MT` (M, m). `starts`: as for a job.
UnloadedDeviation unloaded_deviation(const Model& model, const Vector3& p_MT,
                                     const StartTables* starts = nullptr);

/// The mean over `places` of the offset at `X_MW`: the common shift of a path that the errors and the weights
/// of the machine cause. Up to the first place that the machine does not reach; nothing if it does not reach
/// the first one.
std::optional<Vector3> common_shift(const Model& model, const ToolModels& tools, const Pose& X_MW,
                                    std::span<const PathPlace> places, const StartTables* starts = nullptr);

}  // namespace counterflex
