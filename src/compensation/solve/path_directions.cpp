#include <algorithm>
#include <cmath>

#include "compensation/plan/places.hpp"
#include "compensation/solve/branch.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/solver.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {
namespace {

constexpr double least_motion = 1e-9;  // m or rad: more than the rounding of inverse kinematics
// Of an arm: its axes turn back once along it. An arm with reversals, three programs: 20 and 150 mm have the
// same text.
constexpr double longest_step = 50 * mm;
constexpr double at_ends = 1e-3;  // of a step: a turning point nearer to an end is taken to be there
constexpr double same_place = 10 * um;
constexpr double turning_accuracy = 1e-7;   // of a step; the axis hardly moves beside a turning point
constexpr std::size_t most_together = 256;  // places

/// A place of the path, or the last one where the position of `lost` axes of the program is not known.
struct Place {
  std::size_t move = 0;
  double u = 0;
  TipPosition at{};
  const Segment* segment = nullptr;
  std::array<bool, 3> lost{};
  bool ends_cut = false;
};

Place place_on(const Model& model, const Segment& segment, double u) {
  return {segment.move, u, {&model, point_at(segment.wanted, u), orientation_at(segment, u)}, &segment};
}

void add_segment(const Job& job, const Segment& segment, std::vector<Place>& places) {
  const Model& model = model_of(job, segment);
  const double turned = angle_along(segment);
  const bool straight = only_slides(model.mechanism) && turned == 0;
  const double steps =
      straight ? 1 : std::ceil(length(segment.wanted) / longest_step + turned / angle_between_places);
  const int n = static_cast<int>(std::clamp(steps, 1.0, most_steps));
  places.push_back(place_on(model, segment, 0));
  if (!straight) places.push_back(place_on(model, segment, at_ends / n));
  for (int k = 1; k < n; ++k) places.push_back(place_on(model, segment, static_cast<double>(k) / n));
  if (!straight) places.push_back(place_on(model, segment, 1 - at_ends / n));
  places.push_back(place_on(model, segment, 1));
  places.back().ends_cut = segment.cutting;
}

/// The holes of a cycle of G-code: the way to each, as far as it is known, then down from the retract plane
/// to the bottom. In X and Y the tool moves at the height at which the cycle leaves it.
void add_holes_of_cycle(const Job& job, std::size_t m, const Segment* way, std::vector<Place>& places) {
  const Move& move = job.program.moves[m];
  const Model& model = model_of(job, m);
  const Pose X_MW = wanted_frame(job.path.frames[move.frame]);
  const std::optional<Matrix3> R = orientation_of(job, move);
  const auto add = [&](double u, const Vector3& place_mm, double z_mm) {
    const Vector3 p_mm(place_mm.x(), place_mm.y(), z_mm);
    places.push_back({m, u, {&model, X_MW * (p_mm * mm), R}});
  };
  if (way != nullptr) places.push_back({m, 0, {&model, way->wanted.start, R}});
  double before = 0;
  for (const double u : fractions_of_holes(move)) {
    const auto between = [&](double share) { return before + share * (u - before); };
    const Vector3 bottom_mm = bottom_of_hole(move, u);
    const bool leaves_hole = before > 0 && move.known_end[2];
    if (leaves_hole) add(between(0.125), bottom_of_hole(move, before), move.end_mm.z());
    if (leaves_hole || way != nullptr) add(between(0.25), bottom_mm, move.end_mm.z());
    add(between(0.5), bottom_mm, move.cycle->retract_mm);
    add(u, bottom_mm, bottom_mm.z());
    places.back().ends_cut = true;
    before = u;
  }
}

/// A hole of a cycle that is called at the end of a move: the way there, if it is known, then down to this
/// end.
void add_called_hole(const Job& job, std::size_t m, const Segment* way, std::vector<Place>& places) {
  constexpr double above = 1 * mm;
  const Move& move = job.program.moves[m];
  const Pose X_MW = wanted_frame(job.path.frames[move.frame]);
  const std::optional<Matrix3> R = orientation_of(job, move);
  const auto add = [&](double u, const Vector3& p_M) {
    places.push_back({m, u, {&model_of(job, m), p_M, R}});
  };
  if (way != nullptr) add(0, way->wanted.start);
  add(0.5, X_MW * (move.end_mm * mm + Vector3(0, 0, above)));
  add(1, wanted_of(job, move));
  places.back().ends_cut = true;
}

/// The place behind `last` where a move has `known` axes; the others are where they were.
Place place_without(const Job& job, std::size_t m, const std::array<bool, 3>& known, const Vector3& at_mm,
                    const TipPosition& last) {
  const Pose X_MW = wanted_frame(job.path.frames[job.program.moves[m].frame]);
  Vector3 p_mm = inverse(X_MW) * last.p_MT / mm;
  Place place{m, 0, {&model_of(job, m), {}, last.R_MT}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (known[axis]) p_mm[axis] = at_mm[axis];
    place.lost[axis] = !known[axis];
  }
  place.at.p_MT = X_MW * (p_mm * mm);
  return place;
}

/// `last`: where the window before ended.
std::vector<Place> places_of(const Job& job, const std::optional<Vector3>& last) {
  std::vector<Place> places;
  const auto add_lost = [&](std::size_t m, const std::array<bool, 3>& known, const Vector3& at_mm) {
    if (all_known(known) || (places.empty() && !last)) return;
    const TipPosition before = places.empty() ? TipPosition{nullptr, *last, {}} : places.back().at;
    places.push_back(place_without(job, m, known, at_mm, before));
  };
  std::size_t next = 0;
  for (std::size_t m = 0; m < job.program.moves.size(); ++m) {
    const Move& move = job.program.moves[m];
    add_lost(m, move.known_start, move.start_mm);
    const bool has_segment = next < job.path.segments.size() && job.path.segments[next].move == m;
    const Segment* const segment = has_segment ? &job.path.segments[next++] : nullptr;
    if (!fractions_of_holes(move).empty())
      add_holes_of_cycle(job, m, segment, places);
    else if (move.makes_hole && all_known(move.known_end))
      add_called_hole(job, m, segment, places);
    else if (segment != nullptr)
      add_segment(job, *segment, places);
    else if (all_known(move.known_end))  // from an unknown position
      places.push_back({m, 1, {&model_of(job, m), wanted_of(job, move), orientation_of(job, move)}});
    else
      add_lost(m, move.known_end, move.end_mm);
  }
  return places;
}

class Follower {
 public:
  Follower(const Job& job, DirectionsEnd& end) : job_(job), end_(end), solver_(job), path_(end.directions) {}

