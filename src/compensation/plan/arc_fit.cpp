#include "compensation/plan/arc_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "compensation/solve/failures.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr int fit_iterations = 4;
constexpr double fit_step_mm = 1e-4;       // of numerical derivatives
constexpr double most_sweep_change = 0.1;  // rad
constexpr double same_mm = 1e-9;
constexpr double turn_margin = 2e-5;  // rad: for the digits of orientations, and of the places of an arc

// What the pieces of one arc are compared with.
struct Sample {
  double v;      // fraction of the piece
  Vector3 p_mm;  // commanded
};

// The fraction of a place near that of `u`.
double fraction_along(const ArcTask& task, double u, const Vector3& place) {
  return u + (place - task.commanded(u)).dot(direction_at(task.source, u)) / length(task.source);
}

// The fraction of a written end of a piece: rounding moves it along the curve. The ends of the stretch keep
// theirs, and so do corners, to rounding: as where the text is read back.
double fraction_at(const ArcTask& task, double u, const Vector3& written) {
  if (u == task.begin || u == task.end) return u;
  const Vector3 off_mm = written - task.commanded(u);
  const double rounding_mm = roundings * rounding_allowance(task.move, task.options) / mm;
  if (std::ranges::count(task.corners, u) > 0 && off_mm.norm() <= rounding_mm) return u;
  return fraction_along(task, u, written);
}

// `u0` and `u1`: fractions at the ends of a piece.
std::vector<Sample> samples_of(const ArcTask& task, double u0, double u1) {
  std::vector<Sample> all;
  const double span = u1 - u0;
  const int by_angle = static_cast<int>(std::ceil(span * task.source.arc->sweep / angle_between_places)),
            count = std::max(samples_of_piece, by_angle);
  // The height of a flat arc may be off from its start on.
  for (int k = task.move.arc->flat ? 0 : 1; k <= count; ++k) {
    const double v = static_cast<double>(k) / count;
    all.push_back({v, task.commanded(k == count ? u1 : u0 + v * span)});
  }
  for (double corner : task.corners)
    if (corner > u0 && corner < u1) all.push_back({(corner - u0) / span, task.commanded(corner)});
  return all;
}

// Pieces are also judged there, but not fitted there: they are close to each other at some places.
std::vector<Sample> waves_of(const ArcTask& task, double u0, double u1) {
  std::vector<Sample> all;
  for (const double wave : task.waves)
    if (wave > u0 && wave < u1) all.push_back({(wave - u0) / (u1 - u0), task.commanded(wave)});
  return all;
}

// Two axes that span the plane, in any order.
std::array<Eigen::Index, 2> plane_of(const Move& move) {
  return {(move.arc->normal + 1) % 3, (move.arc->normal + 2) % 3};
}

double mismatch(const Curve& curve) {
  return std::abs(radius_at(*curve.arc, curve.end) - radius_at(*curve.arc, curve.start));
}

double digit_mm(const ArcTask& task) {
  const Decimals decimals = decimals_of(task.move, task.options);
  int least = decimals.inserted;
  for (const Eigen::Index axis : plane_of(task.move)) least = std::min(least, decimals.end[axis]);
  return std::pow(10.0, -least) * mm_per(task.move.unit);
}

// GRBL's rule; LinuxCNC's is wider.
bool radii_are_accepted(const Curve& curve) {
  const double miss = mismatch(curve);
  return miss <= 0.005 || (miss <= 0.5 && miss <= 0.001 * radius_at(*curve.arc, curve.start));
}

bool is_sound(const ArcTask& task, const ArcPiece& piece, const Curve& read) {
  if (!read.arc) return false;
  const double sweep = (piece.u1 - piece.u0) * task.source.arc->sweep;
  return std::abs(read.arc->sweep - sweep) < most_sweep_change &&
         mismatch(read) <= mismatch(task.source) + digit_mm(task) + same_mm &&
         (radii_are_accepted(read) || !radii_are_accepted(task.source));
}

double miss_of(const Curve& curve, const std::vector<Sample>& wanted) {
  double largest = 0;
  for (const Sample& s : wanted) largest = std::max(largest, (point_at(curve, s.v) - s.p_mm).norm());
  return largest;
}

