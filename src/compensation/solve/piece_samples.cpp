#include "compensation/solve/piece_samples.hpp"

#include <algorithm>
#include <cmath>

#include "compensation/plan/places.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/corner_way.hpp"
#include "compensation/solve/failures.hpp"
#include "compensation/tuning.hpp"

namespace counterflex {
namespace {

constexpr std::size_t no_sample = static_cast<std::size_t>(-1);

// Of an eighth of a stretch, at most, to find a corner: 0.6 µm on 5 mm.
constexpr int most_corner_halvings = 10;

// Between two neighbouring places of a piece: samples at its ends and in its middle.
struct Stretch {
  std::size_t piece;
  double v0, v1;
  std::size_t a, b = no_sample, m = no_sample;
  std::size_t closer = no_sample;  // the first of the samples between its eighths
  double bend = 0;                 // of the tip, at most, where the middle is not sampled (m)
};

// Samples in progress.
struct Slice : PieceSamples {
  const Job& job;
  const Questions& questions;
  PlaceSolver& solver;
  const Vector3 judged;  // axes of M
  ForceCursor cursor{};
  std::vector<Stretch> stretches{};
  SegmentPlaces places_inside{};  // of the segment `places_of`
  std::size_t places_of = no_segment;
  std::size_t end = no_sample;  // pieces from this one on have no valid answers: it fails

  Slice(const Job& of, const Questions& asked, PlaceSolver& by)
      : job(of), questions(asked), solver(by), judged(controlled_axes(of.model.mechanism)) {}

  TipPosition wanted_at(const SampledPiece& sampled, double u) const {
    return counterflex::wanted_at(job, *sampled.piece, u, *sampled.model);
  }

