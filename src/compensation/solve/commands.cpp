#include "compensation/solve/commands.hpp"

#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {

std::string_view to_string(Method method) {
  return method == Method::direct ? "direct" : method == Method::nested ? "nested" : "linear";
}

const Model& model_with(const Model& model, const ToolModels* tools, long tool) {
  if (tools == nullptr) return model;
  const auto found = tools->find(tool);
  return found == tools->end() ? model : found->second;
}

Vector3 in_words_mm(const Job& job, const Move& move, const Vector3& target) {
  return inverse(job.path.frames[move.frame].X_MW) * target / mm;
}

Vector3 position_of_words(const Job& job, const Move& move, const Vector3& words_mm) {
  return job.path.frames[move.frame].X_MW * (words_mm * mm);
}

Vector3 original_command(const Job& job, std::size_t frame, const Vector3& p_MT) {
  return p_MT - job.path.frames[frame].datum_shift;
}

Vector3 target_of(const Job& job, const Move& move) {
  return position_of_words(job, move, move.end_mm);
}

Curve command_of(const Job& job, const Move& move) {
  return curve_in(job.path.frames[move.frame].X_MW, move);
}

std::optional<Matrix3> orientation_of(const Job& job, const Move& move) {
  if (!move.orientation) return std::nullopt;
  return Matrix3(job.path.frames[move.frame].X_MW.R * orientation_at(turn_of(*move.orientation), 1));
}

std::optional<Turn> turn_of(const Job& job, const Move& move) {
  if (!move.orientation) return std::nullopt;
  return job.path.frames[move.frame].X_MW.R * turn_of(*move.orientation);
}

std::optional<OrientationNumbers> turned_words(const Job& job, const Move& move, double u,
                                               const Vector3& turn) {
  if (!move.orientation) return std::nullopt;
  const OrientationNumbers original = numbers_at(*move.orientation, u);
  if (turn.isZero(0)) return original;
  const Vector3 in_program = job.path.frames[move.frame].X_MW.R.transpose() * turn;
  const OrientationForm form = move.orientation->form;
  return numbers_of(form, exp_so3(in_program) * rotation_of(form, original), original);
}

Vector3 wanted_of(const Job& job, const Move& move) {
  return wanted_frame(job.path.frames[move.frame]) * (move.end_mm * mm);
}

Vector3 hole_of(const Move& move) {
  return move.cycle ? bottom_of_hole(move, 1) : move.end_mm;
}

bool chooses_height_by_retract(const Program& program, const Move& hole) {
  const CycleMove& cycle = *hole.cycle;
  // Where the end is not known, nor is the height where the series began.
  return program.dialect == "linuxcnc" && !cycle.begins_series && !cycle.returns_to_retract &&
         hole.known_start[2] && (!hole.known_end[2] || hole.start_mm.z() < cycle.initial_mm);
}

bool keeps_retract_above_tool(const Program& program, const Move& hole) {
  const CycleMove& cycle = *hole.cycle;
  if (program.dialect != "linuxcnc" || !hole.known_start[2] || cycle.retract_mm < hole.start_mm.z())
    return false;
  return leaves_at_high_retract(hole) || chooses_height_by_retract(program, hole);
}

bool leaves_at_high_retract(const Move& hole) {
  return !hole.cycle->returns_to_retract && hole.cycle->retract_mm >= hole.cycle->initial_mm;
}

namespace {

Piece piece_without_segment(const Job& job, const Move& original, const Vector3& commanded) {
  return {.segment = no_segment,
          .move = static_cast<std::size_t>(&original - job.program.moves.data()),
          .line = original.line,
          .frame = original.frame,
          .commanded = {commanded, commanded, {}},
          .end_only = true};
}

}  // namespace

Piece piece_of_hole(const Job& job, const Move& original, const Move& found, double u) {
  Piece piece =
      piece_without_segment(job, original, position_of_words(job, original, bottom_of_hole(found, u)));
  piece.u0 = piece.u1 = u;
  return piece;
}

Piece piece_of_end(const Job& job, const Move& original, const Move& found) {
  Piece piece = piece_without_segment(job, original, target_of(job, found));
  if (const std::optional<Matrix3> R = orientation_of(job, found)) piece.turn = Turn{*R, *R, {}};
  return piece;
}

TipPosition wanted_at(const Job& job, const Piece& piece, double u, const Model& model) {
  if (piece.segment != no_segment) {
    const Segment& segment = job.path.segments[piece.segment];
    return {&model, point_at(segment.wanted, u), orientation_at(segment, u)};
  }
  const Move& move = job.program.moves[piece.move];
  if (move.cycle)
    return {&model, wanted_frame(job.path.frames[move.frame]) * (bottom_of_hole(move, u) * mm), {}};
  return {&model, wanted_of(job, move), orientation_of(job, move)};
}

OutermostCommands outermost_commands(const Job& job, std::span<const Waypoint> waypoints) {
  OutermostCommands commands;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Waypoint& w = waypoints[i];
    const Model& model = model_of(job, w.move);
    if (w.status != Status::converged || model.mechanism.controlled.empty()) continue;
    const Move& move = job.program.moves[w.move];
    const auto add = [&](const Vector3& original) {
      commands.positions.push_back({&model, original + w.correction.head<3>(), commanded_orientation(w)});
      commands.waypoints.push_back(i);
    };
    if (w.segment != no_segment && move.arc && !w.R_MT) {
      const double u_before = i > 0 && waypoints[i - 1].move == w.move ? waypoints[i - 1].fraction : 0;
      const Curve& wanted = job.path.segments[w.segment].wanted;
      for (const double u : outermost_fractions(wanted))
        if (u > u_before && u < w.fraction) add(original_command(job, move.frame, point_at(wanted, u)));
    }
    if (!w.cutting && w.fraction == 1)
      for (const Vector3& p_mm : places_of_cycle(move)) add(position_of_words(job, move, p_mm));
  }
  return commands;
}

std::vector<std::optional<Eigen::VectorXd>> actuators_at(const Job& job,
                                                         std::span<const TipPosition> positions) {
  std::vector<std::optional<Eigen::VectorXd>> actuators(positions.size());
  const std::vector<NominalResult> there = PlaceSolver(job).nominals(positions);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (there[i].status == Status::converged)
      actuators[i] = actuator_values(positions[i].model->mechanism, there[i].configuration);
  return actuators;
}

}  // namespace counterflex
