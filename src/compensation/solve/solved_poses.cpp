#include "counterflex/compensation/solved_poses.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "compensation/solve/solver.hpp"
#include "compensation/windows/parallel.hpp"

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

/// A slice of the requests, for one thread.
class SliceOfPoses {
 public:
  SliceOfPoses(const Model& model, const StartTables& starts)
      : model_(model), orientation_(orientation_of(model.mechanism)), solver_(&starts, false) {}

  void solve(std::span<const PoseRequest> requests, std::span<SolvedCommand> solved) {
    std::vector<ForwardRequest> asked;
    for (const PoseRequest& request : requests)
      asked.push_back({.model = &model_,
                       .target = request.X_MT.p,
                       .F = request.F,
                       .within_travel = true,
                       .R = commanded(request.X_MT.R)});
    std::vector<ForwardAnswer> answers(asked.size());
    solver_.forwards(asked, answers, StopAt::end);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      solved[i] = {answers[i].status, {}, answers[i].X_MT, std::move(answers[i].rho)};
      if (solved[i].status == Status::converged)
        solved[i].status = nominal_pose({&model_, asked[i].target, asked[i].R}, solved[i].wanted);
    }
  }

  void solve(std::span<const PoseRequest> requests, std::span<SolvedTarget> solved) {
    std::vector<TargetRequest> asked;
    for (const PoseRequest& request : requests)
      asked.push_back(
          {.model = &model_, .p_MT = request.X_MT.p, .F = request.F, .R_MT = commanded(request.X_MT.R)});
    std::vector<TargetAnswer> answers(asked.size());
    solver_.targets(asked, answers, StopAt::end);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      solved[i].status = answers[i].status;
      if (solved[i].status != Status::converged) continue;
      TipPosition target{&model_, answers[i].target};
      if (asked[i].R_MT) target.R_MT = Matrix3(exp_so3(answers[i].turn) * *asked[i].R_MT);
      const NominalResult nominal = std::move(solver_.nominals({&target, 1}).front());
      solved[i].status = nominal.status;
      if (nominal.status != Status::converged) continue;
      solved[i].X_MT = tip(model_.mechanism, nominal.configuration);
      solved[i].rho = actuator_values(model_.mechanism, nominal.configuration);
    }
  }

 private:
  std::optional<Matrix3> commanded(const Matrix3& R) const {
    return orientation_ == Orientation::of_home ? std::nullopt : std::optional(R);
  }

  /// The pose of the nominal tip: uncontrolled components are those of nominal kinematics.
  Status nominal_pose(const TipPosition& at, Pose& X_MT) {
    if (orientation_ == Orientation::partly_of_request) {
      const NominalResult nominal = solver_.nominal(at);
      if (nominal.status == Status::converged) X_MT = tip(model_.mechanism, nominal.configuration);
      return nominal.status;
    }
    const WantedPose wanted = solver_.wanted(at);
    X_MT = wanted.X_MT;
    return wanted.status;
  }

  const Model& model_;
  const Orientation orientation_;
  PlaceSolver solver_;
};

template <typename Solved>
std::vector<Solved> solve_in_slices(const Model& model, const StartTables& starts,
                                    std::span<const PoseRequest> requests, int threads) {
  std::vector<Solved> solved(requests.size());
  const auto solve = [&](std::size_t begin, std::size_t count) {
    SliceOfPoses(model, starts)
        .solve(requests.subspan(begin, count), std::span(solved).subspan(begin, count));
  };
  for_each_slice(requests.size(), threads, solve, poses_at_once);
  return solved;
}

}  // namespace

std::vector<SolvedCommand> solve_commands(const Model& model, const StartTables& starts,
                                          std::span<const PoseRequest> requests, int threads) {
  return solve_in_slices<SolvedCommand>(model, starts, requests, threads);
}

std::vector<SolvedTarget> solve_targets(const Model& model, const StartTables& starts,
                                        std::span<const PoseRequest> requests, int threads) {
  return solve_in_slices<SolvedTarget>(model, starts, requests, threads);
}

}  // namespace counterflex
