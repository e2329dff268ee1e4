#include "plan.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "counterflex/compensation/compensate.hpp"
#include "counterflex/geometry/units.hpp"
#include "curve.hpp"
#include "path_solver.hpp"

namespace counterflex {
namespace {

constexpr double jump_share = 0.1;    // of the tolerance: larger steps of the correction are jumped
constexpr double curve_share = 0.01;  // of the tolerance: accuracy of the sampled curve
constexpr double least_share =
    0.02;  // of the tolerance: what rounding must leave of it where points are inserted
constexpr double sampled_angle = std::numbers::pi / 2;
constexpr int group_samples = 8;      // along each move of a contour group
constexpr double gain_probe = 50e-6;  // m
constexpr double gain_margin = 1.01;

// Plans the segments of one chunk, one after another.
class ChunkPlanner {
 public:
  ChunkPlanner(const Job& job, const NominalTrack& track) : job_(job), track_(track), solvers_(job) {}

  std::optional<Failure> plan(std::size_t index, PlannedSegment& planned) {
    index_ = index;
    segment_ = &job_.path.segments[index];
    take_model();
    failure_.reset();
    const bool done = plan_by_handling(planned);
    if (!done && !failure_) failure_ = status_failure(Status::not_converged, segment_->line);
    return failure_;
  }

 private:
  void take_model() {
    const Model& model = model_of(job_, *segment_);
    if (solvers_.is_of(model)) return;
    solver_ = &solvers_.of(model, track_.start_before(index_));
    gain_ = 0;
  }

  // Cycles are solved at their bottom when they are written; what is held needs no solution.
  bool plan_by_handling(PlannedSegment& planned) {
    const Move& move = job_.program.moves[segment_->move];
    if (move.handling == Handling::group) return plan_group(planned);
    if (move.handling == Handling::held || move.cycle) return true;
    return segment_->cutting ? plan_cut(planned) : plan_rapid(planned);
  }

  bool plan_group(PlannedSegment& planned) {
    const int count = segment_->cutting ? group_samples : 1;
    for (int k = 0; k <= count; ++k) {
      CurveNode node;
      if (k == 0 && !segment_->cutting) continue;  // a rapid begins with what was before the group
      if (!solve(static_cast<double>(k) / count, k == count ? Side::before : Side::after, node)) return false;
      planned.group.push_back(node.c);
    }
    return true;
  }

  bool solve(double u, Side side, CurveNode& node) {
    const Vector3 wanted = point_at(segment_->wanted, u);
    const TargetSolution solution =
        solver_->target(wanted, {job_.forces.at(index_, u, side), job_.forces.at_platform()});
    if (solution.status != Status::converged) {
      failure_ = status_failure(solution.status, segment_->line);
      return false;
    }
    node = {u, solution.target - wanted};
    failure_ = limit_failure(job_, node.c + job_.path.frames[segment_->frame].datum_shift, segment_->line);
    return !failure_;
  }

  bool plan_rapid(PlannedSegment& planned) {
    CurveNode start, end;
    planned.starts_anywhere = job_.options.blend > 0;  // where the cut ended
    if (!planned.starts_anywhere && !solve(0, Side::after, start)) return false;
    if (!solve(1, Side::before, end)) return false;
    planned.start_target = segment_->wanted.start + start.c;
    planned.knots = {{1, segment_->wanted.end + end.c}};
    return true;
  }

  // Where sampling begins anew: at corners of the force, and often enough around an arc that a wave of the
  // correction does not pass for a line.
  std::vector<double> sampling_limits() const {
    std::vector<double> limits = job_.forces.breaks(index_);
    limits.insert(limits.begin(), 0);
    limits.push_back(1);
    if (!segment_->wanted.arc) return limits;
    const int parts = static_cast<int>(std::ceil(segment_->wanted.arc->sweep / sampled_angle));
    for (int k = 1; k < parts; ++k) limits.push_back(static_cast<double>(k) / parts);
    std::sort(limits.begin(), limits.end());
    limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
    return limits;
  }

  // Continuous stretches between steps of the force, each with its own knots.
  bool plan_cut(PlannedSegment& planned) {
    const std::vector<double> limits = sampling_limits();
    CurveNode a, b;
    if (!solve(0, Side::after, a)) return false;
    planned.start_target = segment_->wanted.start + a.c;
    CorrectionCurve stretch;
    for (std::size_t i = 1; i < limits.size(); ++i) {
      if (!solve(limits[i], Side::before, b)) return false;
      const CorrectionAt inside = [this](double u, CurveNode& node) { return solve(u, Side::after, node); };
      if (!sample_curve(a, b, curve_share * job_.options.tolerance, inside, stretch,
                        segment_->wanted.arc.has_value()))
        return false;
      a = b;
      if (i + 1 < limits.size() && !solve(limits[i], Side::after, a)) return false;
      const bool step = (a.c - b.c).norm() > jump_share * job_.options.tolerance;
      if (!step && i + 1 < limits.size()) continue;
      if (!finish_stretch(stretch, limits, planned)) return false;
      if (step && !segment_->wanted.arc)
        planned.knots.push_back({a.u, point_at(segment_->wanted, a.u) + a.c});
      stretch = {};
    }
    if (segment_->wanted.arc) return finish_arc(b, planned);
    if (!job_.program.moves[segment_->move].may_split) forbid_splitting(planned);
    return true;
  }

