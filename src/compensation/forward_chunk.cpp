#include "forward_chunk.hpp"

#include <algorithm>

#include "commands.hpp"
#include "track.hpp"

namespace counterflex {
namespace {

constexpr int odd_sixteenths = 8;
constexpr double quiet_share = 0.1;  // of the tolerance: arcs whose correction changes less are sampled once
constexpr double straight_share = 0.1;  // of the tolerance: a stretch that bends more is sampled closer
constexpr double near_share = 0.8;      // of the tolerance: so is one that comes so near to it

double odd_sixteenth(int k, int count) {
  return (2 * k + 1) / (2.0 * count);
}

}  // namespace

ChunkForward::ChunkForward(const Job& job, const Questions& questions, std::span<const KnownSegment> known,
                           WaypointSolver& solver)
    : job_(job), questions_(questions), segments_(known), solver_(solver) {
  for (const Component c : solver.model().mechanism.controlled)
    if (c <= Component::z) judged_[static_cast<int>(c)] = 1;
}

std::optional<Failure> ChunkForward::solve(std::span<const Piece> pieces,
                                           const std::optional<Vector3>& command,
                                           std::vector<Waypoint>& out) {
  clear();
  begin(pieces, command);
  const std::size_t first = out.size();
  const bool solved = run_waves();
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
    return status_failure(out[i].status, out[i].line);
  }
  return std::nullopt;
}

void ChunkForward::clear() {
  tasks_.clear();
  bends_.clear();
  responses_.clear();
  lines_.clear();
  looks_.clear();
  stretches_.clear();
  samples_.clear();
  p_MT_.clear();
  requests_.clear();
  wanted_.clear();
  actuals_.clear();
}

void ChunkForward::reserve(std::size_t pieces) {
  const std::size_t samples = pieces + pieces / 2;
  tasks_.reserve(pieces);
  bends_.reserve(3 * pieces);
  samples_.reserve(samples);
  p_MT_.reserve(samples);
  requests_.reserve(samples);
  wanted_.reserve(samples);
  actuals_.reserve(samples);
}

bool ChunkForward::run_waves() {
  choose_short_lines();
  ask_responses();
  if (!solve_added()) return false;
  judge_bends();
  look_into_lines();
  if (!solve_added()) return false;
  judge_rows();
  if (!solve_added()) return false;
  sample_closer();
  return solve_added();
}

Vector3 ChunkForward::wanted_at(const Task& task, double u) const {
  return task.segment ? point_at(task.segment->wanted, u) : task.piece->wanted;
}

// What is written is proven from the nominal configuration on, or known; samples between its ends begin at
// their neighbour.
std::size_t ChunkForward::add(std::size_t t, double v, bool between, bool listed) {
  const Piece& piece = *tasks_[t].piece;
  const double u = v == 1 ? piece.u1 : piece.u0 + v * (piece.u1 - piece.u0);
  Load load;
  if (tasks_[t].segment)
    load = {job_.forces.at(piece.segment, u, v == 0 ? Side::after : Side::before, cursor_),
            job_.forces.at_platform()};
  samples_.push_back({.task = t, .v = v, .u = u, .between = between, .listed = listed});
  p_MT_.push_back(wanted_at(tasks_[t], u));
  ActualRequest& request = requests_.emplace_back();
  request = {point_at(piece.commanded, v), load, {}, between ? Start::neighbour : Start::nominal};
  if (const KnownPlace* place = known_place(samples_.back()))
    request.known = place->answer(request.target, load);
  return samples_.size() - 1;
}

const KnownPlace* ChunkForward::known_place(const Sample& sample) const {
  const Piece& piece = *tasks_[sample.task].piece;
  if (piece.segment >= segments_.size()) return nullptr;
  const KnownSegment& segment = segments_[piece.segment];
  if (sample.between) return segment.inside ? &*segment.inside : nullptr;
  return sample.v == 1 && piece.u1 == 1 ? &segment.end : nullptr;
}

std::size_t ChunkForward::add_probe(std::size_t sample, const Vector6& dF) {
  samples_.push_back({.task = samples_[sample].task, .listed = false, .may_fail = true});
  p_MT_.push_back(Vector3(p_MT_[sample]));
  ActualRequest request = requests_[sample];
  request.load.F += dF;
  request.start = Start::neighbour;
  request.known = nullptr;
  requests_.push_back(request);
  return samples_.size() - 1;
}

