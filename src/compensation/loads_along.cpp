#include "counterflex/compensation/loads_along.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "compensation/solve/attribution.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {
namespace {

constexpr std::size_t most_load_stretches = LoadPlaces::most - 4;  // even, and room for the peaks

// Solvers for different processors agree to less: of values that differ by less the first is the largest.
constexpr double indistinct_share = 1e-7;

bool is_larger(double value, double than) {
  return value > than * (1 + indistinct_share);
}

}  // namespace

LoadPlace LoadPlaces::place_of(const Job& job, const Waypoint& w) const {
  const Move& move = job.program.moves[w.move];
  const Vector3 target = original_command(job, move.frame, w.p_MT) + w.correction.head<3>();
  const Load load{w.wrench, job.forces.at_platform()};
  return {count_, w, target, load, &model_of(job, w.move), move.tool, move.frame};
}

double LoadPlaces::value_of(const Job& job, const Waypoint& w) const {
  if (kept_ == KeptPlace::largest_force) return w.wrench.head<3>().norm();
  return share_of_tolerance(job.options, job.model.mechanism, w.R_MT, w.after);
}

void LoadPlaces::add(const Job& job, const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) {
    if (!tool_cuts_at(job.program, w) || w.status != Status::converged) continue;
    add_to_stretch(job, w);
    add_peaks(job, w);
    ++count_;
  }
}

void LoadPlaces::raise(Peak& peak, double value, const Job& job, const Waypoint& w) const {
  if (is_larger(value, peak.value)) peak = {value, place_of(job, w)};
}

void LoadPlaces::add_to_stretch(const Job& job, const Waypoint& w) {
  if (stretches_.empty() || in_last_ == per_stretch_) {
    if (stretches_.size() == most_load_stretches) merge_neighbours();
    stretches_.push_back({value_of(job, w), place_of(job, w)});
    in_last_ = 0;
  } else {
    Peak& kept = stretches_.back();
    const double weight = kept.place->at.weight + w.weight;
    raise(kept, value_of(job, w), job, w);
    kept.place->at.weight = weight;
  }
  ++in_last_;
}

void LoadPlaces::merge_neighbours() {
  for (std::size_t i = 0; i < most_load_stretches / 2; ++i) {
    const Peak &first = stretches_[2 * i], &second = stretches_[2 * i + 1];
    const double weight = first.place->at.weight + second.place->at.weight;
    stretches_[i] = Peak(is_larger(second.value, first.value) ? second : first);
    stretches_[i].place->at.weight = weight;
  }
  stretches_.resize(most_load_stretches / 2);
  per_stretch_ *= 2;
}

// The deviation before counts at the places of the original path.
void LoadPlaces::add_peaks(const Job& job, const Waypoint& w) {
  raise(force_, w.wrench.head<3>().norm(), job, w);
  raise(moment_, w.wrench.tail<3>().norm(), job, w);
  if (w.place) raise(before_, w.before.head<3>().norm(), job, w);
  for (Peak* peak : {&force_, &moment_, &before_})
    if (peak->place) peak->place->at.weight = 0;  // its stretch has it
}

