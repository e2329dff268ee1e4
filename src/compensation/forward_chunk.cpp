#include "forward_chunk.hpp"

#include <algorithm>

#include "commands.hpp"
#include "sample_places.hpp"
#include "track.hpp"

namespace counterflex {
namespace {

constexpr int odd_sixteenths = 8;
constexpr double straight_share = 0.1;  // of the tolerance: a stretch that bends more is sampled closer
constexpr double near_share = 0.8;      // of the tolerance: so is one that comes so near to it

double odd_sixteenth(int k) {
  return (2 * k + 1) / (2.0 * odd_sixteenths);
}

}  // namespace

ChunkForward::ChunkForward(const Job& job, const Questions& questions, WaypointSolver& solver)
    : job_(job), questions_(questions), solver_(solver) {
  for (const Component c : solver.model().mechanism.controlled)
    if (c <= Component::z) judged_[static_cast<int>(c)] = 1;
}

std::optional<Failure> ChunkForward::solve(std::span<const Piece> pieces,
                                           const std::optional<Vector3>& command,
                                           std::vector<Waypoint>& out) {
  clear();
  begin(pieces, command);
  const std::size_t first = out.size();
  bool solved = solve_added();
  if (solved) {
    sample_closer();
    solved = solve_added();
  }
  write_waypoints(out);
  const ForwardBatch batch{places_, std::span(out).subspan(first), judged_};
  if (solved && questions_.before) add_before(solver_, batch);
  if (solved && questions_.attribution) {
    add_other_forces(solver_, batch);
    add_sources(solver_, batch);
  }
  for (std::size_t i = first; i < out.size(); ++i) {
    if (out[i].status == Status::converged) continue;
    out.resize(i + 1);
    return failure_at(i - first, out[i]);
  }
  return std::nullopt;
}

Failure ChunkForward::failure_at(std::size_t k, const Waypoint& w) const {
  const Task& task = tasks_[samples_[order_[k]].task];
  const std::size_t frame = task.segment ? task.segment->frame : task.piece->frame;
  const long tool = task.segment ? job_.program.moves[task.segment->move].tool : task.piece->tool;
  Failure failure = status_failure(
      job_, w.status, {solver_.model(), job_.path.frames[frame], tool, places_[k].emitted}, w.line);
  failure.corrected_line = w.corrected_line;
  return failure;
}

void ChunkForward::clear() {
  tasks_.clear();
  places_of_ = no_segment;
  stretches_.clear();
  samples_.clear();
  p_MT_.clear();
  requests_.clear();
  wanted_.clear();
  actuals_.clear();
}

void ChunkForward::reserve(std::size_t pieces) {
  const std::size_t samples = questions_.inside ? 2 * pieces : pieces;
  tasks_.reserve(pieces);
  samples_.reserve(samples);
  p_MT_.reserve(samples);
  requests_.reserve(samples);
  wanted_.reserve(samples);
  actuals_.reserve(samples);
}

Vector3 ChunkForward::wanted_at(const Task& task, double u) const {
  return task.segment ? point_at(task.segment->wanted, u) : task.piece->wanted;
}

// What is written is proven from the nominal configuration on; samples between its ends begin at
// their neighbour.
std::size_t ChunkForward::add(const Sample& sample) {
  const Task& task = tasks_[sample.task];
  const Piece& piece = *task.piece;
  Load load;
  if (task.segment)
    load = {job_.forces.at(piece.segment, sample.u, sample.side, cursor_), job_.forces.at_platform()};
  samples_.push_back(sample);
  p_MT_.push_back(wanted_at(task, sample.u));
  ActualRequest& request = requests_.emplace_back();
  request = {
      point_at(piece.commanded, sample.v), load, {}, sample.between ? Start::neighbour : Start::nominal};
  return samples_.size() - 1;
}

std::size_t ChunkForward::add_inside(std::size_t t, double v) {
  const Piece& piece = *tasks_[t].piece;
  return add({.task = t, .v = v, .u = piece.u0 + v * (piece.u1 - piece.u0), .between = true});
}

bool ChunkForward::solve_added() {
  const std::size_t first = actuals_.size();
  wanted_.resize(samples_.size());
  actuals_.resize(samples_.size());
  solver_.wanted(std::span(p_MT_).subspan(first), std::span(wanted_).subspan(first));
  solver_.actuals(std::span(requests_).subspan(first), std::span(actuals_).subspan(first));
  for (std::size_t i = first; i < samples_.size(); ++i)
    if (status(i) != Status::converged) return false;
  return true;
}

Status ChunkForward::status(std::size_t sample) const {
  if (wanted_[sample].status != Status::converged) return wanted_[sample].status;
  if (actuals_[sample].status != Status::converged) return actuals_[sample].status;
  return within_travel(solver_.model().mechanism, actuals_[sample].rho) ? Status::converged
                                                                        : Status::outside_travel;
}

// Position error of the tip in the axes in which it is judged (m).
Vector3 ChunkForward::miss(std::size_t sample) const {
  return (actuals_[sample].X_MT.p - p_MT_[sample]).cwiseProduct(judged_);
}

void ChunkForward::begin(std::span<const Piece> pieces, const std::optional<Vector3>& command) {
  std::optional<Vector3> last = command;
  reserve(pieces.size());
  for (const Piece& piece : pieces) {
    const bool position = piece.segment == no_segment;
    tasks_.push_back({.piece = &piece,
                      .segment = position ? nullptr : &job_.path.segments[piece.segment],
                      .begins_anew = last != piece.commanded.start,
                      .begins_run = !position && piece.u0 == 0 && job_.forces.begins_run(piece.segment)});
    last = piece.commanded.end;
    add_samples(tasks_.size() - 1);
  }
}

// At the places of the original path inside the piece, in the middle between neighbouring ones, and at its
// end.
void ChunkForward::add_samples(std::size_t t) {
  const Task task = tasks_[t];
  const Piece& piece = *task.piece;
  if (task.segment) read_places(piece);
  const Sample end{.task = t, .v = 1, .u = piece.u1, .place = task.segment && is_place(piece.u1)};
  if (!questions_.inside || piece.end_only) {
    if (questions_.before && task.begins_run) add_start(t);
    add(end);
    return;
  }
  const double span = piece.u1 - piece.u0;
  std::size_t a = add_start(t);
  double v0 = 0;
  auto next = std::upper_bound(places_along_.begin(), places_along_.end(), piece.u0);
  for (bool last = false; !last; ++next) {
    last = *next >= piece.u1;
    const double v1 = last ? 1 : (*next - piece.u0) / span;
    const std::size_t m = add_inside(t, (v0 + v1) / 2);
    const std::size_t b =
        add(last ? end : Sample{.task = t, .v = v1, .u = *next, .between = true, .place = true});
    stretches_.push_back({t, v0, v1, a, m, b});
    v0 = v1;
    a = last ? b : add_behind_step(b);
  }
}

// Without a blend the force may begin with a step. No end of a piece before shows it either.
std::size_t ChunkForward::add_start(std::size_t t) {
  const Task& task = tasks_[t];
  const bool listed = task.begins_run || task.begins_anew || job_.options.blend == 0;
  if (!listed && is_where_the_last_ended(task)) return samples_.size() - 1;
  return add({.task = t,
              .v = 0,
              .u = task.piece->u0,
              .between = true,
              .place = task.begins_run,
              .listed = listed,
              .side = Side::after});
}

// The other side of a step of the force; the same sample where there is none.
std::size_t ChunkForward::add_behind_step(std::size_t before) {
  if (job_.options.blend > 0) return before;
  Sample behind = samples_[before];
  behind.place = false;
  behind.side = Side::after;
  const std::size_t segment = tasks_[behind.task].piece->segment;
  if (job_.forces.at(segment, behind.u, Side::after, cursor_) == requests_[before].load.F) return before;
  return add(behind);
}

// Pieces of one segment come one after the other.
void ChunkForward::read_places(const Piece& piece) {
  if (places_of_ == piece.segment) return;
  places_along(job_, piece.segment, cursor_, places_along_);
  places_of_ = piece.segment;
}

bool ChunkForward::is_place(double u) const {
  return std::binary_search(places_along_.begin(), places_along_.end(), u);
}

// Whether the end of the piece before, which was added last, is the start of this one, with the same force.
bool ChunkForward::is_where_the_last_ended(const Task& task) {
  if (samples_.empty() || samples_.back().between) return false;
  const Piece &piece = *task.piece, &before = *tasks_[samples_.back().task].piece;
  if (p_MT_.back() != wanted_at(task, piece.u0)) return false;
  const bool follows = before.segment + 1 == piece.segment && before.u1 == 1 && piece.u0 == 0;
  if (follows && job_.forces.follows(piece.segment)) return true;
  return requests_.back().load.F == job_.forces.at(piece.segment, piece.u0, Side::after, cursor_);
}

bool ChunkForward::is_safe(const Stretch& stretch) const {
  const Vector3 a = miss(stretch.a), m = miss(stretch.m), b = miss(stretch.b);
  return (m - (a + b) / 2).norm() <= straight_share * job_.options.tolerance &&
         std::max({a.norm(), m.norm(), b.norm()}) <= near_share * job_.options.tolerance;
}

void ChunkForward::sample_closer() {
  for (const Stretch& stretch : stretches_) {
    if (is_safe(stretch)) continue;
    for (int k = 0; k < odd_sixteenths; ++k)
      add_inside(stretch.task, stretch.v0 + odd_sixteenth(k) * (stretch.v1 - stretch.v0));
  }
}

// Listed samples in order along the path. Most have been added in it.
void ChunkForward::order_samples() {
  begins_.assign(tasks_.size() + 1, 0);
  for (const Sample& sample : samples_) begins_[sample.task + 1] += sample.listed;
  for (std::size_t t = 0; t < tasks_.size(); ++t) begins_[t + 1] += begins_[t];
  filled_.assign(begins_.begin(), begins_.end());
  order_.resize(begins_.back());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& sample = samples_[i];
    if (!sample.listed) continue;
    std::size_t k = filled_[sample.task]++;
    for (; k > begins_[sample.task] && samples_[order_[k - 1]].v > sample.v; --k) order_[k] = order_[k - 1];
    order_[k] = i;
  }
}

