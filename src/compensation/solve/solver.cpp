#include "compensation/solve/solver.hpp"

#include <algorithm>
#include <limits>

#include "counterflex/statics/fixture.hpp"
#include "counterflex/statics/theory.hpp"

namespace counterflex {
namespace {

constexpr int most_outer_iterations = 60;
constexpr double outer_tolerance = 1e-11;  // m
constexpr double same_branch =
    1e-6;  // of the machine's length: two configurations of one place differ by rounding

bool controls_only_positions(const Mechanism& mechanism) {
  return std::all_of(mechanism.controlled.begin(), mechanism.controlled.end(),
                     [](Component c) { return c <= Component::z; });
}

Status travel_status(const Mechanism& mechanism, const Eigen::VectorXd& rho) {
  return within_travel(mechanism, rho) ? Status::converged : Status::outside_travel;
}

// The nominal configuration of the joints, which lag behind the commanded values.
NominalResult behind(const Model& model, const NominalResult& commanded, const Directions& directions,
                     double errors = 1) {
  const Eigen::VectorXd lag = errors * lag_of(model.mechanism, directions);
  if (lag.isZero(0)) return commanded;
  return nominal_forward(model, commanded.configuration,
                         actuator_values(model.mechanism, commanded.configuration) + lag);
}

// Whether the kernel answers two requests in one call.
bool go_together(const TipPosition& a, const TipPosition& b) {
  return a.model == b.model;
}

bool go_together(const TargetRequest& a, const TargetRequest& b) {
  return a.model == b.model && a.R_MT.has_value() == b.R_MT.has_value();
}

bool go_together(const ForwardRequest& a, const ForwardRequest& b) {
  return a.model == b.model && a.stage == b.stage && (a.rho == nullptr) == (b.rho == nullptr);
}

// How many of the first requests go together.
template <typename Request>
std::size_t length_of_run(std::span<const Request> requests) {
  const auto differs = [&](const Request& r) { return !go_together(r, requests.front()); };
  return static_cast<std::size_t>(std::find_if(requests.begin(), requests.end(), differs) - requests.begin());
}

}  // namespace

struct PlaceSolver::OfModel {
  const Model& model;
  Matrix3 R_home;
  bool only_positions;
  std::optional<StaticsWork> work{};  // of single solves
  std::optional<BatchSolver> batch{};

  explicit OfModel(const Model& of)
      : model(of),
        R_home(tip(of.mechanism, of.home).R),
        only_positions(controls_only_positions(of.mechanism)) {}

  /// The pose at a position: home's orientation where the program gives none.
  Pose pose(const Vector3& p, const std::optional<Matrix3>& R) const { return {R ? *R : R_home, p}; }

  TurnedPlace place(const Vector3& p, const std::optional<Matrix3>& R) const {
    return {p, R ? rotation_between(*R, R_home) : Vector3::Zero()};
  }

  StaticsWork& scratch() {
    if (!work) work.emplace(model.mechanism);
    return *work;
  }
};

PlaceSolver::PlaceSolver(const StartTables* starts, bool at_platform, Method method)
    : starts_(starts), at_platform_(at_platform), method_(method) {}

PlaceSolver::~PlaceSolver() = default;

PlaceSolver::OfModel& PlaceSolver::of(const Model& model) {
  std::unique_ptr<OfModel>& found = models_[&model];
  if (found) return *found;
  found = std::make_unique<OfModel>(model);
  if (starts_ != nullptr) found->batch.emplace(starts_->of(model, at_platform_));
  return *found;
}

void PlaceSolver::wanted(std::span<const TipPosition> requests, std::span<WantedPose> answers, StopAt stop) {
  for (std::size_t count = 0; !requests.empty();
       requests = requests.subspan(count), answers = answers.subspan(count)) {
    count = length_of_run(requests);
    OfModel& m = of(*requests.front().model);
    nominals_.assign(count, {});
    places_.clear();
    for (const TipPosition& request : requests.first(count))
      places_.push_back(m.place(request.p_MT, request.R_MT));
    if (m.batch) m.batch->nominal_tips(places_, nominals_);
    for (std::size_t i = 0; i < count; ++i) {
      answers[i] = nominals_[i].solved ? WantedPose{Status::converged, nominals_[i].X_MT}
                                       : wanted_alone(m, requests[i]);
      if (requests[i].R_MT) answers[i].X_MT = {*requests[i].R_MT, requests[i].p_MT};
      if (answers[i].status != Status::converged && stop == StopAt::first_failure) return;
    }
  }
}

Pose PlaceSolver::part(const Model& model, const Vector6& F, const Pose& X_MT) {
  const Mechanism& mechanism = model.mechanism;
  if (!mechanism.fixture) return {};
  return deflected_part(*mechanism.fixture, wrench_at_tip(mechanism, F, at_platform_, X_MT), X_MT.p);
}

void PlaceSolver::targets(std::span<const TargetRequest> requests, std::span<TargetAnswer> answers,
                          StopAt stop) {
  if (requests.empty() || !requests.front().model->mechanism.fixture)
    return machine_targets(requests, answers, stop);
  // The tip has to be where the loaded part has the wanted place.
  moved_.assign(requests.begin(), requests.end());
  for (TargetRequest& request : moved_) {
    const Pose wanted = of(*request.model).pose(request.p_MT, request.R_MT),
               moved = part(*request.model, request.F, wanted) * wanted;
    request.p_MT = moved.p;
    if (request.R_MT) request.R_MT = moved.R;
  }
  machine_targets(moved_, answers, stop);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    TargetAnswer& answer = answers[i];
    for (int c = 0; c < 3; ++c)
      if (!controls(requests[i].model->mechanism, Component{c})) answer.target[c] = requests[i].p_MT[c];
    if (requests[i].R_MT)
      answer.turn = rotation_between(exp_so3(answer.turn) * *moved_[i].R_MT, *requests[i].R_MT);
  }
}

