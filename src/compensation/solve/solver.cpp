#include "compensation/solve/solver.hpp"

#include <algorithm>
#include <limits>

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

bool controls(const Mechanism& mechanism, int component) {
  return std::count(mechanism.controlled.begin(), mechanism.controlled.end(), Component{component}) > 0;
}

Status travel_status(const Mechanism& mechanism, const Eigen::VectorXd& rho) {
  return within_travel(mechanism, rho) ? Status::converged : Status::outside_travel;
}

// The first requests that have the same model and stage.
template <typename Request>
std::size_t length_of_run(std::span<const Request> requests) {
  const auto differs = [&](const Request& r) {
    if constexpr (requires { r.stage; })
      if (!(r.stage == requests.front().stage)) return true;
    return r.model != requests.front().model;
  };
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
    positions_.clear();
    for (const TipPosition& request : requests.first(count)) positions_.push_back(request.p_MT);
    if (m.batch) m.batch->nominal_tips(positions_, nominals_);
    for (std::size_t i = 0; i < count; ++i) {
      answers[i] = nominals_[i].solved ? WantedPose{Status::converged, nominals_[i].X_MT}
                                       : wanted_alone(m, positions_[i]);
      if (answers[i].status != Status::converged && stop == StopAt::first_failure) return;
    }
  }
}

void PlaceSolver::targets(std::span<const TargetRequest> requests, std::span<TargetAnswer> answers,
                          StopAt stop) {
  for (std::size_t count = 0; !requests.empty();
       requests = requests.subspan(count), answers = answers.subspan(count)) {
    count = length_of_run(requests);
    OfModel& m = of(*requests.front().model);
    answers_.assign(count, {});
    if (m.batch && method_ == Method::direct) {
      requests_.clear();
      for (const TargetRequest& request : requests.first(count))
        requests_.push_back({request.p_MT, request.F});
      m.batch->solve(BatchQuestion::target, {}, requests_, answers_);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const BatchAnswer& answer = answers_[i];
      answers[i] = answer.solved ? TargetAnswer{Status::converged, answer.command, answer.iterations}
                                 : target_alone(m, requests[i]);
      if (answers[i].status != Status::converged && stop == StopAt::first_failure) return;
    }
  }
}

void PlaceSolver::forwards(std::span<const ForwardRequest> requests, std::span<ForwardAnswer> answers,
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
        requests_.push_back({request.target, stage.load * request.F});
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

NominalResult PlaceSolver::nominal(const Model& model, const Vector3& p_MT) {
  return nominal(of(model), p_MT);
}

NominalResult PlaceSolver::nominal(OfModel& m, const Vector3& p_MT) {
  return follow(m.model, nominal_near(m, p_MT), {m.R_home, p_MT});
}

NominalResult PlaceSolver::nominal(const Model& model, const Vector3& p_MT, const Eigen::VectorXd& rho) {
  return nominal_forward(model, nominal_near(of(model), p_MT), rho);
}

const Configuration& PlaceSolver::nominal_near(OfModel& m, const Vector3& p_MT) {
  const Configuration* near = m.batch ? m.batch->nominal_near(p_MT) : nullptr;
  return near != nullptr ? *near : m.model.home;
}

Status PlaceSolver::join(const Model& model, const Vector3& from, const Vector3& to) {
  OfModel& m = of(model);
  if (m.batch && m.batch->joins(from, to)) return Status::converged;
  const NominalResult begin = nominal(m, from);
  if (begin.status != Status::converged) return begin.status;
  const NominalResult followed = follow(model, begin.configuration, {m.R_home, to});
  if (followed.status != Status::converged) return followed.status;
  const NominalResult end = nominal(m, to);
  if (end.status != Status::converged) return end.status;
  const auto rho = [&](const NominalResult& r) { return actuator_values(model.mechanism, r.configuration); };
  const bool same = (rho(followed) - rho(end)).norm() < same_branch * model.mechanism.length;
  return same ? Status::converged : Status::singular;
}

LineBend PlaceSolver::bend_along(const Model& model, const BatchLine& line) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  OfModel& m = of(model);
  return m.batch ? m.batch->bend_along(line) : LineBend{unknown, unknown};
}