  PathDirections run() {
    const std::vector<Place> places = places_of(job_, end_.p_MT);
    for (std::size_t first = 0; first < places.size(); first += most_together) {
      const std::size_t count = std::min(most_together, places.size() - first);
      std::vector<TipPosition> positions;
      for (std::size_t i = 0; i < count; ++i) positions.push_back(places[first + i].at);
      const std::vector<NominalResult> nominals = solver_.nominals(positions);
      for (std::size_t i = 0; i < count; ++i) {
        const Place& place = places[first + i];
        if (nominals[i].status == Status::converged)
          go_to(place, actuator_values(place.at.model->mechanism, nominals[i].configuration));
        else if (std::ranges::count(place.lost, true) > 0)
          lose_all(place);
        else
          return std::move(path_);
      }
    }
    return std::move(path_);
  }

 private:
  struct Turning {
    double u;
    std::size_t actuator;
    int sign;
  };

  /// Where the known axes and the old places of the others are together no place of the machine.
  void lose_all(const Place& place) {
    for (DirectionsEnd::Lost& lost : end_.lost) {
      if (lost.before == 0) lost.before = job_.program.moves[place.move].line;
      lost.position = true;
    }
  }

  void go_to(const Place& place, const Eigen::VectorXd& values) {
    const Mechanism& mechanism = place.at.model->mechanism;
    end_.p_MT = place.at.p_MT;
    end_.lost.resize(mechanism.reversal.size());
    if (end_.rho.size() != values.size()) {
      end_.rho = values;
      last_ = {place};
      return;
    }
    const Eigen::VectorXd rho = values + full_turns(mechanism, values, end_.rho);
    const std::vector<bool> lost = lost_actuators(place, rho);
    std::vector<Turning> turnings;
    for (std::size_t a = 0; a < mechanism.reversal.size(); ++a) {
      const double way = rho[a] - end_.rho[a];
      const int sign = way > 0 ? 1 : -1;
      if (end_.lost[a].position || lost[a]) {
        if (end_.lost[a].before == 0) end_.lost[a].before = job_.program.moves[place.move].line;
        end_.lost[a].position = lost[a];
        continue;
      }
      if (!(std::abs(way) > least_motion)) continue;
      end_.lost[a] = {};
      if (end_.directions.of(a) != sign) turnings.push_back({turning_point(place, a, sign), a, sign});
    }
    note_doubts(place, mechanism);
    std::ranges::stable_sort(turnings, {}, &Turning::u);
    for (Turning& t : turnings) {
      t.u = shared_place(place, t.u);
      const bool reverses = end_.directions.of(t.actuator) == -t.sign && mechanism.reversal[t.actuator] > 0;
      end_.directions.set(t.actuator, t.sign);
      path_.add(DirectionChange{place.move, t.u, t.actuator, end_.directions, reverses});
    }
    end_.rho = rho;
    last_.push_back(place);
    if (last_.size() > 2) last_.erase(last_.begin());
  }

  /// Whether each actuator moves with an axis whose position is not known.
  std::vector<bool> lost_actuators(const Place& place, const Eigen::VectorXd& rho) {
    constexpr double probe = 1 * mm;
    const Matrix3 R_MW = wanted_frame(job_.path.frames[job_.program.moves[place.move].frame]).R;
    const Mechanism& mechanism = place.at.model->mechanism;
    std::vector<bool> lost(mechanism.reversal.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!place.lost[axis]) continue;
      TipPosition beside = place.at;
      beside.p_MT += probe * R_MW.col(axis);
      const NominalResult nominal = solver_.nominals({&beside, 1}).front();
      const bool is_found = nominal.status == Status::converged;
      Eigen::VectorXd there = is_found ? actuator_values(mechanism, nominal.configuration) : rho;
      there += full_turns(mechanism, there, rho);
      for (std::size_t a = 0; a < lost.size(); ++a) {
        if (!is_found || std::abs(there[a] - rho[a]) > least_motion) lost[a] = true;
      }
    }
    return lost;
  }