void PlaceSolver::forwards(std::span<const ForwardRequest> requests, std::span<ForwardAnswer> answers,
                           StopAt stop) {
  machine_forwards(requests, answers, stop);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const ForwardRequest& request = requests[i];
    if (!request.model->mechanism.fixture || answers[i].status != Status::converged) continue;
    const Pose X_MT = answers[i].X_MT;
    // The cut is at the tip's place on the unloaded part: the second pass has it to rounding.
    const Matrix3 R = of(*request.model).pose(request.target, request.R).R;
    for (int pass = 0; pass < 3; ++pass)
      answers[i].X_MT =
          inverse(part(*request.model, request.stage.load * request.F, {R, answers[i].X_MT.p})) * X_MT;
  }
}

void PlaceSolver::machine_targets(std::span<const TargetRequest> requests, std::span<TargetAnswer> answers,
                                  StopAt stop) {
  for (std::size_t count = 0; !requests.empty();
       requests = requests.subspan(count), answers = answers.subspan(count)) {
    count = length_of_run(requests);
    OfModel& m = of(*requests.front().model);
    answers_.assign(count, {});
    if (m.batch && method_ == Method::direct) {
      requests_.clear();
      for (const TargetRequest& request : requests.first(count))
        requests_.push_back({m.place(request.p_MT, request.R_MT), request.F, request.directions});
      const bool wants_pose = requests.front().R_MT.has_value();
      m.batch->solve(wants_pose ? BatchQuestion::pose : BatchQuestion::target, {}, requests_, answers_);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const BatchAnswer& answer = answers_[i];
      answers[i] = answer.solved ? TargetAnswer{Status::converged, answer.command.p, answer.iterations}
                                 : target_alone(m, requests[i]);
      if (answer.solved && requests[i].R_MT)
        answers[i].turn = rotation_between(answer.command.R, *requests[i].R_MT);
      if (answers[i].status != Status::converged && stop == StopAt::first_failure) return;
    }
  }
}

void PlaceSolver::machine_forwards(std::span<const ForwardRequest> requests, std::span<ForwardAnswer> answers,
                                   StopAt stop) {
  for (std::size_t count = 0; !requests.empty();
       requests = requests.subspan(count), answers = answers.subspan(count)) {
    count = length_of_run(requests);
    OfModel& m = of(*requests.front().model);
    const Stage& stage = requests.front().stage;
    answers_.assign(count, {});
    if (m.batch) {
      requests_.clear();
      for (const ForwardRequest& request : requests.first(count))
        requests_.push_back(
            {m.place(request.target, request.R), stage.load * request.F, request.directions, request.rho});
      m.batch->solve(BatchQuestion::forward, stage, requests_, answers_);
    }
    for (std::size_t i = 0; i < count; ++i) {
      BatchAnswer& answer = answers_[i];
      if (answer.solved)
        answers[i] = {Status::converged, answer.X_MT, answer.iterations, std::move(answer.rho)};
      else
        answers[i] = forward_alone(m, requests[i]);
      if (answers[i].status != Status::converged && stop == StopAt::first_failure) return;
    }
  }
}