WantedPose PlaceSolver::wanted_alone(OfModel& m, const Vector3& p_MT) {
  const NominalResult alone = nominal(m, p_MT);
  if (alone.status != Status::converged) return {alone.status, {m.R_home, p_MT}};
  return {alone.status, tip(m.model.mechanism, alone.configuration)};
}

ForwardAnswer PlaceSolver::forward_alone(OfModel& m, const ForwardRequest& request) {
  const NominalResult commanded = nominal(m, request.target);
  if (commanded.status != Status::converged) return {commanded.status};
  const Mechanism& mechanism = m.model.mechanism;
  const Equilibrium solved =
      solve_forward(m.model, commanded.configuration, {request.F, at_platform_}, request.stage, m.scratch());
  ForwardAnswer answer{solved.status, tip(mechanism, solved.configuration), solved.iterations,
                       actuator_values(mechanism, commanded.configuration)};
  if (request.within_travel && answer.status == Status::converged)
    answer.status = travel_status(mechanism, answer.rho);
  return answer;
}

TargetAnswer PlaceSolver::target_alone(OfModel& m, const TargetRequest& request) {
  const Vector3& p_MT = request.p_MT;
  if (method_ == Method::linear) return by_linear_theory(m, request);
  if (!m.only_positions) return by_outer_iteration(m, request);
  const NominalResult start = nominal(m, p_MT);
  if (start.status != Status::converged) return {start.status, p_MT};
  const Mechanism& mechanism = m.model.mechanism;
  const Pose X_MT{tip(mechanism, start.configuration).R, p_MT};
  const Load load{request.F, at_platform_};
  const Equilibrium solved =
      method_ == Method::nested
          ? solve_target_nested(m.model, start.configuration, X_MT, load, {}, m.scratch())
          : solve_target(m.model, start.configuration, X_MT, load, {}, m.scratch());
  TargetAnswer answer{solved.status, p_MT, solved.iterations};
  if (solved.status != Status::converged) return answer;
  const Eigen::VectorXd rho = actuator_values(mechanism, solved.configuration);
  const NominalResult commanded = nominal_forward(m.model, start.configuration, rho);
  answer.status = commanded.status;
  const Vector3 target = tip(mechanism, commanded.configuration).p;
  for (int c = 0; c < 3; ++c)
    if (controls(mechanism, c)) answer.target[c] = target[c];  // the other components are not written
  if (answer.status == Status::converged) answer.status = travel_status(mechanism, rho);
  return answer;
}

// Where the machine controls an orientation that the program does not state, only positions can be written:
// (23) on them.
TargetAnswer PlaceSolver::by_outer_iteration(OfModel& m, const TargetRequest& request) {
  TargetAnswer answer{Status::not_converged, request.p_MT};
  for (int i = 0; i < most_outer_iterations; ++i) {
    const ForwardAnswer reached = forward_alone(m, {&m.model, answer.target, request.F});
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
  const NominalResult start = nominal(m, request.p_MT);
  if (start.status != Status::converged) return {start.status, request.p_MT};
  const LinearResult linear =
      linear_deviation(m.model, start.configuration, {request.F, at_platform_}, {}, m.scratch());
  if (linear.status != Status::converged) return {linear.status, request.p_MT, 1};
  const Pose X_MT{tip(m.model.mechanism, start.configuration).R, request.p_MT};
  TargetAnswer answer{Status::converged, linear_target(m.model, X_MT, linear).p, 1};
  const NominalResult commanded = nominal(m, answer.target);
  answer.status =
      commanded.status == Status::converged
          ? travel_status(m.model.mechanism, actuator_values(m.model.mechanism, commanded.configuration))
          : commanded.status;
  return answer;
}

}  // namespace counterflex
