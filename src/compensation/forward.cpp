// Solves pieces forward, slice by slice: first the samples of all pieces, then closer ones where they are
// needed.
#include <algorithm>
#include <iterator>

#include "attribution.hpp"
#include "commands.hpp"
#include "failures.hpp"
#include "parallel.hpp"
#include "places.hpp"

namespace counterflex {
namespace {

constexpr int odd_sixteenths = 8;
constexpr double straight_share = 0.1;  // of the tolerance: a stretch that bends more is sampled closer
constexpr double near_share = 0.8;      // of the tolerance: so is one that comes so near to it

struct PieceTask {
  const Piece* piece = nullptr;
  const Segment* segment = nullptr;  // none: a position
  const Model* model = nullptr;
  bool begins_elsewhere = false;  // the piece before it ended elsewhere
  bool begins_run = false;        // its start is a place of the original path
};

// A place on a piece: fraction `v` of the piece, `u` of the segment.
struct ForwardSample {
  std::size_t task = 0;
  double v = 1, u = 1;
  bool between = false;
  bool place = false;  // of the original path
  bool listed = true;
  Side side = Side::before;  // of a step of the force
};

constexpr std::size_t no_sample = static_cast<std::size_t>(-1);

// Between two neighbouring places of a piece: samples at its ends and in its middle.
struct Stretch {
  std::size_t task;
  double v0, v1;
  std::size_t a, b = no_sample, m = no_sample;
  double bend = 0;  // of the tip, at most, where the middle is not sampled (m)
};

// Samples of a slice of pieces. Requests and answers are by sample.
struct Slice {
  const Job& job;
  const Questions& questions;
  PlaceSolver solver;
  Vector3 judged = Vector3::Zero();  // 1 for axes of M in which the tip is judged, else 0
  ForceCursor cursor{};
  std::vector<PieceTask> tasks{};
  std::vector<ForwardSample> samples{};
  std::vector<TipPosition> places{};
  std::vector<ForwardRequest> requests{};
  std::vector<WantedPose> wanted{};
  std::vector<ForwardAnswer> answers{};
  std::vector<Stretch> stretches{};
  std::vector<double> fractions{};  // places of the segment `fractions_of`
  std::size_t fractions_of = no_segment;
  std::size_t end = no_sample;  // tasks from this one on have no valid answers: it fails

  const Piece& piece(std::size_t task) const { return *tasks[task].piece; }
  Vector3 wanted_at(const PieceTask& task, double u) const {
    return task.segment != nullptr ? point_at(task.segment->wanted, u) : task.piece->wanted;
  }

  // Position error of the tip in the axes in which it is judged (m).
  Vector3 miss(std::size_t s) const { return (answers[s].X_MT.p - places[s].p_MT).cwiseProduct(judged); }

