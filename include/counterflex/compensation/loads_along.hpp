#pragma once
/// Loads in joints and springs along a path of any length, and its deviation under other forces: at a bounded
/// number of places.
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/program/program.hpp"
#include "counterflex/statics/batch_solver.hpp"
#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

/// A place of a feed move or of a cycle, what is commanded and what acts there.
struct LoadPlace {
  std::size_t number = 0;            ///< of its waypoint, counted from the beginning
  Waypoint at;                       ///< its weight is that of all waypoints it represents
  Vector3 target = Vector3::Zero();  ///< the written one, or the original where nothing was corrected; M (m)
  Load load;
  const Model* model = nullptr;  ///< with the tool in the spindle
  std::int32_t tool = 0;         ///< its number; 0: none known
  std::size_t frame = 0;         ///< index into Program::frames
};

/// Which waypoint of a stretch `LoadPlaces` keeps.
enum class KeptPlace {
  largest_force,
  largest_rest,  ///< the one whose deviation after uses up most of its tolerance (`share_of_tolerance`)
};

/// Takes the waypoints of a path in their order, those between the ends of pieces, too, and keeps a part of
/// them: of each stretch of equally many the one with the largest force or rest (the first of equal ones),
/// and of all those with the largest force, moment and deviation before. Which are kept depends on the
/// waypoints alone, not on where the path was cut into windows. Rapids and unsolved waypoints are ignored.
class LoadPlaces {
 public:
  static constexpr std::size_t most = 1024;

  explicit LoadPlaces(KeptPlace kept = KeptPlace::largest_force) : kept_(kept) {}

  /// The next ones, of a window of the path. The job's models outlive what is kept.
  void add(const Job& job, const std::vector<Waypoint>& waypoints);

  /// At most `most`, in order.
  std::vector<LoadPlace> places() const;

  /// The one with the largest deviation before; null without one.
  const LoadPlace* worst_before() const { return before_.place ? &*before_.place : nullptr; }

 private:
  /// A kept place, and the value for which it is kept.
  struct Peak {
    double value = 0;
    std::optional<LoadPlace> place{};
  };

  double value_of(const Job& job, const Waypoint& w) const;
  void raise(Peak& peak, double value, const Job& job, const Waypoint& w) const;
  void add_to_stretch(const Job& job, const Waypoint& w);
  void add_peaks(const Job& job, const Waypoint& w);
  LoadPlace place_of(const Job& job, const Waypoint& w) const;
  void merge_neighbours();

  KeptPlace kept_;
  std::vector<Peak> stretches_;
  std::size_t per_stretch_ = 1, in_last_ = 0, count_ = 0;
  Peak force_, moment_, before_;
};

struct LoadsAtPlace {
  double s = 0;  ///< cutting path length (m)
  int line = 0;
  std::vector<ChainLoads> chains;  ///< of the machine without the tool
};

struct LoadsAlong {
  std::vector<LoadsAtPlace> places;  ///< in order
  std::size_t unsolved = 0;          ///< places besides them that were not solved
};

/// The machine's loads with everything acting. `base`: the machine without a tool that makes it another one.
/// `starts`: as for a job. The result does not depend on `threads`.
LoadsAlong solve_loads(const Model& base, const std::vector<LoadPlace>& places, int threads,
                       const StartTables* starts = nullptr);

/// The nominal machine at the commanded target of each place. `starts`, `threads`: as for `solve_loads`.
std::vector<NominalResult> solve_nominal(const std::vector<LoadPlace>& places, int threads,
                                         const StartTables* starts = nullptr);

/// The causes of the deviation before at a place. Nothing where they cannot be solved.
std::optional<Causes> solve_causes(const LoadPlace& place, const StartTables* starts = nullptr);

/// By how much the force of a sensitivity is higher or lower than the given one: wear, overrides.
inline constexpr double force_change = 0.3;

/// The target of a place solved forward under another force than the given one, as for a waypoint.
struct OtherForce {
  Vector6 deviation = Vector6::Zero();
  Status status = Status::converged;  ///< only then does the deviation mean something
};