WantedPose PlaceSolver::wanted(const TipPosition& at) {
  WantedPose answer;
  wanted({&at, 1}, {&answer, 1});
  return answer;
}

ForwardAnswer PlaceSolver::forward(const ForwardRequest& request) {
  ForwardAnswer answer;
  forwards({&request, 1}, {&answer, 1});
  return answer;
}

Equilibrium PlaceSolver::equilibrium(const ForwardRequest& request) {
  const ForwardAnswer answer = forward(request);
  return answer.status == Status::converged ? equilibrium(request, answer) : Equilibrium{};
}

Equilibrium PlaceSolver::equilibrium(const ForwardRequest& request, const ForwardAnswer& answer) {
  const Model& model = *request.model;
  const TipPosition at{request.model, request.target, request.R};
  NominalResult commanded = std::move(nominals({&at, 1}).front());
  if (commanded.status == Status::converged) commanded = behind(model, commanded, request.directions);
  if (commanded.status != Status::converged) return {};
  const Load load{request.F, at_platform_};
  StaticsWork& work = of(model).scratch();
  Equilibrium found = equilibrium_at(model, commanded.configuration, load, request.stage, answer.X_MT, work);
  if (found.status != Status::converged)
    found = solve_forward(model, commanded.configuration, load, request.stage, work);
  return found;
}

std::vector<NominalResult> PlaceSolver::nominals(std::span<const TipPosition> positions) {
  std::vector<NominalResult> all(positions.size());
  for (std::size_t begin = 0, count = 0; begin < positions.size(); begin += count) {
    const std::span<const TipPosition> run = positions.subspan(begin);
    count = length_of_run(run);
    OfModel& m = of(*run.front().model);
    places_.clear();
    for (const TipPosition& at : run.first(count)) places_.push_back(m.place(at.p_MT, at.R_MT));
    const std::span<NominalResult> answers = std::span(all).subspan(begin, count);
    if (m.batch) m.batch->nominals(places_, answers);
    for (std::size_t i = 0; i < count; ++i)
      if (answers[i].status != Status::converged) answers[i] = nominal(run[i]);
  }
  return all;
}

NominalResult PlaceSolver::nominal(const TipPosition& at) {
  OfModel& m = of(*at.model);
  const Configuration* near = m.batch ? m.batch->nominal_near(m.place(at.p_MT, at.R_MT)) : nullptr;
  return follow(m.model, near != nullptr ? *near : m.model.home, m.pose(at.p_MT, at.R_MT));
}

Status PlaceSolver::join(const TipPosition& from, const TipPosition& to) {
  const Model& model = *from.model;
  OfModel& m = of(model);
  if (m.batch && m.batch->joins(m.place(from.p_MT, from.R_MT), m.place(to.p_MT, to.R_MT)))
    return Status::converged;
  const NominalResult begin = nominal(from);
  if (begin.status != Status::converged) return begin.status;
  const NominalResult followed = follow(model, begin.configuration, m.pose(to.p_MT, to.R_MT));
  if (followed.status != Status::converged) return followed.status;
  const NominalResult end = nominal(to);
  if (end.status != Status::converged) return end.status;
  const auto rho = [&](const NominalResult& r) { return actuator_values(model.mechanism, r.configuration); };
  const bool same =
      actuator_distance(model.mechanism, rho(followed), rho(end)) < same_branch * model.mechanism.length;
  return same ? Status::converged : Status::singular;
}

LineBend PlaceSolver::bend_along(const Model& model, const BatchLine& line) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  OfModel& m = of(model);
  // The bounds are those of the machine alone.
  return m.batch && !model.mechanism.fixture ? m.batch->bend_along(line) : LineBend{unknown, unknown};
}

WantedPose PlaceSolver::wanted_alone(OfModel& m, const TipPosition& at) {
  const NominalResult alone = nominal(at);
  if (alone.status != Status::converged) return {alone.status, m.pose(at.p_MT, at.R_MT)};
  return {alone.status, tip(m.model.mechanism, alone.configuration)};
}

