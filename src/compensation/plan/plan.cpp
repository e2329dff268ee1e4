#include "compensation/plan/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compensation/plan/corrections.hpp"
#include "compensation/plan/knots.hpp"
#include "compensation/plan/places.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {
namespace {

constexpr double sampled_angle = std::numbers::pi / 2;  // of a wave, two samples on each side of an extreme

Fade fade_of(const Job& job, const Segment& segment) {
  Fade fade{starts_as_programmed(job, segment.move), ends_as_programmed(job, segment.move)};
  fade.programmed.head<3>() = -job.path.frames[segment.frame].datum_shift;
  return fade;
}

struct PlanTask {
  std::size_t segment = 0;
  Fade fade{};
  Answer start = no_answer, end = no_answer;
  std::vector<Answer> group{};   // of a move of a contour group: it has no other answers
  bool is_sampled = false;       // a cut that is not planned by its ends alone
  std::vector<double> limits{};  // of a cut: fractions between which it is sampled
};

// What is requested along a slice of the path.
struct Requests {
  Corrections corrections;
  std::vector<PlanTask> tasks{};
  std::vector<Interval> intervals{};
};

// Where sampling begins again: at corners of the force, where a joint reverses, often enough around an arc
// and across the positions of tables.
void find_limits(const Job& job, PlaceSolver& solver, std::size_t index, ForceCursor& cursor,
                 std::vector<double>& limits) {
  const Segment& segment = job.path.segments[index];
  const auto& arc = segment.wanted.arc;
  const int waves = arc ? static_cast<int>(std::ceil(arc->sweep / sampled_angle)) : 1;
  fractions_inside(job, solver, index, std::max(waves, steps_of_tables(job, segment)), cursor, limits);
}

// Whether the bound of its cell lets a line go straight between its ends.
bool bends_little(const Job& job, Requests& requests, const PlanTask& task, const Vector6& F1) {
  if (task.fade.acts()) return false;
  Corrections& corrections = requests.corrections;
  const ForceChord along{task.segment, 0, 1, corrections.force(task.start), F1};
  const LineBend bend = bend_of(job, corrections.solver(), along, task.limits, corrections.cursor());
  return bend.command <= bend_share * room_for_knots(job, job.path.segments[task.segment]);
}

void ask_group(Requests& requests, PlanTask& task, bool cutting) {
  const int count = cutting ? eighths : 1;
  // A rapid begins with what was before the group.
  for (int k = cutting ? 0 : 1; k <= count; ++k)
    task.group.push_back(requests.corrections.ask(task.segment, static_cast<double>(k) / count,
                                                  k == count ? Side::before : Side::after));
}

// The inside of a cut, between its limits, and its end.
void ask_inside(const Job& job, Requests& requests, PlanTask& task, const Vector6& F1) {
  Corrections& corrections = requests.corrections;
  const Segment& segment = job.path.segments[task.segment];
  const bool waves = segment.wanted.arc.has_value() || may_wave(model_of(job, segment).mechanism) ||
                     steps_of_tables(job, segment) > 1;
  double u0 = 0;
  Answer a = task.start;
  for (const double u : task.limits) {
    const Vector6 F = corrections.force_at(task.segment, u, Side::before);
    requests.intervals.push_back(open_interval(corrections, task.segment, u0, a, u, F, waves));
    a = corrections.ask(task.segment, u, Side::after);
    u0 = u;
  }
  requests.intervals.push_back(open_interval(corrections, task.segment, u0, a, 1, F1, waves));
  task.end = requests.intervals.back().at[4];
}

// With a blend a rapid starts where the cut ended.
bool starts_anywhere(const Job& job, const Segment& segment) {
  return !segment.cutting && job.options.blend > 0;
}

void plan_as_programmed(const Job& job, const Segment& segment, const Correction& c,
                        PlannedSegment& planned) {
  planned.starts_anywhere = starts_anywhere(job, segment);
  planned.start = command_at(job, segment, 0, c);
  if (segment.wanted.arc) planned.arc.emplace_back().add({{0, c}, {1, c}});
  planned.knots = {{command_at(job, segment, 1, c), 1}};
}

// Cycles are solved at their bottom when they are written; what is held needs no solution.
void ask_segment(const Job& job, Requests& requests, std::size_t index, PlannedSegment& planned) {
  Corrections& corrections = requests.corrections;
  const Segment& segment = job.path.segments[index];
  const Move& move = job.program.moves[segment.move];
  PlanTask task{.segment = index};
  if (move.handling == Handling::group) {
    ask_group(requests, task, segment.cutting);
  } else if (move.handling == Handling::held || move.cycle) {
    return;
  } else {
    task.fade = fade_of(job, segment);
    if (task.fade.from && task.fade.to)
      return plan_as_programmed(job, segment, task.fade.programmed, planned);
    if (segment.cutting || job.options.blend == 0 || segment.wanted.arc)
      task.start = corrections.ask(index, 0, Side::after);
    if (segment.cutting) find_limits(job, corrections.solver(), index, corrections.cursor(), task.limits);
    const Vector6 F1 = corrections.force_at(index, 1, Side::before);
    task.is_sampled = segment.cutting && !bends_little(job, requests, task, F1);
    if (task.is_sampled)
      ask_inside(job, requests, task, F1);
    else
      task.end = corrections.ask(index, 1, F1, Side::before);
  }
  requests.tasks.push_back(std::move(task));
}

// Continuous stretches between steps of the force, each with its own knots. `interval`: the first one of the
// segment; then behind its last one.
std::optional<Failure> finish_cut(const Job& job, Corrections& corrections, const PlanTask& task,
                                  const Interval*& interval, PlannedSegment& planned) {
  const Segment& segment = job.path.segments[task.segment];
  std::vector<double> corners{0};
  corners.insert(corners.end(), task.limits.begin(), task.limits.end());
  corners.push_back(1);
  // At a corner where the load of a joint passes its knee the nodes are close to each other.
  const bool knees = model_of(job, segment).mechanism.has_knees;
  CorrectionCurve stretch;
  for (bool ends = false; !ends; ++interval) {
    stretch.add(nodes_of(corrections, *interval));
    ends = interval->at[4] == task.end;
    const Correction b = corrections.correction(interval->at[4]);
    const Correction a = ends ? b : corrections.correction(interval[1].at[0]);
    const bool step = (a - b).norm() > small_share * job.options.tolerance;
    if (!step && !ends) continue;
    const double u = interval->u[4];
    if (segment.wanted.arc)
      planned.arc.push_back(std::move(stretch));
    else if (auto failure = add_knots(job, corrections.solver(), task.segment, stretch, task.fade,
                                      knees ? stretch.nodes() : corners, planned))
      return failure;
    if (step && !segment.wanted.arc)
      planned.knots.push_back({command_at(job, segment, u, task.fade(u, a)), u});
    stretch = {};
  }
  if (segment.wanted.arc) {
    planned.knots = {{command_at(job, segment, 1, corrections.correction(task.end)), 1}};
    return set_gain(job, corrections.solver(), task.segment, planned.gain);
  }
  if (!job.program.moves[segment.move].may_split) forbid_splitting(segment, planned);
  return std::nullopt;
}

std::optional<Failure> finish(const Job& job, Corrections& corrections, const PlanTask& task,
                              const Interval*& interval, PlannedSegment& planned) {
  const Segment& segment = job.path.segments[task.segment];
  const std::size_t count = task.group.size();
  for (std::size_t k = 0; k < count; ++k) {
    const double u = count == 1 ? 1 : static_cast<double>(k) / static_cast<double>(count - 1);
    planned.group.push_back(corrections.node(u, task.group[k]));
  }
  if (count > 0) return std::nullopt;
  planned.starts_anywhere = starts_anywhere(job, segment);
  planned.start.target = segment.wanted.start;
  if (task.start != no_answer)
    planned.start = command_at(job, segment, 0, task.fade(0, corrections.correction(task.start)));
  if (task.is_sampled) return finish_cut(job, corrections, task, interval, planned);
  const Correction end = task.fade(1, corrections.correction(task.end));
  planned.knots = {{command_at(job, segment, 1, end), 1}};
  if (!segment.wanted.arc) return std::nullopt;
  const Correction start = task.fade(0, corrections.correction(task.start));
  planned.arc.emplace_back().add({{0, start}, {1, end}});  // a rapid
  return std::nullopt;
}

// Segments [begin, end). A corner near a node is missed by up to three times as much as `is_predicted` finds.
std::optional<Failure> plan_slice(const Job& job, std::size_t begin, std::size_t end, Plan& plan) {
  PlaceSolver solver(job);
  Requests requests{Corrections(job, solver)};
  for (std::size_t i = begin; i < end; ++i) ask_segment(job, requests, i, plan.segments[i]);
  Corrections& corrections = requests.corrections;
  const double share = (job.model.mechanism.has_knees ? small_share : 1) * curve_share;
  const std::vector<Interval> intervals =
      refine(corrections, std::move(requests.intervals), share * job.options.tolerance);
  const Interval* next = intervals.data();
  for (const PlanTask& task : requests.tasks) {
    if (task.segment >= corrections.end()) break;
    if (auto failure = finish(job, corrections, task, next, plan.segments[task.segment])) return failure;
  }
  return corrections.failure();
}

}  // namespace

TargetCommand command_at(const Job& job, const Segment& segment, double u, const Correction& c) {
  return {point_at(segment.wanted, u) + shift_of(c), c.tail<3>() / lever(job.options)};
}

Plan plan(const Job& job) {
  const std::size_t count = job.path.segments.size();
  Plan result;
  result.segments.resize(count);
  std::vector<std::optional<Failure>> failures(count / slice_size + 1);
  for_each_slice(count, job.options.threads, [&](std::size_t begin, std::size_t size) {
    failures[begin / slice_size] = plan_slice(job, begin, begin + size, result);
  });
  const auto first = std::ranges::find_if(failures, [](const auto& failure) { return failure.has_value(); });
  if (first != failures.end()) result.failure = std::move(*first);
  return result;
}

}  // namespace counterflex
