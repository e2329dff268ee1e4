// Solves pieces forward, slice by slice: samples become waypoints.
#include <algorithm>
#include <iterator>

#include "compensation/plan/places.hpp"
#include "compensation/solve/attribution.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/failures.hpp"
#include "compensation/solve/piece_samples.hpp"
#include "counterflex/compensation/uncertainty.hpp"
#include "counterflex/compensation/windows.hpp"

namespace counterflex {
namespace {

// Of the feed moves before a move that has no segment.
double length_before(const Toolpath& path, std::size_t move) {
  const auto next = std::ranges::upper_bound(path.segments, move, {}, &Segment::move);
  return next == path.segments.end() ? path.end.s : next->s_start;
}

// `share`: of the way of the piece, from the sample before. The waypoint takes the actuators of its answer.
Waypoint waypoint_of(const Job& job, PieceSamples& all, std::size_t s, double share) {
  const PieceSample& sample = all.samples[s];
  const SampledPiece& sampled = all.piece_of(s);
  const Piece& piece = *sampled.piece;
  Waypoint w;
  w.segment = piece.segment;
  w.move = static_cast<std::uint32_t>(piece.move);
  w.fraction = sample.u;
  w.line = piece.line;
  w.corrected_line = piece.corrected_line;
  w.between = sample.between;
  w.place = sample.place;
  w.in_corner = sample.corner_direction.has_value();
  w.exempt = w.in_corner || (sample.between ? piece.exempt : piece.exempt_end);
  w.p_MT = all.places[s].p_MT;
  w.tool_axis = all.wanted[s].X_MT.R.col(2);
  w.R_MT = all.places[s].R_MT;
  w.wrench = all.requests[s].F;
  if (const Segment* segment = sampled.segment) {
    w.cutting = segment->cutting;
    w.weight = segment->cutting ? share * (piece.u1 - piece.u0) * length(segment->wanted) : 0;
    w.s = segment->s_start + sample.u * (segment->s_end - segment->s_start);
    w.direction = sample.corner_direction.value_or(direction_at(segment->wanted, sample.u));
  } else {
    w.s = length_before(job.path, w.move);
    if (job.program.moves[w.move].cycle) w.direction = -w.tool_axis;  // the plunge to the bottom of a hole
  }
  w.status = all.status(s);
  w.iterations = all.answers[s].iterations;
  w.rho = std::move(all.answers[s].rho);
  w.directions = all.requests[s].directions;
  if (w.status == Status::converged) w.after = deviation(all.answers[s].X_MT, all.wanted[s].X_MT);
  if (w.in_corner) w.after.head<3>() -= w.after.head<3>().dot(w.direction) * w.direction;
  w.correction.head<3>() = all.requests[s].target - original_command(job, piece.frame, w.p_MT);
  if (w.R_MT && all.requests[s].R) w.correction.tail<3>() = rotation_between(*all.requests[s].R, *w.R_MT);
  return w;
}

// A waypoint weighs the way from the sample before: so the weights between two places do not depend on what
// is sampled between them.
std::vector<Waypoint> waypoints_of(const Job& job, PieceSamples& all) {
  std::vector<Waypoint> waypoints;
  waypoints.reserve(all.order.size());
  const PieceSample* before = nullptr;
  for (const std::size_t s : all.order) {
    const PieceSample& sample = all.samples[s];
    const bool joins = before != nullptr && before->piece == sample.piece;
    waypoints.push_back(waypoint_of(job, all, s, sample.v - (joins ? before->v : 0)));
    before = &sample;
  }
  return waypoints;
}

bool is_above_tolerance(const Job& job, const Waypoint& w) {
  return share_of_tolerance(job.options, job.model.mechanism, w.R_MT, w.after) > 1;
}

// Of the waypoints before `count`: at an equilibrium that is not found again they stay unknown.
void add_covariances(const Job& job, PlaceSolver& solver, const PieceSamples& all, const Questions& questions,
                     std::size_t count, std::vector<Waypoint>& waypoints) {
  const Model* last = nullptr;
  const TipUncertainty* uncertainty = nullptr;
  std::optional<StaticsWork> work;
  for (std::size_t i = 0; i < count; ++i) {
    const ForwardRequest& request = all.requests[all.order[i]];
    const bool may_stay = job.options.only_significant && is_above_tolerance(job, waypoints[i]);
    if (!knows_before(waypoints[i]) && !questions.bands && !may_stay) continue;
    if (request.model != last) {
      last = request.model;
      uncertainty = &job.uncertainties->by_model.at(last);
      work.emplace(uncertainty->work());
    }
    const Equilibrium found = solver.equilibrium(request, all.answers[all.order[i]]);
    if (found.status != Status::converged) continue;
    const Load load{request.F, job.forces.at_platform()};
    const DatumTangents& datum = job.uncertainties->by_frame[all.piece_of(all.order[i]).piece->frame];
    waypoints[i].covariance = uncertainty->of_tip(found.configuration, load, *work, datum).sum();
    waypoints[i].insignificant = may_stay && is_below_band(job, waypoints[i]);
  }
}

// What the original program does, and the causes, at the waypoints before the first that fails.
void add_questions(const Job& job, PlaceSolver& solver, const PieceSamples& all, const Questions& questions,
                   std::vector<Waypoint>& waypoints) {
  std::vector<ForwardPlace> places;
  places.reserve(all.order.size());
  for (std::size_t i = 0; i < all.order.size(); ++i) {
    const std::size_t s = all.order[i];
    ForwardRequest emitted = all.requests[s], original = emitted;
    emitted.within_travel = original.within_travel = false;
    emitted.rho = &waypoints[i].rho;
    original.target = original_command(job, all.piece_of(s).piece->frame, all.places[s].p_MT);
    original.R = all.places[s].R_MT;
    places.push_back({original, emitted, all.wanted[s].X_MT});
  }
  const auto solved = [&] {
    const auto fails = [](const Waypoint& w) { return w.status != Status::converged; };
    return static_cast<std::size_t>(std::ranges::find_if(waypoints, fails) - waypoints.begin());
  };
  if (questions.before)
    add_before(solver, std::span(places).first(solved()), std::span(waypoints).first(solved()));
  if (questions.attribution)
    add_causes(solver, std::span(places).first(solved()), std::span(waypoints).first(solved()));
  if (job.uncertainties != nullptr) add_covariances(job, solver, all, questions, solved(), waypoints);
  if (solved() < waypoints.size()) waypoints.resize(solved() + 1);
}

// The failure of a command at the waypoint `w` or beside it. `rho`: its actuators, where they are known.
Failure failure_at(const Job& job, const Waypoint& w, Status status, const TipPosition& command,
                   const Eigen::VectorXd& rho) {
  const Move& move = job.program.moves[w.move];
  Failure failure = status_failure(
      job, status, {*command.model, job.path.frames[move.frame], move.tool, command.p_MT, command.R_MT, rho},
      w.line);
  failure.corrected_line = w.corrected_line;
  return failure;
}

// Why the nominal machine, which comes to `there`, does not come to a command beside the waypoint `w`.
std::optional<Failure> failure_beside(const Job& job, const Waypoint& w, const TipPosition& command,
                                      const NominalResult& there) {
  if (there.status != Status::converged) return failure_at(job, w, there.status, command, {});
  const Eigen::VectorXd rho = actuator_values(command.model->mechanism, there.configuration);
  if (within_travel(command.model->mechanism, rho)) return std::nullopt;
  return failure_at(job, w, Status::outside_travel, command, rho);
}

// Cuts the run off at the first waypoint beside which a command is not reached.
void judge_outermost(const Job& job, PlaceSolver& solver, ForwardRun& run) {
  const OutermostCommands commands = outermost_commands(job, run.waypoints);
  const std::vector<NominalResult> there = solver.nominals(commands.positions);
  for (std::size_t k = 0; k < there.size(); ++k) {
    const std::size_t i = commands.waypoints[k];
    if (auto failure = failure_beside(job, run.waypoints[i], commands.positions[k], there[k])) {
      run.waypoints.resize(i + 1);
      run.failure = std::move(failure);
      return;
    }
  }
}

ForwardRun solve_slice(const Job& job, std::span<const Piece> pieces, const Questions& questions,
                       const std::optional<Vector3>& command, const Piece* next) {
  PlaceSolver solver(job);
  PieceSamples all = sample_pieces(job, solver, pieces, questions, command, next);
  ForwardRun run{waypoints_of(job, all), {}};
  add_questions(job, solver, all, questions, run.waypoints);
  if (!run.waypoints.empty() && run.waypoints.back().status != Status::converged) {
    const Waypoint& last = run.waypoints.back();
    const ForwardRequest& request = all.requests[all.order[run.waypoints.size() - 1]];
    run.failure = failure_at(job, last, last.status, {request.model, request.target, request.R}, last.rho);
  }
  judge_outermost(job, solver, run);
  return run;
}

// Where slices of pieces begin, and their end: each has `slice_size` places, and those of its last piece.
std::vector<std::size_t> slice_borders(const Job& job, std::span<const Piece> pieces,
                                       const Questions& questions) {
  std::vector<std::size_t> borders{0};
  double places = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (places >= slice_size) {
      borders.push_back(i);
      places = 0;
    }
    const Piece& piece = pieces[i];
    const bool inside = questions.inside && !piece.end_only && piece.segment != no_segment;
    places += 1 + (inside ? (piece.u1 - piece.u0) * steps_along(job, job.path.segments[piece.segment]) : 0.0);
  }
  borders.push_back(pieces.size());
  return borders;
}

}  // namespace

std::optional<Failure> solve_in_portions(const Job& job, std::span<const Piece> pieces,
                                         const Questions& questions, const std::optional<Vector3>& command,
                                         const WaypointTaker& take) {
  const std::size_t together = 4 * static_cast<std::size_t>(std::max(1, job.options.threads));  // slices
  const std::vector<std::size_t> borders = slice_borders(job, pieces, questions);
  const std::size_t count = borders.size() - 1;
  for (std::size_t first = 0; first < count; first += together) {
    std::vector<ForwardRun> runs(std::min(together, count - first));
    for_each_index(runs.size(), job.options.threads, [&](std::size_t i) {
      const std::size_t begin = borders[first + i], end = borders[first + i + 1];
      const std::optional<Vector3> last = begin == 0 ? command : pieces[begin - 1].commanded.end;
      const Piece* next = end < pieces.size() ? &pieces[end] : nullptr;
      runs[i] = solve_slice(job, pieces.subspan(begin, end - begin), questions, last, next);
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