// Everything that the fit of one piece needs.
class PieceFit {
 public:
  PieceFit(const ArcTask& task, const ArcPiece& piece)
      : task_(task),
        piece_(piece),
        plane_(plane_of(task.move)),
        start_(*piece.from.place_mm()),
        end_(task.commanded(piece.u1)) {
    const int normal = task.move.arc->normal;
    if (task.move.arc->flat) end_[normal] = start_[normal];
    kept_ = start_ + task.source.arc->centre - point_at(task.source, piece.u0);
    const Vector3 read_end =
        as_written(task.move, piece.from, {end_, kept_}, piece.u1 == 1, task.options).end;
    const double u0 = fraction_at(task, piece.u0, start_), u1 = fraction_at(task, piece.u1, read_end);
    samples_ = samples_of(task, u0, u1);
    waves_ = waves_of(task, u0, u1);
  }

  FittedArc run() const {
    FittedArc best = written(kept_);
    if (best.sound && best.miss_mm <= task_.tolerance_mm) return best;
    const Vector3 fitted = fitted_centre(best.read.arc ? best.read.end : end_);
    take_better(written(fitted), best);
    if (task_.move.arc->through && best.read.arc) take_better(written(tilted(best)), best);
    if (!best.sound || best.miss_mm > task_.tolerance_mm) try_neighbours(fitted, best);
    return best;
  }

  // The words decide where it ends. A line may lead from there to the planned end: where the text is read
  // back the arc is then the piece of the way up to that place, and not the whole.
  FittedArc run_polar() const {
    FittedArc fit = written(kept_, start_ + task_.source.end - task_.source.start);
    if (fit.read.arc) fit.miss_mm = std::max(fit.miss_mm, miss_of(fit.read, samples_to(fit.read.end)));
    return fit;
  }

 private:
  FittedArc written(const Vector3& centre) const { return written(centre, end_); }

  FittedArc written(const Vector3& centre, const Vector3& end) const {
    FittedArc fit{.via = {end, centre}, .read = {}};
    fit.read = as_written(task_.move, piece_.from, fit.via, piece_.u1 == 1, task_.options);
    fit.sound = is_sound(task_, piece_, fit.read);
    fit.miss_mm = fit.read.arc ? std::max(miss_of(fit.read, samples_), miss_of(fit.read, waves_))
                               : std::numeric_limits<double>::infinity();
    return fit;
  }

  // For an arc from whose end `end` a line leads to the end of the move.
  std::vector<Sample> samples_to(const Vector3& end) const {
    const double u0 = fraction_at(task_, piece_.u0, start_),
                 u1 = std::min(fraction_along(task_, piece_.u1, end), piece_.u1);
    std::vector<Sample> all = samples_of(task_, u0, u1);
    std::ranges::move(waves_of(task_, u0, u1), std::back_inserter(all));
    return all;
  }

  static void take_better(const FittedArc& other, FittedArc& best) {
    if (other.sound != best.sound ? other.sound : other.miss_mm < best.miss_mm) best = other;
  }

  // The plane of an arc through a point is tilted until the point is at its commanded height.
  Vector3 tilted(const FittedArc& fit) const {
    const double v = share_of_point(task_.move, fit.read.arc->sweep);
    const Vector3 &normal = task_.source.arc->normal,
                  wanted = task_.commanded(piece_.u0 + v * (piece_.u1 - piece_.u0));
    return *fit.via.centre_mm + normal * normal.dot(wanted - point_at(fit.read, v));
  }

