#include "compensation/solve/branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/plan/places.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/failures.hpp"
#include "compensation/solve/solver.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/arm_margins.hpp"

namespace counterflex {
namespace {

// An arm that is so near to another configuration that a corrected target might be reached in it.
std::optional<Failure> configuration_failure(const Model& model, const Configuration& nominal, int line) {
  const auto margin = arm_margin(model, nominal);
  if (!margin || margin->angle >= least_arm_margin) return std::nullopt;
  return Failure{ErrorKind::not_compensated, line,
                 fmt::format("the arm is {:.2f} deg from another configuration ({}); at least {:.0f} deg is "
                             "needed: turn the tool about its axis, or move the part",
                             margin->angle / deg, margin->what, least_arm_margin / deg)};
}

// Why an arm does not reach a place on the branch of home, if another configuration is on the way.
std::optional<Failure> failure_on_the_way(PlaceSolver& solver, const TipPosition& to, Status status,
                                          int line) {
  const Model& model = *to.model;
  const Pose home = tip(model.mechanism, model.home);
  const Vector3 turn = rotation_between(*to.R_MT, home.R);
  Configuration last = model.home;
  double reached = 0, beyond = 1;
  for (int halvings = 0; halvings < 20; ++halvings) {
    const double u = (reached + beyond) / 2;
    const NominalResult there =
        solver.nominal({&model, home.p + u * (to.p_MT - home.p), Matrix3(exp_so3(u * turn) * home.R)});
    const bool is_reached = there.status == Status::converged;
    if (is_reached) last = there.configuration;
    (is_reached ? reached : beyond) = u;
  }
  const auto margin = arm_margin(model, last);
  if (!margin || margin->angle >= least_arm_margin) return std::nullopt;
  return Failure{ErrorKind::not_compensated, line,
                 fmt::format("the machine's equilibrium is not solved here: {}; on the way from home the arm "
                             "comes within {:.2f} deg of another configuration ({}): turn the tool about its "
                             "axis, or move the part",
                             to_string(status), margin->angle / deg, margin->what),
                 0, status};
}

void add_to(ActuatorWay& way, const Mechanism& mechanism, const Eigen::VectorXd& values, int line) {
  if (way.first.size() != values.size()) {
    way = {values, values, {}, {}};
    way.least.resize(mechanism.travel.size(), {HUGE_VAL, line});
    way.most.resize(mechanism.travel.size(), {-HUGE_VAL, line});
  }
  way.last = values + full_turns(mechanism, values, way.last);
  const Eigen::VectorXd shown = shown_values(mechanism.shown, way.last);
  for (std::size_t i = 0; i < way.least.size(); ++i) {
    const double value = shown[i];
    if (value < way.least[i].value) way.least[i] = {value, line};
    if (value > way.most[i].value) way.most[i] = {value, line};
  }
}

// What a target states of a rotary axis whose control shows `angle` (rad), as a number.
int stated(StatedTurns turns, double angle) {
  constexpr double exact = 1e-9;
  switch (turns) {
    case StatedTurns::signs:
      return angle < -exact ? 1 : 0;
    case StatedTurns::quadrants:
      return static_cast<int>(std::floor((angle + exact) / (pi / 2)));
    case StatedTurns::half_turns:
      return static_cast<int>(std::floor((angle + pi + exact) / (2 * pi)));
    case StatedTurns::none:
      break;
  }
  return 0;
}

const char* stated_words(StatedTurns turns) {
  switch (turns) {
    case StatedTurns::signs:
      return "zero, but T of the target states its sign";
    case StatedTurns::quadrants:
      return "a multiple of 90 deg, but confdata of the target states its quadrant";
    default:
      return "180 deg, but the configuration of the target states its turn";
  }
}

// Whether a target states something of the rotary axis `ordinal` of an arm, from 1: T of all, the others of
// axes 1, 4 and 6.
bool is_stated(StatedTurns turns, int ordinal) {
  return turns == StatedTurns::signs || ordinal == 1 || ordinal == 4 || ordinal == 6;
}

}  // namespace

std::optional<Failure> follow_branch(const Job& job, ActuatorWay& way) {
  PlaceSolver solver(job);
  std::optional<TipPosition> at = job.from;
  for (const Segment& segment : job.path.segments) {
    const Model& model = model_of(job, segment);
    // Straight from place to place: around an arc and a turn in steps of 22.5 degrees.
    const int parts = 1 + static_cast<int>(angle_along(segment) / angle_between_places);
    for (int k = 0; k <= parts; ++k) {
      const double u = static_cast<double>(k) / parts;
      const TipPosition next{&model, point_at(segment.wanted, u), orientation_at(segment, u)};
      const bool joins = at && at->model == &model;
      if (joins && at->p_MT == next.p_MT && at->R_MT == next.R_MT && !(next.R_MT && way.first.size() == 0))
        continue;
      std::optional<Failure> failure;
      Status status = joins ? solver.join(*at, next) : Status::converged;
      at = next;
      if (status == Status::converged && (next.R_MT || !joins)) {
        const NominalResult there = solver.nominal(next);
        status = there.status;
        if (status == Status::converged && next.R_MT) {
          add_to(way, model.mechanism, actuator_values(model.mechanism, there.configuration), segment.line);
          failure = configuration_failure(model, there.configuration, segment.line);
        }
      }
      if ((status == Status::singular || status == Status::unreachable) && next.R_MT)
        failure = failure_on_the_way(solver, next, status, segment.line);
      if (status != Status::converged && !failure) failure = status_failure(job, status, segment, next.p_MT);
      if (failure) return failure;
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> axis_beyond_stated_turn(StatedTurns turns, const Mechanism& mechanism,
                                                   const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                                   double room) {
  int ordinal = 0;
  for (std::size_t i = 0; i < mechanism.travel.size(); ++i) {
    if (mechanism.travel[i].kind != JointKind::revolute || !is_stated(turns, ++ordinal)) continue;
    const double begin = std::remainder(from[i], 2 * pi), end = begin + to[i] - from[i];
    for (const double side : {-room, room})
      if (stated(turns, end + side) != stated(turns, begin)) return i;
  }
  return std::nullopt;
}

std::optional<Failure> stated_turns_failure(const Job& job, const std::vector<Piece>& pieces) {
  std::optional<PlaceSolver> solver;
  for (const Piece& piece : pieces) {
    if (piece.u1 != 1 || !piece.turn) continue;
    const Move& move = job.program.moves[piece.move];
    const StatedTurns turns = move.orientation ? move.orientation->stated_turns : StatedTurns::none;
    if (turns == StatedTurns::none) continue;
    const Model& model = model_of(job, piece.move);
    if (!solver) solver.emplace(job);
    const NominalResult wanted = solver->nominal(wanted_at(job, piece, 1, model));
    const NominalResult commanded =
        solver->nominal({&model, piece.commanded.end, orientation_at(*piece.turn, 1)});
    if (wanted.status != Status::converged || commanded.status != Status::converged) continue;
    const Mechanism& mechanism = model.mechanism;
    const Eigen::VectorXd first = actuator_values(mechanism, wanted.configuration),
                          last = actuator_values(mechanism, commanded.configuration),
                          from = shown_values(mechanism.shown, first),
                          to = shown_values(mechanism.shown, last + full_turns(mechanism, last, first));
    const auto axis = axis_beyond_stated_turn(turns, mechanism, from, to, 0);
    if (!axis) continue;
    const double begin = std::remainder(from[*axis], 2 * pi), end = begin + to[*axis] - from[*axis];
    return Failure{
        ErrorKind::not_compensated, piece.line,
        fmt::format("the correction would move {} from {:.4f} to {:.4f} deg, across {}: the control "
                    "would stop or turn it by 360 deg; move to this place by joint angles, or move "
                    "the part",
                    mechanism.travel[*axis].name, begin / deg, end / deg, stated_words(turns))};
  }
  return std::nullopt;
}

std::optional<Failure> turns_failure(const Job& job, const ActuatorWay& way, Eigen::VectorXd& last) {
  if (way.first.size() == 0) return std::nullopt;
  const Mechanism& mechanism = job.model.mechanism;
  if (last.size() != way.first.size()) last = way.first;
  const Eigen::VectorXd turns = full_turns(mechanism, way.first, last);
  last = way.last + turns;
  const Eigen::VectorXd more =
      shown_values(mechanism.shown, way.first + turns) - shown_values(mechanism.shown, way.first);
  for (std::size_t i = 0; i < mechanism.travel.size(); ++i) {
    const Travel& travel = mechanism.travel[i];
    for (ActuatorWay::Extreme extreme : {way.least[i], way.most[i]}) {
      extreme.value += more[i];
      if (extreme.value >= travel.min && extreme.value <= travel.max) continue;
      return Failure{ErrorKind::limit, extreme.line,
                     outside_travel_words(travel, extreme.value) + ", counted on over full turns from home",
                     0, Status::outside_travel};
    }
  }
  return std::nullopt;
}

}  // namespace counterflex