bool ChunkForward::solve_added() {
  const std::size_t first = actuals_.size();
  wanted_.resize(samples_.size());
  actuals_.resize(samples_.size());
  solver_.wanted(std::span(p_MT_).subspan(first), std::span(wanted_).subspan(first));
  solver_.actuals(std::span(requests_).subspan(first), std::span(actuals_).subspan(first));
  for (std::size_t i = first; i < samples_.size(); ++i)
    if (!samples_[i].may_fail && status(i) != Status::converged) return false;
  return true;
}

Status ChunkForward::status(std::size_t sample) const {
  if (wanted_[sample].status != Status::converged) return wanted_[sample].status;
  if (actuals_[sample].status != Status::converged) return actuals_[sample].status;
  return actuals_[sample].in_travel ? Status::converged : Status::outside_travel;
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
                      .room = job_.options.tolerance});
    last = piece.commanded.end;
    add_first(tasks_.size() - 1);
  }
}

// The end of a piece, and what else is needed in any case.
void ChunkForward::add_first(std::size_t t) {
  Task& task = tasks_[t];
  const bool inside = questions_.inside && !task.piece->end_only;
  task.line = inside && !task.segment->wanted.arc;
  // Without a blend the force may begin with a step, which no end of a piece before sees either.
  const bool starts = inside && (task.begins_anew || job_.options.blend == 0);
  if (starts)
    task.start = add(t, 0, true);
  else if (task.line)
    task.start = is_where_the_last_ended(task) ? tasks_[t - 1].end : add(t, 0, true, false);
  if (inside && !task.line) {
    const int count = arc_samples(task);
    for (int k = 0; k < count; ++k) add(t, odd_sixteenth(k, count), true);
  }
  task.end = add(t, 1, false);
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

// An arc along which the correction hardly changes is sampled once.
int ChunkForward::arc_samples(const Task& task) const {
  const auto correction = [&](double v) {
    const double u = task.piece->u0 + v * (task.piece->u1 - task.piece->u0);
    return Vector3(point_at(task.piece->commanded, v) - point_at(task.segment->wanted, u));
  };
  const double quiet = quiet_share * job_.options.tolerance;
  const Vector3 c0 = correction(0);
  for (int k = 1; k <= odd_sixteenths; ++k)
    if ((correction(k / static_cast<double>(odd_sixteenths)) - c0).norm() > quiet) return odd_sixteenths;
  return 1;
}

// At the corners of the force, and in the middle, where it may be curved.
void ChunkForward::add_bends(Task& task) {
  const Piece& piece = *task.piece;
  job_.forces.breaks(piece.segment, cursor_, fractions_);
  const Vector6 &F0 = requests_[task.start].load.F, &F1 = requests_[task.end].load.F;
  const auto add_at = [&](double v) {
    const double u = piece.u0 + v * (piece.u1 - piece.u0);
    const Vector6 F = job_.forces.at(piece.segment, u, Side::before, cursor_);
    bends_.push_back({v, F - (1 - v) * F0 - v * F1});
  };
  task.first = bends_.size();
  for (const double u : fractions_)
    if (u > piece.u0 && u < piece.u1) add_at((u - piece.u0) / (piece.u1 - piece.u0));
  task.corners = bends_.size() - task.first;
  if (!job_.forces.is_linear_between_breaks()) add_at(0.5);
  task.bends = bends_.size() - task.first;
}

void ChunkForward::choose_short_lines() {
  const double longest = short_line * solver_.model().mechanism.length;
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    Task& task = tasks_[t];
    if (!task.line) continue;
    add_bends(task);
    task.length = (task.piece->u1 - task.piece->u0) * length(task.segment->wanted);
    const bool steps = job_.options.blend == 0 && task.corners > 0;
    if (task.length <= longest && !steps && tasks_.size() > 1) lines_.push_back(t);
  }
}

