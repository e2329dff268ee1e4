#include "waypoint_solver.hpp"

namespace counterflex {

WaypointSolver::WaypointSolver(const Job& job, const Model& model, Configuration start)
    : one_by_one_(job, model, std::move(start)) {}

void WaypointSolver::wanted(std::span<const Vector3> p_MT, std::span<WantedPose> out) {
  for (std::size_t i = 0; i < p_MT.size(); ++i) out[i].X_MT = one_by_one_.wanted(p_MT[i], out[i].status);
}

void WaypointSolver::targets(std::span<const TargetRequest> requests, std::span<TargetSolution> out) {
  for (std::size_t i = 0; i < requests.size(); ++i)
    out[i] = one_by_one_.target(requests[i].p_MT, requests[i].load);
}

void WaypointSolver::actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const ActualRequest& request = requests[i];
    out[i] = one_by_one_.actual(request.target, request.load, request.stage, request.start);
    out[i].in_travel = one_by_one_.in_travel();
  }
}

}  // namespace counterflex
