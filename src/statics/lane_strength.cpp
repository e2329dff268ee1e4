#include "lane_strength.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "continuation.hpp"

namespace counterflex {
namespace {

constexpr double load_margin = 1.25;

/// What stays the same while one zone is judged.
struct Judge {
  const Model& model;
  const LaneModel& lane_model;
  const LaneZone& zone;
  lanes::Acting acting;
  StaticsWork& work;
  LaneMemory memory{lane_model};

  Stage stage() const { return {.errors = acting.errors ? 1.0 : 0.0, .gravity = acting.weights ? 1.0 : 0.0}; }
  lanes::Question question() const { return {.target = false, .kinematics = false, .acting = acting, .go_on = false}; }
  Configuration found_in(int lane) const {
    return lane_model.configuration_of(memory.state(lane).data(), zone.reference());
  }
};

// Alone: from the zone's nominal configuration to a place, and from nothing to errors and load there. None where that fails.
std::optional<Configuration> followed(Judge& judge, const Vector3& p, const Load& load) {
  const Matrix3 R_MT = tip(judge.model.mechanism, judge.model.home).R;
  const NominalResult nominal = follow(judge.model, judge.zone.nominal(), {R_MT, p});
  if (nominal.status != Status::converged) return std::nullopt;
  Equilibrium found = solve_forward(judge.model, nominal.configuration, load, judge.stage(), judge.work);
  if (found.status != Status::converged) return std::nullopt;
  return std::move(found.configuration);
}

bool stands_well(Judge& judge, const Configuration& loaded, const Load& load) {
  const Problem problem{load, judge.stage(), nullptr};
  evaluate_all(judge.model, loaded, problem.stage, judge.work.impl());
  Equilibrium found;
  found.configuration = loaded;
  counterflex::judge(judge.model, problem, judge.work.impl(), found);
  return found.status == Status::converged;
}

// Whether the platform stands elsewhere than the tangent of the unloaded machine foresees it, by more than half: on the other
// side of a limit load, say.
bool stands_elsewhere(const Judge& judge, const Configuration& unloaded, const Configuration& loaded, const Load& load) {
  const lanes::Program& program = judge.lane_model.program();
  const double* response = judge.zone.flat().tangents + program.response + program.rows * 6;
  const Vector6 twist = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(response) * load.F;
  Configuration foreseen = unloaded;
  foreseen.X_MP = moved(unloaded.X_MP, twist);
  return ends_elsewhere(judge.model.mechanism, unloaded, foreseen, loaded);
}

// Without a load the machine is followed to the centre (with errors it was, when the zone was made); then one load a lane.
// The loaded configurations; fewer where one is not borne.
std::vector<Configuration> borne_at_centre(Judge& judge, const std::vector<Load>& loads) {
  const Vector3& centre = judge.zone.centre();
  std::vector<Configuration> list;
  const std::optional<Configuration> unloaded = judge.acting.errors && judge.acting.weights ? judge.zone.reference() : followed(judge, centre, {});
  if (!unloaded) return list;
  for (std::size_t first = 0; first < loads.size(); first += lanes::width) {
    const std::size_t count = std::min<std::size_t>(lanes::width, loads.size() - first);
    for (int lane = 0; lane < lanes::width; ++lane)
      put_in_lane(centre, loads[first + std::min(static_cast<std::size_t>(lane), count - 1)].F, lane, judge.memory.batch);
    judge.memory.solve(judge.zone.flat(), judge.question());
    for (std::size_t i = 0; i < count; ++i) {
      const Load& load = loads[first + i];
      std::optional<Configuration> loaded;
      if (judge.memory.batch.converged[i]) loaded = judge.found_in(static_cast<int>(i));
      if (!loaded || stands_elsewhere(judge, *unloaded, *loaded, load))
        loaded = followed(judge, centre, load);
      else if (!stands_well(judge, *loaded, load))
        loaded.reset();
      if (!loaded) return list;
      list.push_back(std::move(*loaded));
    }
  }
  return list;
}

void solve_corners(Judge& judge, const lanes::Region& region, const Load& load) {
  static_assert(lanes::width == 8);
  for (int lane = 0; lane < lanes::width; ++lane) put_in_lane(judge.zone.corner(lane), load.F, lane, judge.memory.batch);
  judge.memory.solve(region, judge.question());
}

// Those that lanes do not prove are judged alone.
bool bears_where_solved(Judge& judge, const lanes::Region& region, const Load& load) {
  const auto proven = judge.memory.stable(region, judge.question());
  for (int lane = 0; lane < lanes::width; ++lane) {
    if (proven[static_cast<std::size_t>(lane)]) continue;
    const bool borne = judge.memory.batch.converged[lane] ? stands_well(judge, judge.found_in(lane), load)
                                                          : followed(judge, judge.zone.corner(lane), load).has_value();
    if (!borne) return false;
  }
  return true;
}

// One corner a lane, with the zone's tangents; where these do not do, with those of the loaded centre.
bool bears_at_corners(Judge& judge, const Configuration& loaded_centre, const Load& load) {
  const lanes::Region& flat = judge.zone.flat();
  solve_corners(judge, flat, load);
  const auto& converged = judge.memory.batch.converged;
  LaneTangents tangents;
  if (std::count(std::begin(converged), std::end(converged), true) == lanes::width ||
      !tangents.take(judge.model, judge.lane_model, loaded_centre, judge.zone.actuators_by_position(judge.zone.centre()),
                     judge.work))
    return bears_where_solved(judge, flat, load);
  lanes::Region loaded = flat;
  const LaneStart start(judge.lane_model.state_of(loaded_centre));
  start.enter(loaded);
  loaded.tangents = tangents.numbers.data();
  solve_corners(judge, loaded, load);
  return bears_where_solved(judge, loaded, load);
}

}  // namespace

// A vector of three components is in the octahedron of sqrt 3 times its length; with another beside it in that of the sum.
std::vector<Load> corners_of_loads(double force, double moment, bool at_platform) {
  const int axes = moment > 0 ? 6 : 3;
  const double margin = load_margin * std::sqrt(3.0) * (moment > 0 ? 2 : 1);
  std::vector<Load> loads;
  for (int axis = 0; axis < axes; ++axis)
    for (const double sign : {1.0, -1.0}) {
      loads.push_back({Vector6::Zero(), at_platform});
      loads.back().F[axis] = sign * margin * (axis < 3 ? force : moment);
    }
  return loads;
}

bool bears_everywhere(const Model& model, const LaneModel& lane_model, const LaneZone& zone, const std::vector<Load>& loads,
                      lanes::Acting acting, StaticsWork& work) {
  Judge judge{model, lane_model, zone, acting, work};
  const std::vector<Configuration> at_centre = borne_at_centre(judge, loads);
  if (at_centre.size() < loads.size()) return false;
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (!bears_at_corners(judge, at_centre[i], loads[i])) return false;
  return true;
}

}  // namespace counterflex