  Status status(std::size_t s) const {
    return wanted[s].status != Status::converged ? wanted[s].status : answers[s].status;
  }
};

Vector6 force_at(Slice& slice, const ForwardSample& sample) {
  if (slice.tasks[sample.task].segment == nullptr) return Vector6::Zero();
  return slice.job.forces.at(slice.piece(sample.task).segment, sample.u, sample.side, slice.cursor);
}

std::size_t add_sample(Slice& slice, const ForwardSample& sample, const Vector6& F) {
  const PieceTask& task = slice.tasks[sample.task];
  slice.samples.push_back(sample);
  slice.places.push_back({task.model, slice.wanted_at(task, sample.u)});
  slice.requests.push_back({task.model, point_at(task.piece->commanded, sample.v), F, {}, true});
  return slice.samples.size() - 1;
}

std::size_t add_sample(Slice& slice, const ForwardSample& sample) {
  return add_sample(slice, sample, force_at(slice, sample));
}

std::size_t add_inside(Slice& slice, std::size_t t, double v) {
  const Piece& piece = slice.piece(t);
  return add_sample(slice, {.task = t, .v = v, .u = piece.u0 + v * (piece.u1 - piece.u0), .between = true});
}

// Whether the end of the piece before, which was added last, is the start of this one, with the same force.
bool is_where_the_last_ended(Slice& slice, const PieceTask& task) {
  if (slice.samples.empty() || slice.samples.back().between) return false;
  const PieceTask& last = slice.tasks[slice.samples.back().task];
  const Piece &piece = *task.piece, &before = *last.piece;
  if (last.model != task.model || slice.places.back().p_MT != slice.wanted_at(task, piece.u0)) return false;
  const bool follows = before.segment + 1 == piece.segment && before.u1 == 1 && piece.u0 == 0;
  if (follows && slice.job.forces.follows(piece.segment)) return true;
  return slice.requests.back().F == slice.job.forces.at(piece.segment, piece.u0, Side::after, slice.cursor);
}

// Without a blend the force may begin with a step. No end of a piece before shows it either.
std::size_t add_start(Slice& slice, std::size_t t) {
  const PieceTask& task = slice.tasks[t];
  const bool listed = task.begins_run || task.begins_elsewhere || slice.job.options.blend == 0;
  if (!listed && is_where_the_last_ended(slice, task)) return slice.samples.size() - 1;
  return add_sample(slice, {.task = t,
                            .v = 0,
                            .u = task.piece->u0,
                            .between = true,
                            .place = task.begins_run,
                            .listed = listed,
                            .side = Side::after});
}

// The other side of a step of the force; the same sample where there is no_sample.
std::size_t add_behind_step(Slice& slice, std::size_t before) {
  if (slice.job.options.blend > 0) return before;
  ForwardSample behind = slice.samples[before];
  behind.place = false;
  behind.side = Side::after;
  const std::size_t segment = slice.piece(behind.task).segment;
  if (slice.job.forces.at(segment, behind.u, Side::after, slice.cursor) == slice.requests[before].F)
    return before;
  return add_sample(slice, behind);
}

// By how much the tip bends between the sample `start`, at fraction `u0`, and `end` at most, while its
// command goes straight (m). `F_end`: at the end. The sample may be shared with the segment before, of which
// it is the end.
double bend_between(Slice& slice, std::size_t start, double u0, const ForwardSample& end,
                    const Vector6& F_end) {
  const PieceTask& task = slice.tasks[end.task];
  if (task.segment->wanted.arc || task.piece->commanded.arc) return HUGE_VAL;
  const ForceChord along{task.piece->segment, u0, end.u, slice.requests[start].F, F_end};
  const std::vector<Vector6> dF = force_bends(slice.job, along, {}, slice.cursor);
  const LineBend bend = slice.solver.bend_along(
      *task.model, {slice.places[start].p_MT, slice.wanted_at(task, end.u), along.F0, along.F1, dF});
  return bend.gain * bend.command;
}

// At the places of the original path inside the piece, and at its end; in the middle between neighbouring
// ones where the bend between them is not small.
void add_samples(Slice& slice, std::size_t t) {
  const PieceTask task = slice.tasks[t];
  const Piece& piece = *task.piece;
  if (task.segment != nullptr && slice.fractions_of != piece.segment) {
    places_along(slice.job, piece.segment, slice.cursor, slice.fractions);
    slice.fractions_of = piece.segment;
  }
  const bool ends_at_place = task.segment != nullptr && std::ranges::binary_search(slice.fractions, piece.u1);
  const ForwardSample end{.task = t, .v = 1, .u = piece.u1, .place = ends_at_place};
  if (!slice.questions.inside || piece.end_only) {
    if (slice.questions.before && task.begins_run) add_start(slice, t);
    add_sample(slice, end);
    return;
  }
  const double span = piece.u1 - piece.u0;
  Stretch stretch{t, 0, 0, add_start(slice, t)};
  auto next = std::ranges::upper_bound(slice.fractions, piece.u0);
  for (bool last = false; !last; ++next) {
    last = *next >= piece.u1;
    stretch.v1 = last ? 1 : (*next - piece.u0) / span;
    const ForwardSample at_end =
        last ? end : ForwardSample{.task = t, .v = stretch.v1, .u = *next, .between = true, .place = true};
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

const Model& model_of(const Job& job, const Piece& piece) {
  if (job.tools == nullptr || job.tools->empty()) return job.model;
  return piece.segment == no_segment ? model_with(job.model, job.tools, piece.tool)
                                     : model_of(job, job.path.segments[piece.segment]);
}

void add_pieces(Slice& slice, std::span<const Piece> pieces, const std::optional<Vector3>& command) {
  const Vector3* last = command ? &*command : nullptr;
  slice.tasks.reserve(pieces.size());
  for (const Piece& piece : pieces) {
    const bool position = piece.segment == no_segment;
    slice.tasks.push_back(
        {.piece = &piece,
         .segment = position ? nullptr : &slice.job.path.segments[piece.segment],
         .model = &model_of(slice.job, piece),
         .begins_elsewhere = last == nullptr || *last != piece.commanded.start,
         .begins_run = !position && piece.u0 == 0 && slice.job.forces.begins_run(piece.segment)});
    last = &piece.commanded.end;
    add_samples(slice, slice.tasks.size() - 1);
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
    slice.end = std::min(slice.end, slice.samples[s].task);
  }
}

// Where the ends come too near to the tolerance for the bend between them, the middle is sampled.
void sample_middles(Slice& slice) {
  for (Stretch& stretch : slice.stretches) {
    if (stretch.m != no_sample || stretch.task >= slice.end) continue;
    const double inside = std::max(slice.miss(stretch.a).norm(), slice.miss(stretch.b).norm()) + stretch.bend;
    if (inside > near_share * slice.job.options.tolerance)
      stretch.m = add_inside(slice, stretch.task, (stretch.v0 + stretch.v1) / 2);
  }
}

void sample_closer(Slice& slice) {
  const double tolerance = slice.job.options.tolerance;
  for (const Stretch& stretch : slice.stretches) {
    if (stretch.m == no_sample || stretch.task >= slice.end) continue;
    const Vector3 a = slice.miss(stretch.a), m = slice.miss(stretch.m), b = slice.miss(stretch.b);
    const bool is_safe = (m - (a + b) / 2).norm() <= straight_share * tolerance &&
                         std::max({a.norm(), m.norm(), b.norm()}) <= near_share * tolerance;
    for (int k = 0; k < odd_sixteenths && !is_safe; ++k) {
      const double share = (2 * k + 1) / (2.0 * odd_sixteenths);
      add_inside(slice, stretch.task, stretch.v0 + share * (stretch.v1 - stretch.v0));
    }
  }
}

// Listed samples in order along the path, to the first that fails.
std::vector<std::size_t> listed_samples(const Slice& slice) {
  std::vector<std::size_t> order;
  order.reserve(slice.samples.size());
  for (std::size_t s = 0; s < slice.samples.size(); ++s)
    if (slice.samples[s].listed && (slice.end == no_sample || slice.samples[s].task <= slice.end))
      order.push_back(s);
  const auto before = [&](std::size_t a, std::size_t b) {
    const ForwardSample &x = slice.samples[a], &y = slice.samples[b];
    return x.task != y.task ? x.task < y.task : x.v < y.v;
  };
  if (!std::ranges::is_sorted(order, before)) std::ranges::stable_sort(order, before);
  const auto fails = [&](std::size_t s) { return slice.status(s) != Status::converged; };
  if (const auto first = std::ranges::find_if(order, fails); first != order.end())
    order.erase(first + 1, order.end());
  return order;
}

std::size_t frame_of(const PieceTask& task) {
  return task.segment != nullptr ? task.segment->frame : task.piece->frame;
}

// `share`: of the way of the piece, from the sample before.
Waypoint waypoint_of(const Slice& slice, std::size_t s, double share) {
  const ForwardSample& sample = slice.samples[s];
  const PieceTask& task = slice.tasks[sample.task];
  const Piece& piece = *task.piece;
  Waypoint w;
  w.segment = piece.segment;
  w.fraction = sample.u;
  w.line = piece.line;
  w.corrected_line = piece.corrected_line;
  w.between = sample.between;
  w.place = sample.place;
  w.exempt = sample.between ? piece.exempt : piece.exempt_end;
  w.p_MT = slice.places[s].p_MT;
  w.tool_axis = slice.wanted[s].X_MT.R.col(2);
  w.wrench = slice.requests[s].F;
  if (const Segment* segment = task.segment) {
    w.line = segment->line;
    w.cutting = segment->cutting;
    w.weight = segment->cutting ? share * (piece.u1 - piece.u0) * length(segment->wanted) : 0;
    w.s = segment->s_start + sample.u * (segment->s_end - segment->s_start);
    w.direction = direction_at(segment->wanted, sample.u);
  }
  w.status = slice.status(s);
  w.iterations = slice.answers[s].iterations;
  w.rho = slice.answers[s].rho;
  if (w.status == Status::converged) w.after = deviation(slice.answers[s].X_MT, slice.wanted[s].X_MT);
  w.correction.head<3>() = slice.requests[s].target - original_command(slice.job, frame_of(task), w.p_MT);
  return w;
}

// A waypoint weighs the way from the sample before: so the weights between two places do not
// depend on what is sampled between them.
std::vector<Waypoint> waypoints_of(const Slice& slice, const std::vector<std::size_t>& order) {
  std::vector<Waypoint> waypoints;
  waypoints.reserve(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const ForwardSample& sample = slice.samples[order[k]];
    const bool first = k == 0 || slice.samples[order[k - 1]].task != sample.task;
    waypoints.push_back(waypoint_of(slice, order[k], sample.v - (first ? 0 : slice.samples[order[k - 1]].v)));
  }
  return waypoints;
}

// What the original program does, and the causes, at the waypoints before the first that fails.
void add_questions(Slice& slice, const std::vector<std::size_t>& order, std::vector<Waypoint>& waypoints) {
  std::vector<ForwardPlace> places;
  places.reserve(order.size());
  for (const std::size_t s : order) {
    const ForwardRequest& request = slice.requests[s];
    const std::size_t frame = frame_of(slice.tasks[slice.samples[s].task]);
    places.push_back({request.model, original_command(slice.job, frame, slice.places[s].p_MT), request.target,
                      request.F, slice.wanted[s].X_MT});
  }
  const auto count = [&] {
    const auto fails = [](const Waypoint& w) { return w.status != Status::converged; };
    return static_cast<std::size_t>(std::ranges::find_if(waypoints, fails) - waypoints.begin());
  };
  if (slice.questions.before)
    add_before(slice.solver, std::span(places).first(count()), std::span(waypoints).first(count()));
  if (slice.questions.attribution)
    add_causes(slice.solver, std::span(places).first(count()), std::span(waypoints).first(count()));
  if (count() < waypoints.size()) waypoints.resize(count() + 1);
}

Failure failure_at(const Slice& slice, std::size_t s, const Waypoint& w) {
  const PieceTask& task = slice.tasks[slice.samples[s].task];
  const long tool =
      task.segment != nullptr ? slice.job.program.moves[task.segment->move].tool : task.piece->tool;
  Failure failure = status_failure(
      slice.job, w.status,
      {*task.model, slice.job.path.frames[frame_of(task)], tool, slice.requests[s].target}, w.line);
  failure.corrected_line = w.corrected_line;
  return failure;
}

ForwardRun solve_slice(const Job& job, std::span<const Piece> pieces, const Questions& questions,
                       const std::optional<Vector3>& command) {
  Slice slice{job, questions, PlaceSolver(job)};
  for (const Component c : job.model.mechanism.controlled)
    if (c <= Component::z) slice.judged[static_cast<int>(c)] = 1;
  add_pieces(slice, pieces, command);
  solve_added(slice);
  sample_middles(slice);
  solve_added(slice);
  sample_closer(slice);
  solve_added(slice);
  const std::vector<std::size_t> order = listed_samples(slice);
  ForwardRun run;
  run.waypoints = waypoints_of(slice, order);
  add_questions(slice, order, run.waypoints);
  if (!run.waypoints.empty() && run.waypoints.back().status != Status::converged)
    run.failure = failure_at(slice, order[run.waypoints.size() - 1], run.waypoints.back());
  return run;
}

// Where slices of pieces begin, and their end: each has `slice_size` pieces, or fewer with about 2048 places.
std::vector<std::size_t> slice_borders(const Job& job, std::span<const Piece> pieces,
                                       const Questions& questions) {
  constexpr double most_places = 8 * slice_size;
  std::vector<std::size_t> borders{0};
  double places = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i - borders.back() == slice_size || places >= most_places) {
      borders.push_back(i);
      places = 0;
    }
    const Piece& piece = pieces[i];
    const bool inside = questions.inside && !piece.end_only && piece.segment != no_segment;
    places += 1 + (inside ? (piece.u1 - piece.u0) * steps_along(job.path.segments[piece.segment]) : 0.0);
  }
  borders.push_back(pieces.size());
  return borders;
}

}  // namespace

std::optional<Failure> solve_in_portions(const Job& job, std::span<const Piece> pieces,
                                         const Questions& questions, const std::optional<Vector3>& command,
                                         const WaypointTaker& take) {
  const auto together =
      static_cast<std::size_t>(std::max(4, job.options.threads));  // slices: of long lines each has 30 MB
  const std::vector<std::size_t> borders = slice_borders(job, pieces, questions);
  const std::size_t count = borders.size() - 1;
  for (std::size_t first = 0; first < count; first += together) {
    std::vector<ForwardRun> runs(std::min(together, count - first));
    for_each_index(runs.size(), job.options.threads, [&](std::size_t i) {
      const std::size_t begin = borders[first + i], end = borders[first + i + 1];
      const std::optional<Vector3> last = begin == 0 ? command : pieces[begin - 1].commanded.end;
      runs[i] = solve_slice(job, pieces.subspan(begin, end - begin), questions, last);
    });
    for (ForwardRun& run : runs) {
      take(std::move(run.waypoints));
      if (run.failure) return run.failure;
    }
  }
  return std::nullopt;
}

ForwardRun solve_pieces(const Job& job, std::span<const Piece> pieces, const Questions& questions,
                        const std::optional<Vector3>& command) {
  ForwardRun all;
  all.waypoints.reserve(pieces.size() + pieces.size() / 2);
  all.failure = solve_in_portions(job, pieces, questions, command, [&](std::vector<Waypoint>&& some) {
    all.waypoints.insert(all.waypoints.end(), std::make_move_iterator(some.begin()),
                         std::make_move_iterator(some.end()));
  });
  return all;
}

}  // namespace counterflex