std::vector<LoadPlace> LoadPlaces::places() const {
  std::vector<LoadPlace> all;
  for (const Peak& stretch : stretches_) all.push_back(*stretch.place);
  for (const Peak* peak : {&force_, &moment_, &before_})
    if (peak->place) all.push_back(*peak->place);
  const auto before = [](const LoadPlace& a, const LoadPlace& b) { return a.number < b.number; };
  const auto same = [](const LoadPlace& a, const LoadPlace& b) { return a.number == b.number; };
  std::stable_sort(all.begin(), all.end(), before);
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

ForwardRequest request_at(const LoadPlace& place) {
  return {.model = place.model,
          .target = place.target,
          .F = place.load.F,
          .R = commanded_orientation(place.at),
          .directions = place.at.directions};
}

LoadsAlong solve_loads(const Model& base, const std::vector<LoadPlace>& places, int threads,
                       const StartTables* starts) {
  std::vector<LoadsAtPlace> solved(places.size());
  for_each_slice(places.size(), threads, [&](std::size_t begin, std::size_t count) {
    PlaceSolver solver(starts, places[begin].load.at_platform);
    std::vector<ForwardRequest> requests;
    for (const LoadPlace& place : std::span(places).subspan(begin, count))
      requests.push_back(request_at(place));
    std::vector<ForwardAnswer> answers(count);
    solver.forwards(requests, answers, StopAt::end);
    for (std::size_t i = 0; i < count; ++i) {
      if (answers[i].status != Status::converged) continue;
      const LoadPlace& place = places[begin + i];
      const Equilibrium loaded = solver.equilibrium(requests[i], answers[i]);
      if (loaded.status == Status::converged)
        solved[begin + i] = {place.at.s, place.at.line,
                             loads(base.mechanism, *place.model, loaded.configuration)};
    }
  });
  LoadsAlong along;
  for (LoadsAtPlace& at : solved)
    if (!at.chains.empty()) along.places.push_back(std::move(at));
  along.unsolved = places.size() - along.places.size();
  return along;
}

std::vector<NominalResult> solve_nominal(const std::vector<LoadPlace>& places, int threads,
                                         const StartTables* starts) {
  std::vector<NominalResult> all(places.size());
  for_each_slice(places.size(), threads, [&](std::size_t begin, std::size_t count) {
    PlaceSolver solver(starts, places[begin].load.at_platform);
    std::vector<TipPosition> at;
    for (const LoadPlace& place : std::span(places).subspan(begin, count))
      at.push_back({place.model, place.target, commanded_orientation(place.at)});
    std::ranges::move(solver.nominals(at), all.begin() + begin);
  });
  return all;
}

std::optional<Causes> solve_causes(const LoadPlace& place, const StartTables* starts) {
  PlaceSolver solver(starts, place.load.at_platform);
  const TipPosition position = wanted_at(*place.model, place.at);
  const WantedPose wanted = solver.wanted(position);
  if (wanted.status != Status::converged) return std::nullopt;
  const ForwardRequest emitted = request_at(place);
  ForwardRequest original = emitted;
  original.target -= place.at.correction.head<3>();
  original.R = position.R_MT;
  const std::array<ForwardPlace, 1> solved{{{original, emitted, wanted.X_MT}}};
  std::array<Waypoint, 1> at{place.at};
  add_causes(solver, solved, at);
  const bool known = at[0].status == Status::converged && at[0].causes;
  return known ? std::optional(*at[0].causes) : std::nullopt;
}

std::vector<OtherForce> solve_other_force(const std::vector<LoadPlace>& places, double factor, int threads,
                                          const StartTables* starts) {
  std::vector<OtherForce> all(places.size());
  for_each_slice(places.size(), threads, [&](std::size_t begin, std::size_t count) {
    std::vector<TipPosition> positions;
    std::vector<ForwardRequest> requests;
    for (const LoadPlace& place : std::span(places).subspan(begin, count)) {
      positions.push_back(wanted_at(*place.model, place.at));
      requests.push_back(request_at(place));
      requests.back().F *= factor;
    }
    std::vector<WantedPose> wanted(count);
    std::vector<ForwardAnswer> answers(count);
    PlaceSolver solver(starts, places[begin].load.at_platform);
    solver.wanted(positions, wanted, StopAt::end);
    solver.forwards(requests, answers, StopAt::end);
    for (std::size_t i = 0; i < count; ++i) {
      OtherForce& other = all[begin + i];
      if (places[begin + i].at.wrench.isZero(0))
        other.deviation = places[begin + i].at.after;
      else if (other.status = answers[i].status; other.status == Status::converged)
        other.deviation = deviation(answers[i].X_MT, wanted[i].X_MT);
    }
  });
  return all;
}

void PathPlaces::add(const Program& window) {
  for (const Move& move : window.moves) {
    const ProgramFrame& frame = window.frames[move.frame];
    for (const Curve& hole : holes_of_cycle(move)) add(hole, move, frame);
    if (move.motion == Motion::feed && all_known(move.known_start) && all_known(move.known_end))
      add(curve_of(move), move, frame);
  }
}

std::string PathPlaces::offset_of(const ProgramFrame& frame) {
  std::string name = frame.work_offset;
  if (frame.pose_mm) name += " with a pose";
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (frame.set_mm[axis]) name += fmt::format(" {}{}", "XYZ"[axis], *frame.set_mm[axis]);
  return name;
}

void PathPlaces::add(const Curve& way_of_tip, const Move& move, const ProgramFrame& frame) {
  const Pose place_of_program = frame.pose_mm.value_or(Pose{}) * in_offset(frame);
  const Curve curve = place_of_program * way_of_tip;
  const double way = length(curve);
  if (!(way > 0)) return;
  OfOffset& of = offsets_[offset_of(frame)];
  for (double next = of.spacing_mm * static_cast<double>(of.places.size()); next <= of.way_mm + way;
       next = of.spacing_mm * static_cast<double>(of.places.size())) {
    if (of.places.size() < most) {
      const double u = (next - of.way_mm) / way;
      PathPlace& place = of.places.emplace_back(PathPlace{point_at(curve, u)});
      const double turned = move.motion == Motion::feed ? u : 1;  // a hole is at the end of its move
      if (move.orientation) place.R = place_of_program.R * orientation_at(turn_of(*move.orientation), turned);
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
