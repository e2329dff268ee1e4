#include "compensation/solve/attribution.hpp"

#include <algorithm>
#include <utility>

namespace counterflex {
namespace {

// Waypoints, and what has been solved there.
struct Solved {
  PlaceSolver& solver;
  std::span<const ForwardPlace> places;
  std::span<Waypoint> waypoints;
};

// The perfect machine is compared with the command: the shift of a datum is a deviation of the real one.
Pose reference(const ForwardPlace& place, const Stage& stage) {
  return stage.errors == 0 ? Pose{place.wanted.R, place.original.target} : place.wanted;
}

// The deviation under `stage` of a command, where `before` is known.
template <typename Take,      // (std::size_t index, const Vector6& deviation, ForwardAnswer&&)
          typename Unsolved>  // (Waypoint&, Status)
void deviations(const Solved& at, ForwardRequest ForwardPlace::*command, const Stage& stage, const Take& take,
                const Unsolved& unsolved) {
  std::vector<std::size_t> asked;
  std::vector<ForwardRequest> requests;
  for (std::size_t i = 0; i < at.waypoints.size(); ++i) {
    if (!knows_before(at.waypoints[i])) continue;
    asked.push_back(i);
    requests.push_back(at.places[i].*command);
    requests.back().stage = stage;
  }
  std::vector<ForwardAnswer> answers(requests.size());
  at.solver.forwards(requests, answers);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    Waypoint& w = at.waypoints[asked[k]];
    w.iterations += answers[k].iterations;
    if (answers[k].status == Status::converged)
      take(asked[k], deviation(answers[k].X_MT, reference(at.places[asked[k]], stage)),
           std::move(answers[k]));
    else
      unsolved(w, answers[k].status);
  }
}

// Places come in runs with one machine.
bool any_machine(std::span<const ForwardPlace> places, bool (*is)(const Mechanism&)) {
  const Model* last = nullptr;
  for (const ForwardPlace& place : places)
    if (const Model* model = place.original.model;
        model != std::exchange(last, model) && is(model->mechanism))
      return true;
  return false;
}

// What the fixture's deflection alone is: of a rigid, perfect machine against the part.
void add_fixture(const Solved& at) {
  for (std::size_t i = 0; i < at.waypoints.size(); ++i) {
    const ForwardRequest& original = at.places[i].original;
    if (!knows_before(at.waypoints[i]) || !original.model->mechanism.fixture) continue;
    const Pose command{at.places[i].wanted.R, original.target};
    at.waypoints[i].causes->fixture =
        deviation(inverse(at.solver.part(*original.model, original.F, command)) * command, command);
  }
}

}  // namespace

void add_before(PlaceSolver& solver, std::span<ForwardPlace> places, std::span<Waypoint> waypoints) {
  deviations(
      {solver, places, waypoints}, &ForwardPlace::original, {},
      [&](std::size_t i, const Vector6& d, ForwardAnswer&& answer) {
        waypoints[i].before = d;
        places[i].rho = std::move(answer.rho);
        places[i].original.rho = &places[i].rho;
      },
      [](Waypoint& w, Status status) {
        if (w.status == Status::converged) w.status = status;
      });
}

void add_causes(PlaceSolver& solver, std::span<const ForwardPlace> places, std::span<Waypoint> waypoints) {
  for (Waypoint& w : waypoints)
    if (knows_before(w)) w.causes.emplace();
  const Solved at{solver, places, waypoints};
  // A machine with one cause alone may buckle where the real one does not: there no causes are known.
  std::vector<bool> unsolved(waypoints.size());
  const auto add = [&](ForwardRequest ForwardPlace::*command, const Stage& stage, Vector6 Causes::*result) {
    deviations(
        at, command, stage,
        [&](std::size_t i, const Vector6& d, ForwardAnswer&&) { (*waypoints[i].causes).*result = d; },
        [&](const Waypoint& w, Status) { unsolved[static_cast<std::size_t>(&w - waypoints.data())] = true; });
  };
  add(&ForwardPlace::original, {.load = 0, .gravity = 0}, &Causes::geometry);
  add(&ForwardPlace::original, {.errors = 0, .gravity = 0}, &Causes::load);
  add(&ForwardPlace::emitted, {.load = 0}, &Causes::air);
  if (any_machine(places, has_preload))
    add(&ForwardPlace::original, {.errors = 0, .load = 0, .gravity = 0}, &Causes::superposition);
  const bool weight = any_machine(places, has_weight);
  if (weight) add(&ForwardPlace::original, {.errors = 0, .load = 0}, &Causes::gravity);
  add_fixture(at);
  for (Waypoint& w : waypoints) {
    if (!knows_before(w)) continue;
    Causes& c = *w.causes;
    const Vector6 preloads = c.superposition;  // act in each of the others, too
    c.geometry -= preloads;
    c.load -= preloads + c.fixture;
    if (weight) c.gravity -= preloads;
    c.superposition = preloads + c.geometry + c.load + c.fixture + c.gravity;
  }
  for (std::size_t i = 0; i < waypoints.size(); ++i)
    if (unsolved[i]) waypoints[i].causes.reset();
}

}  // namespace counterflex