  // The centre's own rounding may be what spoils the radii: the digits beside it.
  void try_neighbours(const Vector3& centre, FittedArc& best) const {
    const double digit = digit_mm(task_);
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b) {
        Vector3 beside = centre;
        beside[plane_[0]] += a * digit;
        beside[plane_[1]] += b * digit;
        if (a != 0 || b != 0) take_better(written(beside), best);
      }
  }

  // Centres with the source's difference of radii to both ends lie on a line across the chord.
  struct CentreLine {
    Vector3 foot, across;
  };

  std::optional<CentreLine> centre_line(const Vector3& end) const {
    const Arc& arc = *task_.source.arc;
    Vector3 chord = end - start_;
    chord -= chord.dot(arc.normal) * arc.normal;
    const double size = chord.norm();
    if (size < fit_step_mm) return std::nullopt;
    const double difference =
        (piece_.u1 - piece_.u0) * (radius_at(arc, task_.source.end) - radius_at(arc, task_.source.start));
    Vector3 foot =
        start_ + chord / 2 - difference * radius_at(arc, task_.source.start) / size * (chord / size);
    foot += (kept_ - foot).dot(arc.normal) * arc.normal;
    return CentreLine{foot, arc.normal.cross(chord / size)};
  }

  void misses(const Vector3& centre, const Vector3& end, Eigen::VectorXd& r) const {
    const Vector3& normal = task_.source.arc->normal;
    const int turns = piece_.u1 == 1 && !task_.move.arc->flat ? task_.move.arc->turns : 0;
    const Curve curve{start_, end, Arc{centre, normal, sweep_between(start_, end, centre, normal, turns)}};
    r.resize(3 * samples_.size());
    for (std::size_t k = 0; k < samples_.size(); ++k)
      r.segment<3>(3 * k) = point_at(curve, samples_[k].v) - samples_[k].p_mm;
  }

  // Gauss-Newton on the mean square of the misses, pulled a little to the original centre.
  Vector3 fitted_centre(const Vector3& end) const {
    const std::optional<CentreLine> line = centre_line(end);
    if (!line) return kept_;
    const double h_kept = (kept_ - line->foot).dot(line->across);
    const double pull = pull_to_source * static_cast<double>(samples_.size());
    double h = h_kept;
    Eigen::VectorXd r, beside;
    for (int i = 0; i < fit_iterations; ++i) {
      misses(line->foot + h * line->across, end, r);
      misses(line->foot + (h + fit_step_mm) * line->across, end, beside);
      const Eigen::VectorXd slope = (beside - r) / fit_step_mm;
      h -= (slope.dot(r) + pull * (h - h_kept)) / (slope.squaredNorm() + pull);
    }
    return line->foot + h * line->across;
  }

  const ArcTask& task_;
  const ArcPiece& piece_;
  std::array<Eigen::Index, 2> plane_;
  std::vector<Sample> samples_, waves_;
  Vector3 start_, end_;
  Vector3 kept_ = Vector3::Zero();  // the original centre, seen from the start
};

}  // namespace

FittedArc fit_arc(const ArcTask& task, const ArcPiece& piece) {
  return PieceFit(task, piece).run();
}

bool keeps_turn_limits(const ArcTask& task, const ArcPiece& piece, const Curve& read) {
  const Move& move = task.move;
  if (!read.arc || !move.orientation || !move.arc->through || !move.arc->through->turn_limits) return true;
  const MoveOrientation& original = *move.orientation;
  const OrientationNumbers start = task.turned(piece.u0), end = task.turned(piece.u1);
  const bool is_kept = piece.u0 == 0 && piece.u1 == 1 && start == original.start && end == original.end &&
                       keeps_words(task, piece, read);
  const ArcTurn turn{.normal = read.arc->normal,
                     .sweep = read.arc->sweep,
                     .point_share = share_of_point(move, read.arc->sweep),
                     .turn = {rotation_of(original.form, start), rotation_of(original.form, end), {}, {}}};
  return is_kept || keeps_limits(*move.arc->through->turn_limits, turn, turn_margin);
}

FittedArc fit_polar_arc(const ArcTask& task, const TextPosition& from) {
  return PieceFit(task, {0, 1, from}).run_polar();
}

bool keeps_words(const ArcTask& task, const ArcPiece& piece, const Curve& read) {
  if (!read.arc) return false;
  const Move& move = task.move;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool absolute = move.words[axis] && !is_relative(move, axis);
    const double stays =
        absolute ? move.end_mm[axis]
                 : *piece.from[axis] + (move.words[axis] ? move.end_mm[axis] - move.start_mm[axis] : 0);
    if (std::abs(read.end[axis] - stays) > same_mm) return false;
  }
  if (move.arc->radius_word)
    return std::abs(radius_at(*read.arc, read.start) - std::abs(move.arc->radius_mm)) < 1e-6;
  const Vector3 before = move.arc->centre_mm - (move.arc->absolute_centre ? Vector3::Zero() : move.start_mm),
                now = read.arc->centre - (move.arc->absolute_centre ? Vector3::Zero() : read.start);
  for (const Eigen::Index axis : plane_of(move))
    if (std::abs(now[axis] - before[axis]) > same_mm) return false;
  return true;
}

}  // namespace counterflex
