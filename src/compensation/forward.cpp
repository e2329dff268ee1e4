#include <algorithm>
#include <cmath>

#include "counterflex/compensation/waypoint.hpp"
#include "path_solver.hpp"
#include "track.hpp"

namespace counterflex {
namespace {

constexpr std::size_t pieces_at_once = 64 * chunk_size;
constexpr int odd_sixteenths = 8;
constexpr double quiet_share =
    0.1;  // of the tolerance: pieces whose correction changes less are sampled once inside

// Solves the pieces of one chunk forward, one after another.
class ForwardSolver {
 public:
  ForwardSolver(const Job& job, const Questions& questions, const NominalTrack& track)
      : job_(job), questions_(questions), track_(track), solvers_(job) {}

  // `begins_anew`: the command jumped there, so that no piece before has been judged at its start.
  bool solve(const Piece& piece, bool begins_anew, ForwardRun& out) {
    piece_ = &piece;
    if (piece.segment == no_segment)
      position_ = {.line = piece.line, .frame = piece.frame, .wanted = {piece.wanted, piece.wanted, {}}};
    segment_ = piece.segment == no_segment ? &position_ : &job_.path.segments[piece.segment];
    take_model();
    if (questions_.inside && !piece.end_only) {
      const int count = samples();
      // Without a blend the force may begin with a step, which no end of a piece before sees either.
      if ((begins_anew || job_.options.blend == 0) && !solve_at(0, true, 0, out)) return false;
      for (int k = 0; k < count; ++k)
        if (!solve_at((2 * k + 1) / (2.0 * count), true, 1.0 / (count + 1), out)) return false;
      return solve_at(1, false, 1.0 / (count + 1), out);
    }
    return solve_at(1, false, 1, out);
  }

 private:
  void take_model() {
    const bool position = piece_->segment == no_segment;
    const Model& model =
        position ? model_with(job_.model, job_.tools, piece_->tool) : model_of(job_, *segment_);
    if (!solvers_.is_of(model))
      solver_ = &solvers_.of(model, position ? model.home : track_.start_before(piece_->segment));
  }

  // A piece along which the correction hardly changes is sampled once.
  int samples() const {
    const auto correction = [this](double v) {
      const double u = piece_->u0 + v * (piece_->u1 - piece_->u0);
      return Vector3(point_at(piece_->commanded, v) - point_at(segment_->wanted, u));
    };
    const double quiet = quiet_share * job_.options.tolerance;
    const Vector3 c0 = correction(0);
    bool changes = (correction(1) - c0).norm() > quiet;
    for (int k = 1; segment_->wanted.arc && k < odd_sixteenths; ++k)
      changes = changes || (correction(k / static_cast<double>(odd_sixteenths)) - c0).norm() > quiet;
    return changes ? odd_sixteenths : 1;
  }

  // Deviation of the tip from the wanted pose for a command; false with a failure where it is not solved.
  bool deviate(const Vector3& target, const Load& load, const Stage& stage, Start start, Vector6& result) {
    const ActualSolution actual = solver_->actual(target, load, stage, start);
    iterations_ += actual.iterations;
    status_ = actual.status;
    if (actual.status == Status::converged) result = deviation(actual.X_MT, wanted_);
    return actual.status == Status::converged;
  }

  bool attribute(const Vector3& original, const Vector3& emitted, const Load& load, Waypoint& w) {
    Vector6 unloaded_perfect;
    const auto solve = [this](const Vector3& target, const Load& with, const Stage& stage, Vector6& result) {
      return deviate(target, with, stage, Start::nominal, result);
    };
    if (!solve(original, {}, {.load = 0, .gravity = 0}, w.geometry) ||
        !solve(original, load, {.errors = 0, .gravity = 0}, w.load) ||
        !solve(original, {}, {.errors = 0, .load = 0, .gravity = 0}, unloaded_perfect) ||
        !solve(emitted, {}, {.load = 0}, w.air))
      return false;
    w.superposition = w.geometry + w.load - unloaded_perfect;
    if (!has_weight(solver_->model().mechanism)) return true;
    if (!solve(original, {}, {.errors = 0, .load = 0}, w.gravity)) return false;
    w.superposition += w.gravity - unloaded_perfect;
    return true;
  }

  // Beside `after`, which has just been solved. A force under which the machine gives way is no failure of
  // the run: it does not act.
  OtherForce under(double factor, const Load& load, const Vector6& after) {
    if (load.F.isZero(0)) return {after, Status::converged};
    const ActualSolution actual = solver_->under_another_load({factor * load.F, load.at_platform});
    if (actual.status != Status::converged) return {Vector6::Zero(), actual.status};
    return {deviation(actual.X_MT, wanted_), actual.status};
  }

  // Between ends, where only the largest deviation counts, the lower force is taken to do the opposite of the
  // higher one: half of the time for what differs in second order.
  void vary(const Load& load, bool between, Waypoint& w) {
    w.higher = under(1 + force_change, load, w.after);
    if (between && w.higher.status == Status::converged)
      w.lower.deviation = 2 * w.after - w.higher.deviation;
    else
      w.lower = under(1 - force_change, load, w.after);
  }