/// Under `factor` times the force; by place. Where no force acts, it is that of the waypoint.
std::vector<OtherForce> solve_other_force(const std::vector<LoadPlace>& places, double factor, int threads,
                                          const StartTables* starts = nullptr);

// What touching off with the machine finds: where the tip of the unloaded machine is, relative to where
// it should. Lengths in m but for program coordinates, which are in mm.

/// A place on a feed move or in a hole.
struct PathPlace {
  Vector3 p_mm = Vector3::Zero();  ///< coordinates of the work offset; of M if the program gives its pose
  std::optional<Matrix3> R{};      ///< orientation there, where the program gives one
};

/// Places on the feed moves of a program and in the holes of its cycles, for each work offset at equal
/// distances along them: at most 64, and at least 32 on a path above a millimetre. Where the program is cut
/// into windows changes nothing.
class PathPlaces {
 public:
  static constexpr std::size_t most = 64;

  /// The next window of the program. Moves whose start or end is not known are ignored.
  void add(const Program& window);

  /// The name of the frame's work offset. It differs with what the program itself sets of the offset.
  static std::string offset_of(const ProgramFrame& frame);

  /// Of the work offset of that name.
  std::span<const PathPlace> of(const std::string& offset) const;

 private:
  struct OfOffset {
    double spacing_mm = 1e-3, way_mm = 0;
    std::vector<PathPlace> places;  ///< place k is at k times the spacing
  };
  void add(const Curve& way_of_tip, const Move& move, const ProgramFrame& frame);

  std::map<std::string, OfOffset> offsets_;
};

/// The position of the unloaded machine's tip relative to the nominal one, axes of M; errors and weights act.
/// Meaningful where `status` is converged.
struct UnloadedDeviation {
  Status status = Status::not_converged;
  Vector3 d = Vector3::Zero();
};

/// `outside_travel` where an actuator would be beyond its travel. `starts`: as for a job.
UnloadedDeviation unloaded_deviation(const TipPosition& at, const StartTables* starts = nullptr);

/// The mean over `places` of the offset at `X_MW`: the common shift of a path that the errors and the weights
/// of the machine cause: of that with [tool], with which it touches. Up to the first place that the machine
/// does not reach; nothing if it does not reach the first one.
std::optional<Vector3> common_shift(const Model& model, const Pose& X_MW, std::span<const PathPlace> places,
                                    const StartTables* starts = nullptr, int threads = 1);

// Commands between waypoints at which actuators may go farther than at the waypoints.

struct OutermostCommands {
  std::vector<TipPosition> positions;
  std::vector<std::size_t> waypoints;  ///< for each position the index of its waypoint, in order
};

/// The outermost places of an arc between a waypoint and the one before it, and the bottom and the retract
/// plane of a cycle that is called there. They are shifted as the waypoint is. Depths that are not known,
/// arcs along which the program turns the tool, waypoints that are not solved, and machines that control
/// nothing give none.
OutermostCommands outermost_commands(const Job& job, std::span<const Waypoint> waypoints);

/// The actuators of the nominal machine at each position (m, rad); empty where it does not reach it.
std::vector<std::optional<Eigen::VectorXd>> actuators_at(const Job& job,
                                                         std::span<const TipPosition> positions);

// Why a target is outside the travel of an actuator, in words.

/// A position that is commanded, and what puts it there. Borrowed: everything outlives it.
struct CommandedPlace {
  const Model& model;          ///< with the tool in the spindle
  const WorkFrame& frame;      ///< of the move
  long tool = 0;               ///< its number; 0: none known
  Vector3 target;              ///< in M (m)
  std::optional<Matrix3> R{};  ///< its orientation, where the program gives one
  Eigen::VectorXd
      rho{};  ///< the actuators there (m, rad), where they are known; else they are those from home
};

/// "axis Z: 138.0 mm is outside its travel (-300 to 0 mm): ...", with the parts that make up the value where
/// the axis is parallel to one of the work offset's, and what to do. `named`: the machine without a tool,
/// whose actuators have names.
std::string outside_travel_words(const Mechanism& named, const CommandedPlace& at);

}  // namespace counterflex