void ChunkForward::write_waypoints(std::vector<Waypoint>& out) {
  order_samples();
  if (const std::size_t needed = out.size() + order_.size(); needed > out.capacity())
    out.reserve(std::max(needed, 2 * out.capacity()));
  places_.reserve(order_.size());
  places_.clear();
  double v = 0, start = 0;  // of the sample before on this piece; what the start of the piece would stand for
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Sample& sample = samples_[order_[k]];
    const bool first = k == 0 || samples_[order_[k - 1]].task != sample.task;
    const bool last = k + 1 == order_.size() || samples_[order_[k + 1]].task != sample.task;
    if (first) {
      v = 0;
      start = sample.v > 0 ? sample.v / 2 : 0;
    }
    const double next = last ? 1 : samples_[order_[k + 1]].v;
    write_waypoint(order_[k], (next - v) / 2 + (last ? start : 0), out);
    v = sample.v;
  }
}

void ChunkForward::write_waypoint(std::size_t s, double share, std::vector<Waypoint>& out) {
  const Sample& sample = samples_[s];
  const Task& task = tasks_[sample.task];
  const Piece& piece = *task.piece;
  Waypoint& w = out.emplace_back();
  w.segment = piece.segment;
  w.fraction = sample.u;
  w.line = piece.line;
  w.corrected_line = piece.corrected_line;
  w.between = sample.between;
  w.place = sample.place;
  w.exempt = sample.between ? piece.exempt : piece.exempt_end;
  w.p_MT = p_MT_[s];
  w.tool_axis = wanted_[s].X_MT.R.col(2);
  w.wrench = requests_[s].load.F;
  if (const Segment* segment = task.segment) {
    w.line = segment->line;
    w.cutting = segment->cutting;
    w.weight = segment->cutting ? share * (piece.u1 - piece.u0) * length(segment->wanted) : 0;
    w.s = segment->s_start + sample.u * (segment->s_end - segment->s_start);
    w.direction = direction_at(segment->wanted, sample.u);
  }
  w.status = status(s);
  w.iterations = actuals_[s].iterations;
  w.rho = actuals_[s].rho;
  if (w.status == Status::converged) w.after = deviation(actuals_[s].X_MT, wanted_[s].X_MT);
  const std::size_t frame = task.segment ? task.segment->frame : piece.frame;
  const Vector3 original = original_command(job_, frame, w.p_MT), emitted = requests_[s].target;
  w.correction.head<3>() = emitted - original;
  places_.push_back(
      {original, emitted, requests_[s].load, wanted_[s].X_MT, actuals_[s].X_MT});
}

}  // namespace counterflex