  /// At the end of a cut.
  void note_doubts(const Place& place, const Mechanism& mechanism) {
    if (!place.ends_cut) return;
    for (std::size_t a = 0; a < end_.lost.size(); ++a) {
      DirectionsEnd::Lost& lost = end_.lost[a];
      if (lost.before == 0 || lost.reported || !(mechanism.reversal[a] > 0)) continue;
      lost.reported = true;
      path_.add(DoubtfulDirection{job_.program.moves[place.move].line, a, lost.before});
    }
  }

  /// Several joints of an arm turn back at one place, but for rounding: they reverse together there. A
  /// turning point beside an end of the move is taken to be at the end.
  double shared_place(const Place& place, double u) const {
    if (place.segment == nullptr || !(length(place.segment->wanted) > 0)) return u;
    const double near = same_place / length(place.segment->wanted);
    if (u < near) u = 0;
    if (u > 1 - near) u = 1;
    if (path_.changes().empty() || path_.changes().back().move != place.move) return u;
    const double last = path_.changes().back().u;
    return u - last < near ? last : u;
  }

  /// Where the actuator that moves with `sign` to this place began to: between the place before the last one
  /// and this one, if both are on one segment; else at the last place, or where the move begins.
  double turning_point(const Place& place, std::size_t actuator, int sign) {
    const Place* from = last_.empty() ? nullptr : &last_.back();
    if (from == nullptr || from->segment != place.segment || place.segment == nullptr)
      return from != nullptr && from->move == place.move ? from->u : 0;
    if (last_.size() < 2 || last_.front().segment != place.segment) return from->u;
    return least_inside(*place.segment, last_.front().u, place.u, actuator, sign);
  }

  /// The fraction between u0 and u1 at which `sign` times the actuator is least: golden section.
  double least_inside(const Segment& segment, double u0, double u1, std::size_t actuator, int sign) {
    const double golden = (std::sqrt(5.0) - 1) / 2, accuracy = turning_accuracy * (u1 - u0);
    const auto value = [&](double u) {
      const TipPosition at = place_on(model_of(job_, segment), segment, u).at;
      const NominalResult nominal = std::move(solver_.nominals({&at, 1}).front());
      if (nominal.status != Status::converged) return HUGE_VAL;
      const Eigen::VectorXd rho = actuator_values(at.model->mechanism, nominal.configuration);
      const Eigen::VectorXd near = rho + full_turns(at.model->mechanism, rho, end_.rho);
      return sign * near[actuator];
    };
    double a = u1 - golden * (u1 - u0), b = u0 + golden * (u1 - u0);
    double at_a = value(a), at_b = value(b);
    while (u1 - u0 > accuracy) {
      if (at_a < at_b) {
        u1 = b, b = a, at_b = at_a;
        at_a = value(a = u1 - golden * (u1 - u0));
      } else {
        u0 = a, a = b, at_a = at_b;
        at_b = value(b = u0 + golden * (u1 - u0));
      }
    }
    return (u0 + u1) / 2;
  }

  const Job& job_;
  DirectionsEnd& end_;
  PlaceSolver solver_;
  PathDirections path_;
  std::vector<Place> last_{};  // the last two
};

}  // namespace

Directions PathDirections::at(std::size_t move, double u, Side side) const {
  const bool includes = u <= 0 || (u < 1 && side == Side::after);  // what changes there
  const auto is_before = [&](const DirectionChange& change) {
    if (change.move != move) return change.move < move;
    return includes ? change.u <= u : change.u < u;
  };
  const auto behind = std::ranges::partition_point(changes_, is_before);
  return behind == changes_.begin() ? first_ : std::prev(behind)->behind;
}

Directions PathDirections::before(std::size_t move) const {
  const auto behind = std::ranges::lower_bound(changes_, move, {}, &DirectionChange::move);
  return behind == changes_.begin() ? first_ : std::prev(behind)->behind;
}

std::vector<double> PathDirections::inside(std::size_t move) const {
  std::vector<double> fractions;
  for (auto change = std::ranges::lower_bound(changes_, move, {}, &DirectionChange::move);
       change != changes_.end() && change->move == move; ++change)
    if (change->is_reversal && change->u > 0 && change->u < 1 &&
        (fractions.empty() || fractions.back() < change->u))
      fractions.push_back(change->u);
  return fractions;
}

PathDirections directions_along(const Job& job, DirectionsEnd& end) {
  if (job.model.mechanism.reversal.empty()) return PathDirections{};
  return Follower(job, end).run();
}

void add_first_motions(const PathDirections& path, Directions& first) {
  for (const DirectionChange& change : path.changes())
    if (first.of(change.actuator) == 0) first.set(change.actuator, change.behind.of(change.actuator));
}

}  // namespace counterflex
