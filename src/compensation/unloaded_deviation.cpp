#include <atomic>

#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/files/parallel.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

void PathPlaces::add(const Program& window) {
  for (const Move& move : window.moves) {
    const ProgramFrame& frame = window.frames[move.frame];
    if (is_set(frame)) continue;
    for (const Curve& hole : holes_of_cycle(move)) add(hole, move, frame);
    if (move.motion == Motion::feed && all_known(move.known_start) && all_known(move.known_end))
      add(curve_of(move), move, frame);
  }
}

void PathPlaces::add(const Curve& way_of_tip, const Move& move, const ProgramFrame& frame) {
  const Curve curve = in_offset(frame) * way_of_tip;
  const double way = length(curve);
  if (!(way > 0)) return;
  OfOffset& of = offsets_[frame.work_offset];
  for (double next = of.spacing_mm * static_cast<double>(of.places.size()); next <= of.way_mm + way;
       next = of.spacing_mm * static_cast<double>(of.places.size())) {
    if (of.places.size() < most) {
      const double u = (next - of.way_mm) / way;
      PathPlace& place = of.places.emplace_back(PathPlace{point_at(curve, u)});
      const double turned = move.motion == Motion::feed ? u : 1;  // a hole is at the end of its move
      if (move.orientation) place.R = in_offset(frame).R * orientation_at(turn_of(*move.orientation), turned);
      continue;
    }
    for (std::size_t k = 0; k < most / 2; ++k) of.places[k] = of.places[2 * k];
    of.places.resize(most / 2);
    of.spacing_mm *= 2;
  }
  of.way_mm += way;
}

std::span<const PathPlace> PathPlaces::of(const std::string& offset) const {
  const auto found = offsets_.find(offset);
  return found == offsets_.end() ? std::span<const PathPlace>{} : std::span(found->second.places);
}

UnloadedDeviation unloaded_deviation(const TipPosition& at, const StartTables* starts) {
  PlaceSolver solver(starts, false);
  const WantedPose wanted = solver.wanted(at);
  if (wanted.status != Status::converged) return {wanted.status};
  const ForwardAnswer actual =
      solver.forward({.model = at.model, .target = at.p_MT, .within_travel = true, .R = at.R_MT});
  if (actual.status != Status::converged) return {actual.status};
  return {Status::converged, actual.X_MT.p - wanted.X_MT.p};
}

std::optional<Vector3> common_shift(const Model& model, const Pose& X_MW, std::span<const PathPlace> places,
                                    const StartTables* starts, int threads) {
  std::vector<UnloadedDeviation> at(places.size());
  std::atomic<std::size_t> end = places.size();  // a run ends there, too; each further place takes long
  for_each_index(places.size(), threads, [&](std::size_t i) {
    if (i >= end) return;
    const auto& [p_mm, R] = places[i];
    const std::optional<Matrix3> R_MT = R ? std::optional<Matrix3>(X_MW.R * *R) : std::nullopt;
    at[i] = unloaded_deviation({&model, X_MW * Vector3(p_mm * mm), R_MT}, starts);
    if (at[i].status == Status::converged) return;
    std::size_t last = end;
    while (i < last && !end.compare_exchange_weak(last, i)) continue;
  });
  if (end == 0) return std::nullopt;
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < end; ++i) sum += at[i].d;
  return sum / static_cast<double>(end);
}

}  // namespace counterflex
