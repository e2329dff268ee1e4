#include "counterflex/compensation/unloaded_deviation.hpp"

#include "counterflex/compensation/options.hpp"
#include "counterflex/geometry/units.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

void PathPlaces::add(const Program& window) {
  for (const Move& move : window.moves) {
    if (move.motion != Motion::feed || !all_known(move.known_start) || !all_known(move.known_end)) continue;
    const ProgramFrame& frame = window.frames[move.frame];
    if (is_set(frame)) continue;
    add(move, frame, offsets_[frame.work_offset]);
  }
}

void PathPlaces::add(const Move& move, const ProgramFrame& frame, OfOffset& of) {
  const Curve curve = in_offset(frame) * curve_of(move);
  const double way = length(curve);
  if (!(way > 0)) return;
  for (double next = of.spacing_mm * static_cast<double>(of.places.size()); next <= of.way_mm + way;
       next = of.spacing_mm * static_cast<double>(of.places.size())) {
    if (of.places.size() < most) {
      of.places.push_back({point_at(curve, (next - of.way_mm) / way), move.tool});
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

UnloadedDeviation unloaded_deviation(const Model& model, NominalToolPath& nominal, const Vector3& p_MT) {
  const Status reached = nominal.go_to(model, p_MT);
  if (reached != Status::converged) return {reached};
  StaticsWork work(model.mechanism);
  const Equilibrium actual = solve_forward(model, nominal.configuration(), Load{}, Stage{}, work);
  if (actual.status != Status::converged) return {actual.status};
  return {Status::converged,
          tip(model.mechanism, actual.configuration).p - tip(model.mechanism, nominal.configuration()).p};
}

std::optional<Vector3> common_shift(const Model& model, const ToolModels& tools, const Pose& X_MW,
                                    std::span<const PathPlace> places) {
  NominalToolPath nominal(home_of(model));
  Vector3 sum = Vector3::Zero();
  int solved = 0;
  for (const PathPlace& place : places) {
    const UnloadedDeviation here =
        unloaded_deviation(model_with(model, &tools, place.tool), nominal, X_MW * Vector3(place.p_mm * mm));
    if (here.status != Status::converged) break;  // a run ends there, too; each further place would be tried for long
    sum += here.d;
    ++solved;
  }
  if (solved == 0) return std::nullopt;
  return sum / solved;
}

}  // namespace counterflex
