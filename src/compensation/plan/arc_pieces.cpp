// Divides an arc into pieces that a control can read.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "compensation/plan/arc_fit.hpp"
#include "compensation/plan/knots.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr int most_halvings = 2 * first_halvings;

// The way of a piece about the centre (rad) without the full turns that the last one makes.
double one_turn_of(const ArcTask& task, double u0, double u1) {
  const int turns = u1 == 1 && !task.move.arc->flat ? task.move.arc->turns : 0;
  return (u1 - u0) * task.source.arc->sweep - 2 * std::numbers::pi * turns;
}

// Whether the words of an arc can express the piece between two fractions at all: no piece but the last
// makes the full turns of its block, and that one has to.
bool can_be_one(const ArcTask& task, double u0, double u1) {
  constexpr double turn = 2 * std::numbers::pi, rounding = 1e-9;
  const double sweep = one_turn_of(task, u0, u1);
  return sweep > 0 && sweep < turn + rounding;
}

// Whether a piece that is rewritten must not be one arc: a small shift of its end could turn a full
// circle into nothing, or an R near half a turn into none at all. Of 36 runs, 300 and 350 degrees for a full
// circle: 2 texts and 1, 14 lines more and 2 less; other shares of the chord and other angles for R: none.
bool must_halve(const ArcTask& task, double u0, double u1) {
  constexpr double degree = std::numbers::pi / 180;
  const Arc& arc = *task.source.arc;
  const double sweep = one_turn_of(task, u0, u1), size = radius_at(arc, task.source.start);
  Vector3 chord = point_at(task.source, u1) - point_at(task.source, u0);
  chord -= chord.dot(arc.normal) * arc.normal;
  if (sweep > 330 * degree || (sweep > 180 * degree && chord.norm() < 0.1 * size)) return true;
  return task.move.arc->radius_word && sweep > 150 * degree && sweep < 210 * degree;
}

// Divides from the start on; what follows a piece begins where the text holds the tool behind it.
class ArcDivider {
 public:
  ArcDivider(const ArcTask& task, const TextPosition& from) : task_(task), held_(from) {}

  ArcPieces run() {
    divide(task_.begin, task_.end, 0);
    if (chords_) put_chords(task_.end);
    result_.held = held_;
    return std::move(result_);
  }

 private:
  // Of a piece that no arc fits yet, from where it begins.
  struct Chords {
    double u0;
    TextPosition from;
  };

  struct Division {
    double u;
    bool counts;  // as one of the halvings
  };

  void divide(double u0, double u1, int halvings) {
    if (const auto fit = fitting(u0, u1)) return put_arc(u0, u1, *fit);
    const Division division = division_of(u0, u1);
    if (division.counts && ++halvings > first_halvings && !is_worth_halving(u0, u1, halvings))
      return leave_to_chords(u0, u1);
    divide(u0, division.u, halvings);
    divide(division.u, u1, halvings);
  }

  // At the height where the text holds the tool, else, where the block takes no word for it, at the middle of
  // the heights of the piece.
  std::optional<FittedArc> fitting(double u0, double u1) const {
    if (task_.move.polar && u0 == 0 && u1 == 1)
      if (auto fit = fitting_as_polar()) return fit;
    if (!can_be_one(task_, u0, u1)) return std::nullopt;
    if (auto fit = fitting_from(held_, u0, u1)) return fit;
    if (!task_.move.arc->flat) return std::nullopt;
    const Vector3 step_mm = middle_height(u0, u1);
    TextPosition raised = held_;
    const Curve step = as_written(task_.move, held_, {step_mm}, false, task_.options);
    const auto normal = task_.move.arc->normal;
    raised[normal] = step.end[normal];
    auto fit = fitting_from(raised, u0, u1);
    if (fit) fit->step_mm = step_mm;
    return fit;
  }

  // What only polar words can express is kept wherever it is good enough.
  std::optional<FittedArc> fitting_as_polar() const {
    const bool only_polar = task_.move.arc->turns > 0 || !stays_flat(task_.move);
    const double room_mm = (only_polar ? 1 : small_share) * task_.tolerance_mm;
    FittedArc fit = fit_polar_arc(task_, held_);
    if (!fit.sound || fit.miss_mm > room_mm) return std::nullopt;
    return fit;
  }

