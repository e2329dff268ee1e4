#include "forward_sources.hpp"

#include <vector>

namespace counterflex {
namespace {

// One question to many waypoints.
class SourceBatch {
 public:
  SourceBatch(WaypointSolver& solver, const ForwardBatch& batch) : solver_(solver), batch_(batch) {
    waypoints_.reserve(batch.waypoints.size());
    requests_.reserve(batch.waypoints.size());
  }

  void ask(std::size_t i, const ActualRequest& request) {
    waypoints_.push_back(i);
    requests_.push_back(request);
  }

  template <class Take>  // void(std::size_t waypoint, const ActualSolution&)
  void answer(const Take& take) {
    actuals_.resize(requests_.size());
    solver_.actuals(requests_, actuals_);
    for (std::size_t k = 0; k < actuals_.size(); ++k) take(waypoints_[k], actuals_[k]);
    waypoints_.clear();
    requests_.clear();
  }

  // The deviation under `stage` of a command at the end of every piece, and at places inside.
  template <class Result>  // Vector6&(Waypoint&)
  void deviations(Vector3 ForwardPlace::*command, bool loaded, const Stage& stage, Start start,
                  const Result& result) {
    for (std::size_t i = 0; i < batch_.waypoints.size(); ++i) {
      const ForwardPlace& place = batch_.places[i];
      if (!knows_before(batch_.waypoints[i])) continue;
      ask(i, {place.*command, loaded ? place.load : Load{}, stage, start});
    }
    answer([&](std::size_t i, const ActualSolution& actual) {
      take(i, actual, reference(batch_.places[i], stage), result);
    });
  }

 private:
  // The perfect machine is compared with the command: the shift of a datum is a deviation of the real one.
  static Pose reference(const ForwardPlace& place, const Stage& stage) {
    return stage.errors == 0 ? Pose{place.wanted.R, place.original} : place.wanted;
  }

  template <class Result>
  void take(std::size_t i, const ActualSolution& actual, const Pose& reference, const Result& result) {
    Waypoint& w = batch_.waypoints[i];
    w.iterations += actual.iterations;
    if (actual.status == Status::converged)
      result(w) = deviation(actual.X_MT, reference);
    else if (w.status == Status::converged)
      w.status = actual.status;
  }

  WaypointSolver& solver_;
  const ForwardBatch& batch_;
  std::vector<std::size_t> waypoints_;
  std::vector<ActualRequest> requests_;
  std::vector<ActualSolution> actuals_;
};

// The emitted target under another force, where one acts.
class OtherForces {
 public:
  OtherForces(WaypointSolver& solver, const ForwardBatch& batch) : questions_(solver, batch), batch_(batch) {}

  template <class Wanted>  // bool(const Waypoint&)
  void solve(double factor, OtherForce Causes::*result, const Wanted& wanted) {
    for (std::size_t i = 0; i < batch_.waypoints.size(); ++i) {
      Waypoint& w = batch_.waypoints[i];
      if (!wanted(w)) continue;
      if (batch_.places[i].load.F.isZero(0))
        (*w.causes).*result = {w.after, Status::converged};
      else
        questions_.ask(i, request(i, factor, Start::neighbour));
    }
    std::vector<std::size_t> far;
    questions_.answer([&](std::size_t i, const ActualSolution& actual) {
      take(i, actual, result);
      if (is_far(i, actual)) far.push_back(i);
    });
    for (const std::size_t i : far) questions_.ask(i, request(i, factor, Start::nominal));
    questions_.answer([&](std::size_t i, const ActualSolution& actual) { take(i, actual, result); });
  }

 private:
  ActualRequest request(std::size_t i, double factor, Start start) const {
    const ForwardPlace& place = batch_.places[i];
    return {place.emitted, {factor * place.load.F, place.load.at_platform}, {}, start};
  }

  // A warm start may snap to where no growing force leads: the continuation decides.
  bool is_far(std::size_t i, const ActualSolution& actual) const {
    const ForwardPlace& place = batch_.places[i];
    const auto size = [this](const Vector3& d) { return d.cwiseProduct(batch_.judged).norm(); };
    return actual.status != Status::converged ||
           size(actual.X_MT.p - place.actual.p) > size(place.actual.p - place.emitted);
  }

  void take(std::size_t i, const ActualSolution& actual, OtherForce Causes::*result) {
    OtherForce& other = (*batch_.waypoints[i].causes).*result;
    other = {Vector6::Zero(), actual.status};
    if (actual.status == Status::converged) other.deviation = deviation(actual.X_MT, batch_.places[i].wanted);
  }

  SourceBatch questions_;
  const ForwardBatch& batch_;
};

}  // namespace

void add_before(WaypointSolver& solver, const ForwardBatch& batch) {
  SourceBatch(solver, batch)
      .deviations(&ForwardPlace::original, true, {}, Start::neighbour,
                  [](Waypoint& w) -> Vector6& { return w.before; });
}

void add_sources(WaypointSolver& solver, const ForwardBatch& batch) {
  SourceBatch questions(solver, batch);
  const auto ask = [&](Vector3 ForwardPlace::*command, bool loaded, const Stage& stage,
                       Vector6 Causes::*result) {
    questions.deviations(command, loaded, stage, Start::nominal,
                         [result](Waypoint& w) -> Vector6& { return (*w.causes).*result; });
  };
  ask(&ForwardPlace::original, false, {.load = 0, .gravity = 0}, &Causes::geometry);
  ask(&ForwardPlace::original, true, {.errors = 0, .gravity = 0}, &Causes::load);
  ask(&ForwardPlace::emitted, false, {.load = 0}, &Causes::air);
  const Stage unloaded_perfect{.errors = 0, .load = 0, .gravity = 0};
  ask(&ForwardPlace::original, false, unloaded_perfect, &Causes::superposition);
  const bool weighs = has_weight(solver.model().mechanism);
  if (weighs) ask(&ForwardPlace::original, false, {.errors = 0, .load = 0}, &Causes::gravity);
  for (Waypoint& w : batch.waypoints) {
    if (!knows_before(w)) continue;
    Causes& c = *w.causes;
    const Vector6 preloads = c.superposition;  // act in each of the others, too
    c.geometry -= preloads;
    c.load -= preloads;
    if (weighs) c.gravity -= preloads;
    c.superposition = preloads + c.geometry + c.load + c.gravity;
  }
}

// Between ends, where only the largest deviation counts, the lower force is taken to do the opposite of the
// higher one: half of the time for what differs in second order.
void add_other_forces(WaypointSolver& solver, const ForwardBatch& batch) {
  for (Waypoint& w : batch.waypoints) w.causes.emplace();
  OtherForces forces(solver, batch);
  forces.solve(1 + force_change, &Causes::higher, [](const Waypoint&) { return true; });
  const auto mirrors = [](const Waypoint& w) {
    return w.between && w.causes->higher.status == Status::converged;
  };
  for (Waypoint& w : batch.waypoints)
    if (mirrors(w)) w.causes->lower.deviation = 2 * w.after - w.causes->higher.deviation;
  forces.solve(1 - force_change, &Causes::lower, [&](const Waypoint& w) { return !mirrors(w); });
}

}  // namespace counterflex
