#include "lane_strength.hpp"

#include <algorithm>
#include <cmath>

#include "newton.hpp"

namespace counterflex {
namespace {

constexpr double load_margin = 1.25;

/// What stays the same while one zone is judged.
struct Judge {
  const Model& model;
  const LaneModel& lane_model;
  const LaneZone& zone;
  bool errors;
  StaticsWork& work;
  LaneMemory memory{lane_model};

  Stage stage() const { return {.errors = errors ? 1.0 : 0.0}; }
  lanes::Question question() const { return {.target = false, .kinematics = false, .errors = errors, .go_on = false}; }
  Configuration found_in(int lane, const Configuration& like) const {
    return lane_model.configuration_of(memory.state(lane).data(), like);
  }
};

/// Where loads are tried, and how the machine stands there without one.
struct Place {
  Vector3 p;
  Configuration unloaded;
};

// From the zone's nominal configuration to a place, and from nothing to the errors there.
bool follow_to(Judge& judge, const Load& load, Place& place) {
  const Matrix3 R_MT = tip(judge.model.mechanism, judge.model.home).R;
  const NominalResult nominal = follow(judge.model, judge.zone.nominal(), {R_MT, place.p});
  if (nominal.status != Status::converged) return false;
  Equilibrium found = solve_forward(judge.model, nominal.configuration, load, judge.stage(), judge.work);
  place.unloaded = std::move(found.configuration);
  return found.status == Status::converged;
}

// The corners of the cube, in lanes; where these do not find an equilibrium, it is followed. Last the centre, always followed.
// Fewer than nine places where one is not found.
std::vector<Place> places_of(Judge& judge) {
  static_assert(lanes::width == 8);
  const LaneZone& zone = judge.zone;
  std::vector<Place> list;
  for (int lane = 0; lane < lanes::width; ++lane) {
    list.push_back({zone.corner(lane), {}});
    put_in_lane(list.back().p, Vector6::Zero(), lane, judge.memory.batch);
  }
  judge.memory.solve(zone.flat(), judge.question());
  for (int lane = 0; lane < lanes::width; ++lane) {
    Place& place = list[static_cast<std::size_t>(lane)];
    if (judge.memory.batch.converged[lane])
      place.unloaded = judge.found_in(lane, zone.reference());
    else if (!follow_to(judge, {}, place))
      return {};
  }
  list.push_back({zone.centre(), {}});
  return follow_to(judge, {}, list.back()) ? list : std::vector<Place>{};
}

// Whether what a lane has found is stable. At the centre the condition is judged too.
bool stands(Judge& judge, int lane, const Place& place, const Load& load) {
  if (!judge.memory.batch.converged[lane]) {
    Place alone{place.p, {}};
    return follow_to(judge, load, alone);
  }
  const Configuration loaded = judge.found_in(lane, place.unloaded);
  if (place.p == judge.zone.centre())
    return refine_forward(judge.model, loaded, load, judge.stage(), judge.work).status == Status::converged;
  const Problem problem{load, judge.stage(), nullptr};
  evaluate_all(judge.model, loaded, problem.stage, judge.work.impl());
  return is_stable(judge.model, loaded, problem, judge.work.impl());
}

// One load a lane, with the tangents of the place.
bool bears_at(Judge& judge, const Place& place, const std::vector<Load>& loads) {
  LaneTangents tangents;
  if (!tangents.take(judge.model, judge.lane_model, place.unloaded, judge.zone.actuators_by_position(place.p), judge.work))
    return false;
  lanes::Region region = judge.zone.flat();
  tangents.enter(region, place.p);
  for (std::size_t first = 0; first < loads.size(); first += lanes::width) {
    const std::size_t count = std::min<std::size_t>(lanes::width, loads.size() - first);
    for (int lane = 0; lane < lanes::width; ++lane)
      put_in_lane(place.p, loads[first + std::min(static_cast<std::size_t>(lane), count - 1)].F, lane, judge.memory.batch);
    judge.memory.solve(region, judge.question());
    for (std::size_t i = 0; i < count; ++i)
      if (!stands(judge, static_cast<int>(i), place, loads[first + i])) return false;
  }
  return true;
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
                      bool errors, StaticsWork& work) {
  Judge judge{model, lane_model, zone, errors, work};
  const std::vector<Place> places = places_of(judge);
  return !places.empty() &&
         std::all_of(places.rbegin(), places.rend(), [&](const Place& place) { return bears_at(judge, place, loads); });
}

}  // namespace counterflex