void ChunkForward::ask_responses() {
  responses_.resize(tasks_.size() / response_span + 1);
  for (const std::size_t t : lines_) {
    ForceResponse& response = responses_[t / response_span];
    response.place = tasks_[t].end;
    for (std::size_t k = tasks_[t].first; k < tasks_[t].first + tasks_[t].bends; ++k)
      response.provide_for(bends_[k].dF, requests_[response.place].load.F);
  }
  for (ForceResponse& response : responses_)
    response.ask([&](const Vector6& dF) { return add_probe(response.place, dF); });
}

// Leaves those in `lines_` whose inside is foreseen to be far from the tolerance; the others are sampled.
void ChunkForward::judge_bends() {
  for (ForceResponse& response : responses_)
    response.measure([&](std::size_t s) -> std::optional<Vector3> {
      if (actuals_[s].status != Status::converged) return std::nullopt;
      return (actuals_[s].X_MT.p - actuals_[response.place].X_MT.p).cwiseProduct(judged_);
    });
  const auto comes_near = [&](std::size_t t) {
    Task& task = tasks_[t];
    const ForceResponse& response = responses_[t / response_span];
    find_bend(task, std::span(bends_).subspan(task.first, task.bends), response);
    const double ends = std::max(miss(task.start).norm(), miss(task.end).norm());
    return !response.known || ends + (1 + bend_error) * task.bend > near_share * job_.options.tolerance;
  };
  lines_.erase(std::remove_if(lines_.begin(), lines_.end(), comes_near), lines_.end());
  for (const std::size_t t : lines_) tasks_[t].foreseen = true;
  for (std::size_t t = 0; t < tasks_.size(); ++t)
    if (tasks_[t].line && !tasks_[t].foreseen) sample(t);
}

void ChunkForward::look_into_lines() {
  look_into_rows(lines_, tasks_, [&](std::size_t row, std::size_t t, double v) {
    tasks_[t].look = add(t, v, true);
    looks_.push_back({row, tasks_[t].look});
  });
}

bool ChunkForward::went_as_foreseen(const Look& look) const {
  const Sample& sample = samples_[look.sample];
  const Task& task = tasks_[sample.task];
  const double v = sample.v;
  const Vector6 dF =
      requests_[look.sample].load.F - (1 - v) * requests_[task.start].load.F - v * requests_[task.end].load.F;
  const Vector3 bend = responses_[sample.task / response_span].S * dF;
  const Vector3 foreseen = (1 - v) * miss(task.start) + v * miss(task.end) + bend;
  return is_as_foreseen(miss(look.sample), foreseen, bend, job_.options.tolerance);
}

void ChunkForward::judge_rows() {
  for (const Look& look : looks_) {
    if (went_as_foreseen(look)) continue;
    for (const std::size_t t : row_from(lines_, look.row)) {
      if (tasks_[t].foreseen) sample(t);
      tasks_[t].foreseen = false;
    }
  }
}

// At the corners of the force inside a line, and in the middle of each stretch between them.
void ChunkForward::sample(std::size_t t) {
  const Task task = tasks_[t];
  const auto inside = [&](double v) {
    return task.look != no_answer && samples_[task.look].v == v ? task.look : add(t, v, true);
  };
  double v0 = 0;
  std::size_t a = task.start;
  for (std::size_t k = task.first; k <= task.first + task.corners; ++k) {
    const bool last = k == task.first + task.corners;
    const double v1 = last ? 1 : bends_[k].at;
    const std::size_t m = inside((v0 + v1) / 2), b = last ? task.end : inside(v1);
    stretches_.push_back({t, v0, v1, a, m, b});
    v0 = v1;
    a = b;
  }
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
      add(stretch.task, stretch.v0 + odd_sixteenth(k, odd_sixteenths) * (stretch.v1 - stretch.v0), true);
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
  w.between = sample.between;
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
  if (w.status == Status::converged) w.after = deviation(actuals_[s].X_MT, wanted_[s].X_MT);
  const std::size_t frame = task.segment ? task.segment->frame : piece.frame;
  const Vector3 original = original_command(job_, frame, w.p_MT), emitted = requests_[s].target;
  w.correction.head<3>() = emitted - original;
  places_.push_back(
      {original, emitted, requests_[s].load, wanted_[s].X_MT, actuals_[s].X_MT, known_place(sample)});
}

}  // namespace counterflex
