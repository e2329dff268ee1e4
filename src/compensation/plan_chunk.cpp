#include "plan_chunk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "counterflex/compensation/waypoint.hpp"

namespace counterflex {
namespace {

constexpr double jump_share = 0.1;    // of the tolerance: larger steps of the correction are jumped
constexpr double curve_share = 0.01;  // of the tolerance: accuracy of the sampled curve
constexpr double sampled_angle = std::numbers::pi / 2;
constexpr int group_samples = 8;     // along each move of a contour group
constexpr double bend_share = 0.25;  // of the room for knots: what is taken for a line bends less

}  // namespace

ChunkPlanner::ChunkPlanner(const Job& job, WaypointSolver& solver)
    : job_(job),
      waves_(job, solver),
      intervals_(waves_, curve_share * job.options.tolerance),
      knots_(job, solver) {}

std::optional<Failure> ChunkPlanner::plan(std::size_t begin, std::size_t end, Plan& plan) {
  clear(end - begin);
  for (std::size_t i = begin; i < end; ++i) add_task(i);
  choose_lines();
  if (!solve_responses()) return waves_.failure();
  judge_bends();
  look_into_lines();
  for (Task& task : tasks_) ask_first(task);
  if (!waves_.solve()) return waves_.failure();
  for (Task& task : tasks_)
    if (task.kind == Kind::cut && !segment(task).wanted.arc && !task.as_line) sample(task);
  judge_rows();
  if (!waves_.solve() || !intervals_.run()) return waves_.failure();
  for (const Task& task : tasks_) {
    plan.segments[task.segment] = {};
    if (!finish(task, plan.segments[task.segment])) return knots_.failure();
  }
  return std::nullopt;
}

void ChunkPlanner::clear(std::size_t segments) {
  waves_.clear(segments + segments / 2);
  intervals_.clear();
  tasks_.clear();
  answers_.clear();
  limits_.clear();
  bends_.clear();
  responses_.clear();
  lines_.clear();
  looks_.clear();
  next_interval_ = 0;
  tasks_.reserve(segments);
  limits_.reserve(2 * segments);
  bends_.reserve(3 * segments);
  lines_.reserve(segments);
}

// Cycles are solved at their bottom when they are written; what is held needs no solution.
void ChunkPlanner::add_task(std::size_t index) {
  Task task{.segment = index};
  const Segment& segment = job_.path.segments[index];
  const Move& move = job_.program.moves[segment.move];
  if (move.handling == Handling::group) {
    task.kind = Kind::group;
  } else if (move.handling != Handling::held && !move.cycle) {
    task.kind = segment.cutting ? Kind::cut : Kind::rapid;
    task.F_end = waves_.force_at(index, 1, Side::before);
    if (segment.cutting) add_limits(task);
  }
  tasks_.push_back(task);
}

// In the order of the path.
void ChunkPlanner::ask_first(Task& task) {
  if (task.kind == Kind::held) return;
  const bool cutting = segment(task).cutting;
  if (task.kind == Kind::group) return ask_group(task, cutting);
  // With a blend a rapid starts where the cut ended.
  if (cutting || job_.options.blend == 0) task.start = waves_.ask(task.segment, 0);
  if (segment(task).wanted.arc && cutting) return sample(task);
  task.end = waves_.ask_end(task.segment, task.F_end);
  if (task.look_at) task.look = waves_.ask_inside(task.segment, *task.look_at);
}

void ChunkPlanner::ask_group(Task& task, bool cutting) {
  task.first = answers_.size();
  const int count = cutting ? group_samples : 1;
  // A rapid begins with what was before the group.
  for (int k = cutting ? 0 : 1; k <= count; ++k)
    answers_.push_back(
        waves_.ask(task.segment, static_cast<double>(k) / count, k == count ? Side::before : Side::after));
  task.count = answers_.size() - task.first;
}

// Where sampling begins anew: at corners of the force, and often enough around an arc that a wave of the
// correction does not pass for a line.
void ChunkPlanner::add_limits(Task& task) {
  waves_.breaks(task.segment, fractions_);
  if (const auto& arc = segment(task).wanted.arc) {
    const int parts = static_cast<int>(std::ceil(arc->sweep / sampled_angle));
    for (int k = 1; k < parts; ++k) fractions_.push_back(static_cast<double>(k) / parts);
    std::sort(fractions_.begin(), fractions_.end());
    fractions_.erase(std::unique(fractions_.begin(), fractions_.end()), fractions_.end());
  }
  task.first = limits_.size();
  task.count = fractions_.size();
  limits_.insert(limits_.end(), fractions_.begin(), fractions_.end());
}

// Asks for what is inside a cut, and for its end.
void ChunkPlanner::sample(Task& task) {
  const bool may_wave = segment(task).wanted.arc.has_value();
  IntervalEnd a{0, task.start};
  for (std::size_t k = task.first; k < task.first + task.count; ++k) {
    const double u = limits_[k];
    intervals_.open(task.segment, a, {u}, may_wave);
    a = {u, waves_.ask(task.segment, u)};
  }
  task.end = intervals_.open(task.segment, a, {1, task.end}, may_wave);
}

void ChunkPlanner::choose_lines() {
  if (tasks_.size() < 2) return;
  const double longest = short_line * waves_.solver().model().mechanism.length;
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    Task& task = tasks_[t];
    if (task.kind != Kind::cut || segment(task).wanted.arc) continue;
    task.length = (segment(task).wanted.end - segment(task).wanted.start).norm();
    task.room = room_for_knots(job_, segment(task));
    if (task.length > longest || (job_.options.blend == 0 && task.count > 0)) continue;
    task.F_start = force_at_start(t);
    lines_.push_back(t);
  }
}

