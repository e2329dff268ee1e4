#pragma once
/// Loads in joints and springs along a path of any length, and its deviation under other forces: at a bounded
/// number of places.
#include <optional>
#include <vector>

#include "counterflex/compensation/waypoint.hpp"
#include "counterflex/statics/chain.hpp"

namespace counterflex {

/// A place of a feed move, what is commanded and what acts there.
struct LoadPlace {
  std::size_t number = 0;            ///< of its waypoint, counted from the beginning
  Waypoint at;                       ///< it weighs what those weigh that it stands for
  Vector3 target = Vector3::Zero();  ///< the written one, or the original where nothing was corrected; M (m)
  Load load;
  const Model* model = nullptr;  ///< with the tool in the spindle
};

/// Takes the waypoints of a path in their order, those between the ends of pieces, too, and keeps a part of
/// them: of each stretch of equally many the one with the largest force (the first of equal ones), and of all
/// those with the largest force, moment and deviation before. Which are kept depends on the waypoints alone,
/// not on where the path was cut into windows. Rapids and what was not solved are passed over.
class LoadPlaces {
 public:
  static constexpr std::size_t most = 1024;

  /// The next ones, of a window of the path. The job's models outlive what is kept.
  void add(const Job& job, const std::vector<Waypoint>& waypoints);

  /// At most `most`, in order.
  std::vector<LoadPlace> places() const;

 private:
  struct Peak {
    double value = 0;
    std::optional<LoadPlace> place{};
  };

  void add_to_stretch(const Job& job, const Waypoint& w);
  void add_peaks(const Job& job, const Waypoint& w);
  LoadPlace place_of(const Job& job, const Waypoint& w) const;
  void merge_neighbours();

  std::vector<LoadPlace> stretches_;
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

}  // namespace counterflex
