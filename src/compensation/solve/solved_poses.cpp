#include "counterflex/compensation/solved_poses.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "compensation/solve/solver.hpp"

namespace counterflex {
namespace {

constexpr std::size_t poses_at_once = 64;  // of one call of the kernel; of no effect on results

/// Which orientation of a request is commanded.
enum class Orientation { of_home, partly_of_request, of_request };

Orientation orientation_of(const Mechanism& mechanism) {
  const auto turned = std::count_if(mechanism.controlled.begin(), mechanism.controlled.end(),
                                    [](Component c) { return c > Component::z; });
  if (mechanism.controlled.empty() || turned == 3) return Orientation::of_request;
  return turned == 0 ? Orientation::of_home : Orientation::partly_of_request;
}

std::optional<Matrix3> commanded(Orientation orientation, const Matrix3& R) {
  return orientation == Orientation::of_home ? std::nullopt : std::optional(R);
}

/// The pose of the nominal tip: uncontrolled components are those of nominal kinematics.
Status nominal_pose(PlaceSolver& solver, Orientation orientation, const TipPosition& at, Pose& X_MT) {
  if (orientation == Orientation::partly_of_request) {
    const NominalResult nominal = solver.nominal(at);
    if (nominal.status == Status::converged) X_MT = tip(at.model->mechanism, nominal.configuration);
    return nominal.status;
  }
  const WantedPose wanted = solver.wanted(at);
  X_MT = wanted.X_MT;
  return wanted.status;
}

}  // namespace

std::vector<SolvedCommand> solve_commands(const Model& model, const StartTables& starts,
                                          std::span<const PoseRequest> requests, int threads) {
  const Orientation orientation = orientation_of(model.mechanism);
  std::vector<SolvedCommand> all(requests.size());
  const auto solve = [&](std::size_t begin, std::size_t count) {
    PlaceSolver solver(&starts, false);
    std::vector<ForwardRequest> asked;
    for (const PoseRequest& request : requests.subspan(begin, count))
      asked.push_back({.model = &model,
                       .target = request.X_MT.p,
                       .F = request.F,
                       .within_travel = true,
                       .R = commanded(orientation, request.X_MT.R)});
    std::vector<ForwardAnswer> answers(count);
    solver.forwards(asked, answers, StopAt::end);
    for (std::size_t i = 0; i < count; ++i) {
      SolvedCommand& solved = all[begin + i];
      solved = {answers[i].status, {}, answers[i].X_MT, std::move(answers[i].rho)};
      if (solved.status == Status::converged)
        solved.status =
            nominal_pose(solver, orientation, {&model, asked[i].target, asked[i].R}, solved.wanted);
    }
  };
  for_each_slice(requests.size(), threads, solve, poses_at_once);
  return all;
}

std::vector<SolvedTarget> solve_targets(const Model& model, const StartTables& starts,
                                        std::span<const PoseRequest> requests, int threads) {
  const Orientation orientation = orientation_of(model.mechanism);
  std::vector<SolvedTarget> all(requests.size());
  const auto solve = [&](std::size_t begin, std::size_t count) {
    PlaceSolver solver(&starts, false);
    std::vector<TargetRequest> asked;
    for (const PoseRequest& request : requests.subspan(begin, count))
      asked.push_back({&model, request.X_MT.p, request.F, commanded(orientation, request.X_MT.R)});
    std::vector<TargetAnswer> answers(count);
    solver.targets(asked, answers, StopAt::end);
    for (std::size_t i = 0; i < count; ++i) {
      SolvedTarget& solved = all[begin + i];
      solved.status = answers[i].status;
      if (solved.status != Status::converged) continue;
      TipPosition target{&model, answers[i].target};
      if (asked[i].R_MT) target.R_MT = Matrix3(exp_so3(answers[i].turn) * *asked[i].R_MT);
      const NominalResult nominal = solver.nominals({&target, 1}).front();
      solved.status = nominal.status;
      if (nominal.status != Status::converged) continue;
      solved.X_MT = tip(model.mechanism, nominal.configuration);
      solved.rho = actuator_values(model.mechanism, nominal.configuration);
    }
  };
  for_each_slice(requests.size(), threads, solve, poses_at_once);
  return all;
}

}  // namespace counterflex