Vector6 ChunkPlanner::force_at_start(std::size_t t) {
  const std::size_t index = tasks_[t].segment;
  const bool joins = t > 0 && tasks_[t - 1].segment + 1 == index && job_.forces.follows(index);
  const bool known = joins && (tasks_[t - 1].kind == Kind::cut || tasks_[t - 1].kind == Kind::rapid);
  return known ? tasks_[t - 1].F_end : waves_.force_at(index, 0);
}

void ChunkPlanner::add_bends(Task& task) {
  const auto add = [&](double u) {
    bends_.push_back({u, waves_.force_at(task.segment, u) - (1 - u) * task.F_start - u * task.F_end});
  };
  task.first_bend = bends_.size();
  for (std::size_t k = task.first; k < task.first + task.count; ++k) add(limits_[k]);
  if (!job_.forces.is_linear_between_breaks()) add(0.5);
  task.bends = bends_.size() - task.first_bend;
}

// Before all else: they tell which lines are looked into. They end far from where the path begins.
bool ChunkPlanner::solve_responses() {
  ask_responses();
  const auto is_needed = [](const ForceResponse& response) { return response.is_needed(); };
  if (std::none_of(responses_.begin(), responses_.end(), is_needed)) return true;
  const bool solved = waves_.solve();
  waves_.solver().begin_anew();
  return solved;
}

void ChunkPlanner::ask_responses() {
  responses_.resize(tasks_.size() / response_span + 1);
  places_.assign(responses_.size(), 0);
  for (const std::size_t t : lines_) {
    ForceResponse& response = responses_[t / response_span];
    places_[t / response_span] = t;
    add_bends(tasks_[t]);
    for (std::size_t k = tasks_[t].first_bend; k < bends_.size(); ++k)
      response.provide_for(bends_[k].dF, tasks_[t].F_end);
  }
  for (std::size_t r = 0; r < responses_.size(); ++r) {
    if (!responses_[r].is_needed()) continue;
    const Task& place = tasks_[places_[r]];
    responses_[r].place = waves_.ask_apart(place.segment, place.F_end);
    responses_[r].ask([&](const Vector6& dF) { return waves_.ask_apart(place.segment, place.F_end + dF); });
  }
}