  bool solve_at(double v, bool between, double share, ForwardRun& out) {
    const double u = piece_->u0 + v * (piece_->u1 - piece_->u0);
    const Vector3 emitted = point_at(piece_->commanded, v);
    Waypoint w;
    w.p_MT = point_at(segment_->wanted, u);
    const Load load = piece_->segment == no_segment
                          ? Load{}
                          : Load{job_.forces.at(piece_->segment, u, v == 0 ? Side::after : Side::before),
                                 job_.forces.at_platform()};
    describe(u, between, share, load, w);
    iterations_ = 0;
    wanted_ = solver_->wanted(w.p_MT, status_);
    const Vector3 original = w.p_MT - job_.path.frames[segment_->frame].datum_shift;
    // What is written is proven from the nominal configuration on; samples between its ends begin at their
    // neighbour.
    const Start start = between ? Start::neighbour : Start::nominal;
    bool solved = status_ == Status::converged && deviate(emitted, load, {}, start, w.after);
    if (solved && !solver_->in_travel()) {
      status_ = Status::outside_travel;
      solved = false;
    }
    if (solved && questions_.attribution) vary(load, between, w);
    if (solved && !between && questions_.before)
      solved = deviate(original, load, {}, Start::neighbour, w.before);
    if (solved && !between && questions_.attribution) solved = attribute(original, emitted, load, w);
    w.correction.head<3>() = emitted - original;
    w.status = status_;
    w.iterations = iterations_;
    out.waypoints.push_back(w);
    if (!solved) out.failure = status_failure(status_, segment_->line);
    return solved;
  }

  void describe(double u, bool between, double share, const Load& load, Waypoint& w) const {
    w.segment = piece_->segment;
    w.fraction = u;
    w.line = segment_->line;
    w.cutting = segment_->cutting;
    w.between = between;
    w.exempt = between ? piece_->exempt : piece_->exempt_end;
    w.weight = segment_->cutting ? share * (piece_->u1 - piece_->u0) * length(segment_->wanted) : 0;
    w.s = segment_->s_start + u * (segment_->s_end - segment_->s_start);
    w.direction = direction_at(segment_->wanted, u);
    w.tool_axis = tip(solver_->model().mechanism, solver_->nominal()).R.col(2);
    w.wrench = load.F;
  }

  const Job& job_;
  const Questions& questions_;
  const NominalTrack& track_;
  ToolSolver solvers_;
  PathSolver* solver_ = nullptr;
  const Piece* piece_ = nullptr;
  Segment position_;  // stands for a segment where there is none
  const Segment* segment_ = nullptr;
  Pose wanted_;
  Status status_ = Status::converged;
  int iterations_ = 0;
};

}  // namespace

ForwardRun solve_forward_from(const Job& job, const NominalTrack& nominal, std::span<const Piece> pieces,
                              const Questions& questions, const std::optional<Vector3>& command) {
  std::vector<ForwardRun> runs(chunk_count(pieces.size()));
  for_each_chunk(pieces.size(), job.options.threads, [&](const Chunk& chunk) {
    ForwardSolver solver(job, questions, nominal);
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      const std::optional<Vector3> last = i == 0 ? command : pieces[i - 1].commanded.end;
      const bool begins_anew = last != pieces[i].commanded.start;
      if (!solver.solve(pieces[i], begins_anew, runs[chunk.index])) return;
    }
  });
  ForwardRun all;
  for (ForwardRun& run : runs) {
    all.waypoints.insert(all.waypoints.end(), run.waypoints.begin(), run.waypoints.end());
    if (!run.failure) continue;
    all.failure = run.failure;
    break;
  }
  return all;
}

ForwardRun solve_forward_along(const Job& job, const std::vector<Piece>& pieces, const Questions& questions,
                               ForwardState& state) {
  const NominalTrack nominal = track(job, state.nominal.value_or(home_of(job.model)));
  if (nominal.failure) return {{}, nominal.failure};
  ForwardRun run = solve_forward_from(job, nominal, pieces, questions, state.command);
  state.nominal = nominal.end;
  if (!pieces.empty()) state.command = pieces.back().commanded.end;
  return run;
}

ForwardRun solve_forward_along(const Job& job, const std::vector<Piece>& pieces, const Questions& questions) {
  ForwardState state;
  return solve_forward_along(job, pieces, questions, state);
}

std::optional<Failure> solve_forward_in_portions(const Job& job, const std::vector<Piece>& pieces,
                                                 const Questions& questions, const TakeWaypoints& take) {
  const NominalTrack nominal = track(job, home_of(job.model));
  if (nominal.failure) return nominal.failure;
  std::optional<Vector3> command;
  const std::span<const Piece> all(pieces);
  for (std::size_t begin = 0; begin < all.size(); begin += pieces_at_once) {
    const auto portion = all.subspan(begin, std::min(pieces_at_once, all.size() - begin));
    const ForwardRun run = solve_forward_from(job, nominal, portion, questions, command);
    take(run.waypoints);
    if (run.failure) return run.failure;
    command = portion.back().commanded.end;
  }
  return std::nullopt;
}

std::vector<Piece> original_pieces(const Job& job, double spacing) {
  std::vector<Piece> pieces;
  for (std::size_t s = 0; s < job.path.segments.size(); ++s) {
    const Segment& segment = job.path.segments[s];
    std::vector<double> ends;
    if (segment.cutting) {
      ends = job.forces.breaks(s);
      const auto count =
          std::max<long>(1, std::lround(std::ceil((segment.s_end - segment.s_start) / spacing)));
      for (long k = 1; k < count; ++k) ends.push_back(static_cast<double>(k) / static_cast<double>(count));
      std::sort(ends.begin(), ends.end());
    }
    ends.push_back(1);
    double u0 = 0;
    for (double u : ends) {
      if (u <= u0) continue;
      const Pose back{Matrix3::Identity(), -job.path.frames[segment.frame].datum_shift};
      pieces.push_back({.segment = s,
                        .line = segment.line,
                        .u0 = u0,
                        .u1 = u,
                        .frame = segment.frame,
                        .commanded = back * stretch(segment.wanted, u0, u),
                        .end_only = !segment.cutting});
      u0 = u;
    }
  }
  return pieces;
}

}  // namespace counterflex