  // Above or below where the text holds the tool.
  Vector3 middle_height(double u0, double u1) const {
    const int normal = task_.move.arc->normal;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k <= samples_of_piece; ++k) {
      const double height = task_.commanded(u0 + (u1 - u0) * k / samples_of_piece)[normal];
      low = std::min(low, height);
      high = std::max(high, height);
    }
    Vector3 p = *held_.place_mm();
    p[normal] = (low + high) / 2;
    return p;
  }

  std::optional<FittedArc> fitting_from(const TextPosition& from, double u0, double u1) const {
    const ArcPiece piece{u0, u1, from};
    FittedArc fit = fit_arc(task_, piece);
    if (!fit.sound || fit.miss_mm > task_.tolerance_mm) return std::nullopt;
    if (!keeps_turn_limits(task_, piece, fit.read)) return std::nullopt;
    const bool stays = u0 == 0 && u1 == 1 && keeps_words(task_, piece, fit.read);
    if (!stays && must_halve(task_, u0, u1)) return std::nullopt;
    return fit;
  }

  // An arc, and of a flat one the line to its height, are two blocks: fewer than the chords of half the
  // piece.
  bool is_worth_halving(double u0, double u1, int halvings) const {
    if (halvings > most_halvings) return false;
    const Arc& arc = *task_.source.arc;
    const double size = (task_.source.start - arc.centre).norm(),
                 chord = std::sqrt(8 * task_.tolerance_mm / size);
    return (u1 - u0) / 2 * arc.sweep > 2 * chord;
  }

  // At the corner that is nearest the middle, else there. Corners that words may round to an end do not
  // count. Full turns are left to the last piece. What cannot be one arc is two, and of the same length.
  Division division_of(double u0, double u1) const {
    const double sweep = task_.source.arc->sweep;
    if (const int turns = task_.move.arc->turns; turns > 0 && u0 == 0 && u1 == 1)
      return {(sweep - 2 * std::numbers::pi * turns) / 2 / sweep, false};
    const double middle = (u0 + u1) / 2;
    const bool half_turn_at_most = (u1 - u0) * sweep < std::numbers::pi * (1 + 1e-9);
    if (!can_be_one(task_, u0, u1) || must_halve(task_, u0, u1)) return {middle, half_turn_at_most};
    const double margin = 2 * rounding_allowance(task_.move, task_.options) / mm / length(task_.source);
    std::optional<double> best;
    for (const double corner : task_.corners) {
      if (corner < u0 + margin || corner > u1 - margin) continue;
      if (!best || std::abs(corner - middle) < std::abs(*best - middle)) best = corner;
    }
    return {best.value_or(middle), !best && half_turn_at_most};
  }

  void put_arc(double u0, double u1, FittedArc fit) {
    if (chords_) {
      put_chords(u0);
      const auto refit = fitting(u0, u1);  // from where the chords really end
      if (!refit) return leave_to_chords(u0, u1);
      fit = *refit;
    }
    if (fit.step_mm) put({*fit.step_mm}, u0, end_of({*fit.step_mm}, u0));
    put(fit.via, u1, fit.read.end);
  }

  void leave_to_chords(double u0, double u1) {
    if (!chords_) chords_ = Chords{u0, held_};
    held_.set(end_of({task_.commanded(u1)}, u1));
  }

  void put_chords(double u1) {
    held_ = chords_->from;
    if (task_.chord_room_mm <= 0) {
      result_.lack_digits = true;
    } else {
      if (task_.move.arc->flat) put_height(chords_->u0);
      // Knots are judged at sixteenths of the way between them, which must not be whole turns.
      const double turns = (u1 - chords_->u0) * task_.source.arc->sweep / (2 * std::numbers::pi);
      const int parts = std::max(1, static_cast<int>(std::ceil(turns - 1e-9)));
      double begin = chords_->u0;
      for (int k = 1; k <= parts; ++k) {
        const double end = k == parts ? u1 : chords_->u0 + (u1 - chords_->u0) * k / parts;
        put_chords_between(begin, end);
        begin = end;
      }
    }
    chords_.reset();
  }

  // A flat arc may have left the tool above or below the place where chords begin.
  void put_height(double u) {
    const int normal = task_.move.arc->normal;
    Vector3 p = *held_.place_mm();
    const double height = task_.commanded(u)[normal], off_mm = std::abs(height - p[normal]);
    if (off_mm <= rounding_allowance(task_.move, task_.options) / mm) return;
    p[normal] = height;
    put({p}, u, end_of({p}, u));
  }

  void put_chords_between(double u0, double u1) {
    const CorrectionAt commanded = [this](double u) {
      Correction place = Correction::Zero();
      place.head<3>() = task_.commanded(u);
      return place;
    };
    std::vector<double> corners = task_.corners;
    corners.insert(corners.end(), task_.waves.begin(), task_.waves.end());
    for (const double u : choose_knots(commanded, u0, u1, corners, task_.chord_room_mm)) {
      const Via via{task_.commanded(u)};
      put(via, u, end_of(via, u));
    }
  }

  Vector3 end_of(const Via& via, double u) const {
    return as_written(task_.move, held_, via, u == 1, task_.options).end;
  }

  void put(Via via, double u, const Vector3& end) {
    if (task_.move.orientation) via.orientation = task_.turned(u);
    result_.vias.push_back(std::move(via));
    held_.set(end);
  }

  const ArcTask& task_;
  TextPosition held_;
  std::optional<Chords> chords_;  // not yet put: the piece behind them may be left to chords, too
  ArcPieces result_;
};

}  // namespace

ArcPieces divide_arc(const ArcTask& task, const TextPosition& from) {
  return ArcDivider(task, from).run();
}

}  // namespace counterflex