ForwardAnswer PlaceSolver::forward_alone(OfModel& m, const ForwardRequest& request) {
  const NominalResult commanded = nominal({&m.model, request.target, request.R});
  if (commanded.status != Status::converged) return {commanded.status};
  const Mechanism& mechanism = m.model.mechanism;
  const NominalResult lagging = behind(m.model, commanded, request.directions, request.stage.errors);
  if (lagging.status != Status::converged) return {lagging.status};
  const Equilibrium solved =
      solve_forward(m.model, lagging.configuration, {request.F, at_platform_}, request.stage, m.scratch());
  ForwardAnswer answer{solved.status, tip(mechanism, solved.configuration), solved.iterations,
                       actuator_values(mechanism, commanded.configuration)};
  if (request.within_travel && answer.status == Status::converged)
    answer.status = travel_status(mechanism, answer.rho);
  return answer;
}

TargetAnswer PlaceSolver::target_alone(OfModel& m, const TargetRequest& request) {
  const Vector3& p_MT = request.p_MT;
  if (method_ == Method::linear) return by_linear_theory(m, request);
  if (!m.only_positions && !request.R_MT) return by_outer_iteration(m, request);
  const NominalResult start = nominal({&m.model, p_MT, request.R_MT});
  if (start.status != Status::converged) return {start.status, p_MT};
  const Mechanism& mechanism = m.model.mechanism;
  const Pose X_MT{request.R_MT.value_or(tip(mechanism, start.configuration).R), p_MT};
  const Load load{request.F, at_platform_};
  const Equilibrium solved =
      method_ == Method::nested
          ? solve_target_nested(m.model, start.configuration, X_MT, load, {}, m.scratch())
          : solve_target(m.model, start.configuration, X_MT, load, {}, m.scratch());
  TargetAnswer answer{solved.status, p_MT, solved.iterations};
  if (solved.status != Status::converged) return answer;
  Eigen::VectorXd rho = actuator_values(mechanism, solved.configuration);
  if (!mechanism.reversal.empty()) rho -= lag_of(mechanism, request.directions);
  const NominalResult commanded = nominal_forward(m.model, start.configuration, rho);
  answer.status = commanded.status;
  const Pose target = tip(mechanism, commanded.configuration);
  for (int c = 0; c < 3; ++c)
    if (controls(mechanism, Component{c}))
      answer.target[c] = target.p[c];  // the other components are not written
  if (request.R_MT) answer.turn = rotation_between(target.R, *request.R_MT);
  if (answer.status == Status::converged) answer.status = travel_status(mechanism, rho);
  return answer;
}

// Where the machine controls an orientation that the program does not state, only positions can be written:
// (23) on them.
TargetAnswer PlaceSolver::by_outer_iteration(OfModel& m, const TargetRequest& request) {
  TargetAnswer answer{Status::not_converged, request.p_MT};
  for (int i = 0; i < most_outer_iterations; ++i) {
    const ForwardAnswer reached = forward_alone(
        m, {.model = &m.model, .target = answer.target, .F = request.F, .directions = request.directions});
    answer.status = reached.status;
    answer.iterations += reached.iterations;
    if (reached.status != Status::converged) return answer;
    const Vector3 miss = reached.X_MT.p - request.p_MT;
    answer.status = travel_status(m.model.mechanism, reached.rho);
    if (miss.norm() < outer_tolerance) return answer;
    answer.target -= miss;
  }
  answer.status = Status::not_converged;
  return answer;
}

TargetAnswer PlaceSolver::by_linear_theory(OfModel& m, const TargetRequest& request) {
  const NominalResult start = nominal({&m.model, request.p_MT, request.R_MT});
  if (start.status != Status::converged) return {start.status, request.p_MT};
  const NominalResult lagging = behind(m.model, start, request.directions);
  if (lagging.status != Status::converged) return {lagging.status, request.p_MT};
  LinearResult linear =
      linear_deviation(m.model, lagging.configuration, {request.F, at_platform_}, {}, m.scratch());
  linear.dt_T +=
      difference(tip(m.model.mechanism, lagging.configuration), tip(m.model.mechanism, start.configuration));
  if (linear.status != Status::converged) return {linear.status, request.p_MT, 1};
  const Pose X_MT{request.R_MT.value_or(tip(m.model.mechanism, start.configuration).R), request.p_MT};
  const Pose target = linear_target(m.model, X_MT, linear);
  TargetAnswer answer{Status::converged, target.p, 1};
  std::optional<Matrix3> R;
  if (request.R_MT) R = target.R, answer.turn = rotation_between(target.R, X_MT.R);
  const NominalResult commanded = nominal({&m.model, answer.target, R});
  answer.status =
      commanded.status == Status::converged
          ? travel_status(m.model.mechanism, actuator_values(m.model.mechanism, commanded.configuration))
          : commanded.status;
  return answer;
}

}  // namespace counterflex