  // Position error of the tip in the axes in which it is judged (m), and its tilt by its lever (m).
  Vector6 miss(std::size_t s) const {
    Vector6 miss = Vector6::Zero();
    miss.head<3>() = (answers[s].X_MT.p - places[s].p_MT).cwiseProduct(judged);
    if (const auto& R = places[s].R_MT)
      miss.tail<3>() = lever(job.options) * tilt(rotation_between(answers[s].X_MT.R, *R), R->col(2));
    return miss;
  }
};

Vector6 force_at(Slice& slice, const PieceSample& sample) {
  const SampledPiece& sampled = slice.pieces[sample.piece];
  if (sampled.segment == nullptr) return slice.job.forces.in_hole(sampled.piece->move);
  return slice.job.forces.at(sampled.piece->segment, sample.u, sample.side, slice.cursor);
}

Directions directions_of(const Slice& slice, const PieceSample& sample) {
  const Piece& piece = *slice.pieces[sample.piece].piece;
  return directions_at(slice.job, piece.move, sample.u, sample.side);
}

std::size_t add_sample(Slice& slice, const PieceSample& sample, const Vector6& F) {
  const SampledPiece& sampled = slice.pieces[sample.piece];
  slice.samples.push_back(sample);
  slice.places.push_back(slice.wanted_at(sampled, sample.u));
  ForwardRequest& request = slice.requests.emplace_back(
      ForwardRequest{sampled.model, point_at(sampled.piece->commanded, sample.v), F, {}, true});
  if (const auto& turn = sampled.piece->turn) request.R = orientation_at(*turn, sample.v);
  request.directions = directions_of(slice, sample);
  return slice.samples.size() - 1;
}

std::size_t add_sample(Slice& slice, const PieceSample& sample) {
  return add_sample(slice, sample, force_at(slice, sample));
}

std::size_t add_inside(Slice& slice, std::size_t t, double v) {
  const Piece& piece = *slice.pieces[t].piece;
  return add_sample(slice, {.piece = t, .v = v, .u = piece.u0 + v * (piece.u1 - piece.u0), .between = true});
}

// Whether the end of the piece before, which was added last, is the start of this one, with the same force.
bool is_where_the_last_ended(Slice& slice, const SampledPiece& sampled) {
  if (slice.samples.empty() || slice.samples.back().between) return false;
  const SampledPiece& last = slice.piece_of(slice.samples.size() - 1);
  const Piece &piece = *sampled.piece, &before = *last.piece;
  const TipPosition start = slice.wanted_at(sampled, piece.u0);
  if (last.model != sampled.model || slice.places.back().p_MT != start.p_MT ||
      slice.places.back().R_MT != start.R_MT)
    return false;
  if (!(slice.requests.back().directions ==
        directions_at(slice.job, sampled.segment->move, piece.u0, Side::after)))
    return false;
  const bool follows = before.segment + 1 == piece.segment && before.u1 == 1 && piece.u0 == 0;
  if (follows && slice.job.forces.follows(piece.segment)) return true;
  return slice.requests.back().F == slice.job.forces.at(piece.segment, piece.u0, Side::after, slice.cursor);
}

// Without a blend the force may begin with a step. No end of a piece before shows it either.
std::size_t add_start(Slice& slice, std::size_t t) {
  const SampledPiece& sampled = slice.pieces[t];
  const bool listed = sampled.starts_at_place || sampled.begins_elsewhere || slice.job.options.blend == 0 ||
                      slice.questions.bands;
  if (!listed && is_where_the_last_ended(slice, sampled)) return slice.samples.size() - 1;
  return add_sample(slice, {.piece = t,
                            .v = 0,
                            .u = sampled.piece->u0,
                            .between = true,
                            .place = sampled.starts_at_place,
                            .listed = listed,
                            .side = Side::after});
}

// The other side of a step of the force, or of a reversal; the same sample without either.
std::size_t add_behind_step(Slice& slice, std::size_t before) {
  PieceSample behind = slice.samples[before];
  behind.side = Side::after;
  if (!(directions_of(slice, behind) == slice.requests[before].directions)) return add_sample(slice, behind);
  if (slice.job.options.blend > 0) return before;
  const std::size_t segment = slice.pieces[behind.piece].piece->segment;
  if (slice.job.forces.at(segment, behind.u, Side::after, slice.cursor) == slice.requests[before].F)
    return before;
  return add_sample(slice, behind);
}

// By how much the tip bends between the sample `start`, at fraction `u0`, and `end` at most, while its
// command goes straight (m). `F_end`: at the end. The sample may be shared with the segment before, of which
// it is the end.
double bend_between(Slice& slice, std::size_t start, double u0, const PieceSample& end,
                    const Vector6& F_end) {
  const SampledPiece& sampled = slice.pieces[end.piece];
  if (sampled.piece->commanded.arc) return HUGE_VAL;
  if (const auto& bend = slice.places_inside.bend) return 2 * *bend;
  const ForceChord along{sampled.piece->segment, u0, end.u, slice.requests[start].F, F_end};
  const LineBend bend = bend_of(slice.job, slice.solver, along, {}, slice.cursor);
  return bend.gain * bend.command;
}

// At the places of the original path inside the piece, and at its end; in the middle between neighbouring
// ones where the bend between them is not small.
void add_samples(Slice& slice, std::size_t t) {
  const SampledPiece sampled = slice.pieces[t];
  const Piece& piece = *sampled.piece;
  const std::vector<double>& fractions = slice.places_inside.fractions;
  if (sampled.segment != nullptr && slice.places_of != piece.segment) {
    places_along(slice.job, slice.solver, piece.segment, slice.cursor, slice.places_inside);
    slice.places_of = piece.segment;
  }
  const bool ends_at_place = sampled.segment == nullptr || std::ranges::binary_search(fractions, piece.u1);
  const PieceSample end{.piece = t, .v = 1, .u = piece.u1, .place = ends_at_place};
  if (!slice.questions.inside || piece.end_only) {
    if (sampled.starts_at_place) add_start(slice, t);
    add_sample(slice, end);
    return;
  }
  const double span = piece.u1 - piece.u0;
  Stretch stretch{t, 0, 0, add_start(slice, t)};
  auto next = std::ranges::upper_bound(fractions, piece.u0);
  for (bool last = false; !last; ++next) {
    last = *next >= piece.u1;
    stretch.v1 = last ? 1 : (*next - piece.u0) / span;
    const PieceSample at_end =
        last ? end : PieceSample{.piece = t, .v = stretch.v1, .u = *next, .between = true, .place = true};
    const Vector6 F = force_at(slice, at_end);
    stretch.bend = bend_between(slice, stretch.a, piece.u0 + stretch.v0 * span, at_end, F);
    const bool bounded = stretch.bend <= near_share * slice.job.options.tolerance;
    stretch.m = bounded ? no_sample : add_inside(slice, t, (stretch.v0 + stretch.v1) / 2);
    stretch.b = add_sample(slice, at_end, F);
    slice.stretches.push_back(stretch);
    stretch.v0 = stretch.v1;
    if (!last) stretch.a = add_behind_step(slice, stretch.b);
  }
}

// Whether a feed piece begins a feed run, or under another force, motion or tool than the path before it
// ended.
bool starts_at_place(const Job& job, const Piece& piece) {
  const Segment& segment = job.path.segments[piece.segment];
  if (!segment.cutting) return false;
  const bool inside = piece.u0 > 0;
  if (!inside && job.forces.begins_run(piece.segment)) return true;
  if (job.options.blend == 0) {
    const auto at = [&](Side side) { return job.forces.at(piece.segment, piece.u0, side); };
    if (inside ? at(Side::before) != at(Side::after) : job.forces.begins_with_step(piece.segment))
      return true;
  }
  if (job.directions != nullptr) {
    const Directions before =
        inside ? directions_at(job, piece.move, piece.u0, Side::before) : job.directions->before(piece.move);
    if (!(before == directions_at(job, piece.move, piece.u0, Side::after))) return true;
  }
  const Move* last = inside || job.tools == nullptr ? nullptr : move_before(job.program, piece.move);
  return last != nullptr && &model_with(job.model, job.tools, last->tool) != &model_of(job, piece.move);
}

void add_pieces(Slice& slice, std::span<const Piece> pieces, const std::optional<Vector3>& command) {
  const Vector3* last = command ? &*command : nullptr;
  slice.pieces.reserve(pieces.size());
  slice.samples.reserve(2 * pieces.size());
  slice.places.reserve(2 * pieces.size());
  slice.requests.reserve(2 * pieces.size());
  for (const Piece& piece : pieces) {
    const bool position = piece.segment == no_segment;
    slice.pieces.push_back({.piece = &piece,
                            .segment = position ? nullptr : &slice.job.path.segments[piece.segment],
                            .model = &model_of(slice.job, piece.move),
                            .begins_elsewhere = last == nullptr || *last != piece.commanded.start,
                            .starts_at_place = !position && starts_at_place(slice.job, piece)});
    last = &piece.commanded.end;
    add_samples(slice, slice.pieces.size() - 1);
  }
}

// Tasks behind the first that fails are left out from then on.
void solve_added(Slice& slice) {
  const std::size_t first = slice.answers.size(), count = slice.samples.size();
  slice.wanted.resize(count);
  slice.answers.resize(count);
  slice.solver.wanted(std::span(slice.places).subspan(first), std::span(slice.wanted).subspan(first));
  slice.solver.forwards(std::span(slice.requests).subspan(first), std::span(slice.answers).subspan(first));
  for (std::size_t s = first; s < count; ++s) {
    if (slice.status(s) == Status::converged) continue;
    slice.samples[s].listed = true;
    slice.end = std::min(slice.end, slice.samples[s].piece);
  }
}

// Where the ends come too near to the tolerance for the bend between them, the middle is sampled.
void sample_middles(Slice& slice) {
  for (Stretch& stretch : slice.stretches) {
    if (stretch.m != no_sample || stretch.piece >= slice.end) continue;
    const double inside = std::max(slice.miss(stretch.a).norm(), slice.miss(stretch.b).norm()) + stretch.bend;
    if (inside > near_share * slice.job.options.tolerance)
      stretch.m = add_inside(slice, stretch.piece, (stretch.v0 + stretch.v1) / 2);
  }
}

void sample_closer(Slice& slice) {
  const double tolerance = slice.job.options.tolerance;
  for (Stretch& stretch : slice.stretches) {
    if (stretch.m == no_sample || stretch.piece >= slice.end) continue;
    const Vector6 a = slice.miss(stretch.a), m = slice.miss(stretch.m), b = slice.miss(stretch.b);
    const auto [least, most] = std::minmax({a.norm(), m.norm(), b.norm()});
    // All of it above the tolerance is compared with bands, which change slowly.
    const bool is_far =
        most <= near_share * tolerance || (slice.job.options.only_significant && least > tolerance);
    // What bends to one side and then to the other crosses the middle of its chord.
    const bool waves = may_wave(slice.pieces[stretch.piece].model->mechanism);
    const bool is_safe = is_far && !waves && (m - (a + b) / 2).norm() <= small_share * tolerance;
    for (int k = 0; k < eighths && !is_safe; ++k) {
      const double share = (2 * k + 1) / (2.0 * eighths);
      const std::size_t s = add_inside(slice, stretch.piece, stretch.v0 + share * (stretch.v1 - stretch.v0));
      if (k == 0) stretch.closer = s;
    }
  }
}

// Samples in order along a stretch. The first one may belong to the segment before.
struct Row {
  std::size_t piece;
  std::vector<double> v;
  std::vector<std::size_t> samples;
};

Row row_of(const Slice& slice, const Stretch& stretch) {
  Row row{stretch.piece, {stretch.v0}, {stretch.a}};
  const auto add = [&](double v, std::size_t s) {
    row.v.push_back(v);
    row.samples.push_back(s);
  };
  for (std::size_t k = 0; k < eighths; ++k) {
    if (k == eighths / 2) add(slice.samples[stretch.m].v, stretch.m);
    add(slice.samples[stretch.closer + k].v, stretch.closer + k);
  }
  add(stretch.v1, stretch.b);
  return row;
}

// Adds middles on both sides of each sample that is off the chord of its neighbours. A corner between two
// samples is off their chord by at most twice as much as the farther of them. Returns whether it added some.
bool add_middles(Slice& slice, Row& row) {
  const std::size_t count = row.samples.size();
  std::vector<Vector6> misses;
  misses.reserve(count);
  double most = small_share * slice.job.options.tolerance;
  for (const std::size_t s : row.samples) {
    misses.push_back(slice.miss(s));
    most = std::max(most, misses.back().norm());
  }
  std::vector<bool> bends(count);  // between a sample and the next
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double w = (row.v[k] - row.v[k - 1]) / (row.v[k + 1] - row.v[k - 1]);
    const double off = (misses[k] - (1 - w) * misses[k - 1] - w * misses[k + 1]).norm();
    if (off > curve_share * most) bends[k - 1] = bends[k] = true;
  }
  Row closer{row.piece, {}, {}};
  for (std::size_t k = 0; k < count; ++k) {
    closer.v.push_back(row.v[k]);
    closer.samples.push_back(row.samples[k]);
    if (!bends[k]) continue;
    const double v = (row.v[k] + row.v[k + 1]) / 2;
    closer.v.push_back(v);
    closer.samples.push_back(add_inside(slice, row.piece, v));
  }
  std::swap(row, closer);
  return row.samples.size() > count;
}

// Where the load of a joint passes its knee the miss has a corner.
void sample_corners(Slice& slice) {
  std::vector<Row> rows;
  for (const Stretch& stretch : slice.stretches)
    if (stretch.closer != no_sample && slice.pieces[stretch.piece].model->mechanism.has_knees)
      rows.push_back(row_of(slice, stretch));
  for (int halvings = 0; halvings < most_corner_halvings && !rows.empty(); ++halvings) {
    std::vector<Row> bent;
    for (Row& row : rows)
      if (row.piece < slice.end && add_middles(slice, row)) bent.push_back(std::move(row));
    rows = std::move(bent);
    solve_added(slice);
  }
}

// Whether the control puts a rounding or a chamfer between two pieces, one behind the other.
bool meet_at_corner(const Job& job, const Piece& before, const Piece& after) {
  const auto& corners = job.program.moves[before.move].corners;
  const bool is_behind = corners && corners->end_mm > 0 && after.move == before.move + 1;
  return is_behind && before.segment != no_segment && after.segment == before.segment + 1 &&
         !before.end_only && !after.end_only;
}

// On what the control puts into the corner between piece `t` and `after`. These samples belong to piece `t`.
// The first half is under the forces beside the end of that piece, the second half under those beside the
// start of `after`.
void add_corner(Slice& slice, std::size_t t, const Piece& after) {
  const SampledPiece& before = slice.pieces[t];
  const Curve &line = before.segment->wanted, &next = slice.job.path.segments[after.segment].wanted;
  const auto ways = corner_ways({line, before.piece->commanded}, {next, after.commanded},
                                slice.job.program.moves[before.piece->move].corners->end_size);
  if (!ways) return;
  const Curve& wanted = ways->wanted;
  const double taken = std::min(1.0, (line.end - wanted.start).norm() / length(line)),
               taken_behind = std::min(1.0, (wanted.end - next.start).norm() / length(next));
  const int steps =
      static_cast<int>(std::clamp(std::ceil(length(wanted) / between_places), 2.0 * eighths, 8.0 * eighths));
  const double u0 = before.piece->u0;
  for (int k = 0; k <= steps; ++k) {
    const double w = static_cast<double>(k) / steps;
    const bool is_behind = w > 0.5;
    const double u = is_behind ? (2 * w - 1) * taken_behind : 1 - (1 - 2 * w) * taken,
                 u_of_sample = 1 - taken * (1 - static_cast<double>(k) / (steps + 1));
    const Piece& beside = is_behind ? after : *before.piece;
    const Side side = is_behind ? Side::after : Side::before;
    add_sample(slice,
               {.piece = t,
                .v = std::max(0.0, (u_of_sample - u0) / (1 - u0)),
                .u = u_of_sample,
                .between = true,
                .corner_direction = direction_at(wanted, w)},
               slice.job.forces.at(beside.segment, u, side, slice.cursor));
    slice.places.back().p_MT = point_at(wanted, w);
    slice.requests.back().target = point_at(ways->commanded, w);
    slice.requests.back().directions = directions_at(slice.job, beside.move, u, side);
  }
}

void add_corners(Slice& slice, const Piece* next) {
  if (!slice.questions.inside) return;
  for (std::size_t t = 0; t < slice.pieces.size(); ++t) {
    const Piece* after = t + 1 < slice.pieces.size() ? slice.pieces[t + 1].piece : next;
    if (after != nullptr && meet_at_corner(slice.job, *slice.pieces[t].piece, *after))
      add_corner(slice, t, *after);
  }
}

// Listed samples in order along the path, to the first that fails.
std::vector<std::size_t> listed_samples(const Slice& slice) {
  std::vector<std::size_t> order;
  order.reserve(slice.samples.size());
  for (std::size_t s = 0; s < slice.samples.size(); ++s)
    if (slice.samples[s].listed && (slice.end == no_sample || slice.samples[s].piece <= slice.end))
      order.push_back(s);
  const auto before = [&](std::size_t a, std::size_t b) {
    const PieceSample &x = slice.samples[a], &y = slice.samples[b];
    return x.piece != y.piece ? x.piece < y.piece : x.v < y.v;
  };
  if (!std::ranges::is_sorted(order, before)) std::ranges::stable_sort(order, before);
  const auto fails = [&](std::size_t s) { return slice.status(s) != Status::converged; };
  if (const auto first = std::ranges::find_if(order, fails); first != order.end())
    order.erase(first + 1, order.end());
  return order;
}

}  // namespace

PieceSamples sample_pieces(const Job& job, PlaceSolver& solver, std::span<const Piece> pieces,
                           const Questions& questions, const std::optional<Vector3>& command,
                           const Piece* next) {
  Slice slice(job, questions, solver);
  add_pieces(slice, pieces, command);
  add_corners(slice, next);
  solve_added(slice);
  sample_middles(slice);
  solve_added(slice);
  sample_closer(slice);
  solve_added(slice);
  sample_corners(slice);
  slice.order = listed_samples(slice);
  return std::move(static_cast<PieceSamples&>(slice));
}

}  // namespace counterflex