  bool finish_stretch(const CorrectionCurve& stretch, const std::vector<double>& corners,
                      PlannedSegment& planned) {
    if (!segment_->wanted.arc) return add_knots(stretch, corners, planned);
    planned.arc.push_back(stretch);
    return true;
  }

  bool finish_arc(const CurveNode& end, PlannedSegment& planned) {
    planned.knots = {{1, segment_->wanted.end + end.c}};
    if (!measure_gain()) return false;
    planned.gain = gain_;
    return true;
  }

  bool add_knots(const CorrectionCurve& stretch, const std::vector<double>& corners,
                 PlannedSegment& planned) {
    const double tolerance = job_.options.tolerance, least = least_share * tolerance;
    const double rounding = rounding_allowance(job_.program.moves[segment_->move], job_.options.write);
    std::vector<double> knots = choose_knots(stretch, corners, std::max(tolerance - rounding, least));
    if (knots.size() > 1) {
      if (!measure_gain()) return false;
      const std::optional<double> room = room_between_points(job_, *segment_, gain_);
      if (!room) {
        failure_ = few_decimals_failure(job_.program.moves[segment_->move], job_.options);
        return false;
      }
      knots = choose_knots(stretch, corners, *room);
    }
    for (double u : knots) planned.knots.push_back({u, point_at(segment_->wanted, u) + stretch.at(u)});
    return true;
  }

  // How much the tip moves for a change of target, at most: largest singular value, once a chunk and
  // model.
  bool measure_gain() {
    if (gain_ > 0) return true;
    const Load load = load_at(job_, index_, 1);
    Matrix3 gain;
    Vector3 reached[2];
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const Vector3 target = segment_->wanted.end + (side ? -gain_probe : gain_probe) * Vector3::Unit(axis);
        const ActualSolution actual = solver_->actual(target, load, {});
        if (actual.status != Status::converged) {
          failure_ = status_failure(actual.status, segment_->line);
          return false;
        }
        reached[side] = actual.X_MT.p;
      }
      gain.col(axis) = (reached[0] - reached[1]) / (2 * gain_probe);
    }
    gain_ = gain_margin * Eigen::JacobiSVD<Matrix3>(gain).singularValues()[0];
    return true;
  }

  // The block must stay one: its end is corrected, and what its inside misses is said.
  void forbid_splitting(PlannedSegment& planned) {
    if (planned.knots.size() < 2) return;
    const Vector3 c0 = planned.start_target - segment_->wanted.start,
                  c1 = planned.knots.back().target - segment_->wanted.end;
    for (const Knot& knot : planned.knots) {
      const Vector3 c = knot.target - point_at(segment_->wanted, knot.u);
      planned.unsplit_miss = std::max(planned.unsplit_miss, (c - (1 - knot.u) * c0 - knot.u * c1).norm());
    }
    planned.knots.erase(planned.knots.begin(), planned.knots.end() - 1);
  }

  const Job& job_;
  const NominalTrack& track_;
  ToolSolver solvers_;
  PathSolver* solver_ = nullptr;
  std::size_t index_ = 0;
  const Segment* segment_ = nullptr;
  double gain_ = 0;
  std::optional<Failure> failure_;
};

}  // namespace

namespace {

double rounding_of(LengthUnit unit, int decimals) {
  return 0.5 * (unit == LengthUnit::inches ? inch : mm) * std::pow(10.0, -decimals) * std::sqrt(3.0);
}

}  // namespace

double rounding_allowance(const Move& move, const WriteOptions& options) {
  const Decimals decimals = decimals_of(move, options);
  return rounding_of(move.unit,
                     std::min({decimals.end[0], decimals.end[1], decimals.end[2], decimals.inserted}));
}

Failure few_decimals_failure(const Move& move, const CompensationOptions& options) {
  int enough = 0;
  while (rounding_of(move.unit, enough) > options.tolerance / 2) ++enough;
  return {
      Exit::usage, move.line,
      fmt::format("words are rounded by up to {:.3g} mm here, which leaves too little of the tolerance of "
                  "{:.3g} mm; it needs --decimals {}",
                  rounding_allowance(move, options.write) / mm, options.tolerance / mm, enough)};
}

std::optional<double> room_between_points(const Job& job, const Segment& segment, double gain) {
  const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
  const double room = job.options.tolerance / gain - rounding;
  if (room < least_share * job.options.tolerance) return std::nullopt;
  return room;
}

Plan plan(const Job& job, const NominalTrack& track) {
  Plan result;
  result.segments.resize(job.path.segments.size());
  std::vector<std::optional<Failure>> failures(chunk_count(result.segments.size()));
  for_each_chunk(result.segments.size(), job.options.threads, [&](const Chunk& chunk) {
    ChunkPlanner planner(job, track);
    for (std::size_t i = chunk.begin; i < chunk.end && !failures[chunk.index]; ++i)
      failures[chunk.index] = planner.plan(i, result.segments[i]);
  });
  for (auto& failure : failures)
    if (failure) {
      result.failure = std::move(failure);
      break;
    }
  return result;
}

}  // namespace counterflex
