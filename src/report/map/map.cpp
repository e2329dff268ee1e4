#include "counterflex/report/map.hpp"

#include <algorithm>
#include <cmath>

#include "counterflex/files/parallel.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/statics/batch_solver.hpp"
#include "counterflex/statics/tip_stiffness.hpp"

namespace counterflex {
namespace {

constexpr Stage whole_stage{};
constexpr std::size_t chunk = 64;  // places of one call of the kernel; of no effect on results

/// A place, solved: where the perfect machine is, and the real one.
struct PlaceState {
  Status status = Status::not_converged;
  Configuration loaded;
};

/// The nominal configuration of a place, if it is in travel.
NominalResult nominal_at(const Model& model, const Configuration& from, const Pose& X_MT) {
  constexpr double near = 1e-9;  // m and rad; on the border of travel a rounded value may be outside
  NominalResult nominal = follow(model, from, X_MT);
  if (nominal.status != Status::converged) return nominal;
  if ((tip(model.mechanism, nominal.configuration).p - X_MT.p).norm() > near)
    nominal.status = Status::unreachable;
  const auto axis = tightest_axis(model.mechanism, actuator_values(model.mechanism, nominal.configuration));
  if (axis && axis->margin < -near) nominal.status = Status::outside_travel;
  return nominal;
}

/// From home, as `analyze_pose` solves it.
PlaceState solve_from_home(const Model& model, const Pose& X_MT, const Load& load, StaticsWork& work) {
  const NominalResult nominal = nominal_at(model, model.home, X_MT);
  if (nominal.status != Status::converged) return {nominal.status, {}};
  Equilibrium loaded = solve_forward(model, nominal.configuration, load, whole_stage, work);
  if (loaded.status == Status::converged && !load.F.isZero(0) &&
      !is_reached_by_load_alone(model, nominal.configuration, load, whole_stage, loaded, work))
    loaded.status = Status::unstable;
  return {loaded.status, std::move(loaded.configuration)};
}

/// The state whose tip the kernel has found, from the nominal configuration of its cell. Another status than
/// `converged`: solve from home.
PlaceState solve_from_cell(const Model& model, const Configuration& near, const Pose& X_MT, const Load& load,
                           const Pose& found, StaticsWork& work) {
  const NominalResult nominal = nominal_at(model, near, X_MT);
  if (nominal.status != Status::converged) return {nominal.status, {}};
  Equilibrium loaded = equilibrium_at(model, nominal.configuration, load, whole_stage, found, work);
  return {loaded.status, std::move(loaded.configuration)};
}

MapPlace deviation_place(const Vector3& actual, const Vector3& wanted) {
  return {Status::converged, (actual - wanted).norm(), actual - wanted};
}

MapPlace stiffness_place(const Model& model, const Configuration& loaded, const MapRequest& request,
                         StaticsWork& work) {
  const auto compliance = compliance_at_tip(model, loaded, request.load, whole_stage, work);
  if (!compliance) return {Status::singular};
  if (request.direction)
    return {Status::converged, stiffness_along(*compliance, *request.direction), *request.direction};
  const SoftestDirection softest = softest_direction(*compliance);
  return {Status::converged, softest.stiffness, softest.direction};
}

/// The places from index `first` on.
class ChunkOfMap {
 public:
  ChunkOfMap(const Model& model, const MapRequest& request, const StartTable& table)
      : model_(model),
        request_(request),
        X_home_(tip(model.mechanism, model.home)),
        turn_(log_so3(request.R_turn)),
        kernel_(table),
        work_(model.mechanism) {}

  void solve(std::size_t first, std::vector<MapPlace>& places) {
    const std::size_t count = std::min(chunk, places.size() - first);
    std::vector<BatchRequest> requests;
    for (std::size_t i = 0; i < count; ++i)
      requests.push_back({{request_.grid.place(first + i), turn_}, request_.load.F});
    std::vector<BatchAnswer> answers(count);
    kernel_.solve(BatchQuestion::forward, whole_stage, requests, answers);
    for (std::size_t i = 0; i < count; ++i) places[first + i] = place(requests[i].at, answers[i]);
  }

 private:
  MapPlace place(const TurnedPlace& at, const BatchAnswer& answer) {
    const bool stiffness = request_.quantity == MapQuantity::stiffness;
    if (answer.solved && !stiffness) return deviation_place(answer.X_MT.p, at.p);
    const Pose X_MT{request_.R_turn * X_home_.R, at.p};
    PlaceState state;
    if (answer.solved)
      if (const Configuration* near = kernel_.nominal_near(at))
        state = solve_from_cell(model_, *near, X_MT, request_.load, answer.X_MT, work_);
    if (state.status != Status::converged) state = solve_from_home(model_, X_MT, request_.load, work_);
    if (state.status != Status::converged) return {state.status};
    return stiffness ? stiffness_place(model_, state.loaded, request_, work_)
                     : deviation_place(tip(model_.mechanism, state.loaded).p, at.p);
  }

  const Model& model_;
  const MapRequest& request_;
  Pose X_home_;
  Vector3 turn_;
  BatchSolver kernel_;
  StaticsWork work_;
};

}  // namespace

std::vector<MapPlace> map_places(const Model& model, const MapRequest& request) {
  std::vector<MapPlace> places(request.grid.size());
  const StartTable table(model, false);
  for_each_index((places.size() + chunk - 1) / chunk, request.threads,
                 [&](std::size_t i) { ChunkOfMap(model, request, table).solve(i * chunk, places); });
  return places;
}

MapRange range_of(const WorkspaceMap& map) {
  MapRange range;
  std::vector<double> values;
  const bool larger_is_better = map.request.quantity == MapQuantity::stiffness;
  for (std::size_t i = 0; i < map.places.size(); ++i) {
    if (map.places[i].status != Status::converged) continue;
    ++range.solved;
    const double value = map.places[i].value;
    if (!std::isfinite(value)) {
      ++range.rigid;
      continue;
    }
    constexpr double same = 1e-7;  // of a value
    const auto better = [&](double a, double b) {
      return (larger_is_better ? a - b : b - a) > same * std::max(std::abs(a), std::abs(b));
    };
    if (values.empty() || better(value, map.places[range.best].value)) range.best = i;
    if (values.empty() || better(map.places[range.worst].value, value)) range.worst = i;
    values.push_back(value);
  }
  if (values.empty()) return range;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  range.median = *middle;
  return range;
}

}  // namespace counterflex