// Leaves those in `lines_` which the force bends but little; the others are sampled.
void ChunkPlanner::judge_bends() {
  for (ForceResponse& response : responses_)
    response.measure([&](Answer a) -> std::optional<Vector3> {
      for (const Answer needed : {a, response.place})
        if (waves_.status(needed) != Status::converged) return std::nullopt;
      return waves_.correction(a) - waves_.correction(response.place);
    });
  const auto bends = [&](std::size_t t) {
    Task& task = tasks_[t];
    const ForceResponse& response = responses_[t / response_span];
    find_bend(task, std::span(bends_).subspan(task.first_bend, task.bends), response);
    return !response.known || task.bend > bend_share * task.room;
  };
  lines_.erase(std::remove_if(lines_.begin(), lines_.end(), bends), lines_.end());
  for (const std::size_t t : lines_) tasks_[t].as_line = true;
}

void ChunkPlanner::look_into_lines() {
  look_into_rows(lines_, tasks_, [&](std::size_t row, std::size_t t, double u) {
    tasks_[t].look_at = u;
    looks_.push_back({row, t});
  });
}

bool ChunkPlanner::is_as_expected(const Look& look) const {
  const Task& task = tasks_[look.task];
  const double u = *task.look_at;
  const Vector6 dF = waves_.force(task.look) - (1 - u) * task.F_start - u * task.F_end;
  const Vector3 bend = responses_[look.task / response_span].S * dF;
  const Vector3 expected = (1 - u) * waves_.correction(task.start) + u * waves_.correction(task.end) + bend;
  return is_as_foreseen(waves_.correction(task.look), expected, bend, task.room);
}

void ChunkPlanner::judge_rows() {
  for (const Look& look : looks_) {
    if (is_as_expected(look)) continue;
    for (const std::size_t t : row_from(lines_, look.row)) {
      if (tasks_[t].as_line) sample(tasks_[t]);
      tasks_[t].as_line = false;
    }
  }
}

bool ChunkPlanner::finish(const Task& task, PlannedSegment& planned) {
  const Curve& wanted = segment(task).wanted;
  if (task.kind == Kind::held) return true;
  if (task.kind == Kind::group) {
    for (std::size_t k = 0; k < task.count; ++k) {
      const double u = task.count == 1 ? 1 : static_cast<double>(k) / static_cast<double>(task.count - 1);
      planned.group.push_back({u, waves_.correction(answers_[task.first + k])});
    }
    return true;
  }
  planned.starts_anywhere = task.start == no_answer;
  planned.start_target = wanted.start;
  if (task.start != no_answer) planned.start_target += waves_.correction(task.start);
  if (task.kind == Kind::cut && !task.as_line) return finish_sampled(task, planned);
  planned.end = wanted.end + waves_.correction(task.end);
  return true;
}

// Continuous stretches between steps of the force, each with its own knots.
bool ChunkPlanner::finish_sampled(const Task& task, PlannedSegment& planned) {
  const Curve& wanted = segment(task).wanted;
  fractions_.assign(1, 0);
  for (std::size_t k = task.first; k < task.first + task.count; ++k) fractions_.push_back(limits_[k]);
  fractions_.push_back(1);
  const auto& all = intervals_.done();
  CorrectionCurve stretch;
  for (bool ends = false; !ends; ++next_interval_) {
    const SampledInterval& interval = all[next_interval_];
    stretch.add(intervals_.curve(interval));
    ends = interval.at[4] == task.end;
    const Vector3 b = waves_.correction(interval.at[4]);
    const Vector3 a = ends ? b : waves_.correction(all[next_interval_ + 1].at[0]);
    const bool step = (a - b).norm() > jump_share * job_.options.tolerance;
    if (!step && !ends) continue;
    if (!knots_.add_stretch(task.segment, stretch, fractions_, planned)) return false;
    if (step && !wanted.arc) planned.knots.push_back({interval.u[4], point_at(wanted, interval.u[4]) + a});
    stretch = {};
  }
  return knots_.finish(task.segment, waves_.correction(task.end), planned);
}

}  // namespace counterflex
