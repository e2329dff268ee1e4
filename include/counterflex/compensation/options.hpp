#pragma once
/// The options of a run, and the data that all stages of compensation read.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/path_directions.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/forces/forces.hpp"
#include "counterflex/program/boxed_optional.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/program/rewrite.hpp"
#include "counterflex/statics/batch_solver.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/statics/tip_uncertainty.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

enum class Method { direct, nested, linear };
std::string_view to_string(Method method);

struct CompensationOptions {
  Method method = Method::direct;
  double tolerance = 5e-6;  ///< m: norm of the tip's controlled position error at equal fraction of a segment
  double tilt_tolerance = 0.02 * deg;      ///< rad: of the tool's axis, where the program turns the tool
  std::optional<double> spin_tolerance{};  ///< rad: about the tool's axis; a cutter does not see it
  double max_correction = 1e-3;            ///< m
  double max_turn = 1 * deg;               ///< rad: of a correction of the orientation
  double blend = 2e-3;  ///< m: 0 makes steps of the force jumps of the correction, at rapids too
  int threads = 1;
  WriteOptions write;
  /// Targets whose deviation is not above its own band stay as programmed (`targets_as_programmed`), and a
  /// place above the tolerance is accepted there.
  bool only_significant = false;
};

/// Where a turn counts as much as a shift (m/rad): one of the tolerance of tilt as one of the tolerance.
inline double lever(const CompensationOptions& options) {
  return options.tolerance / options.tilt_tolerance;
}

/// A position of the nominal tip (M, m) on a machine, and its orientation where the program gives one.
struct TipPosition {
  const Model* model = nullptr;
  Vector3 p_MT = Vector3::Zero();
  std::optional<Matrix3> R_MT{};
};

struct TipUncertainties;

/// One program on one machine. Borrowed: everything outlives the job.
struct Job {
  const Model& model;
  const Program& program;
  const Toolpath& path;  ///< wanted tip path in M, and the frames of the program's work offsets
  const PathForces& forces;
  CompensationOptions options;
  ReadOptions read;  ///< with which the program was read: its corrected text is read in the same way
  const ToolModels* tools = nullptr;    ///< of tools that make the machine another one; none: `model` is all
  const StartTables* starts = nullptr;  ///< of the kernel; none: waypoints are solved one by one
  std::optional<TipPosition> from{};    ///< of a window: where the path before it ended
  /// How actuators move along the path; none: not known, their joints do not lag.
  const PathDirections* directions = nullptr;
  const TipUncertainties* uncertainties = nullptr;  ///< none: waypoints have no covariance
  /// By number of the program's move, whether its end stays as programmed; none: no end does.
  const std::vector<bool>* as_programmed = nullptr;
  std::size_t first_move = 0;  ///< number of the window's first move in the program
};

/// Whether the end of a move of the window stays as programmed.
inline bool ends_as_programmed(const Job& job, std::size_t move) {
  return job.as_programmed != nullptr && (*job.as_programmed)[job.first_move + move];
}

/// Whether its start does: the end of the move before it.
inline bool starts_as_programmed(const Job& job, std::size_t move) {
  return job.as_programmed != nullptr && job.first_move + move > 0 &&
         (*job.as_programmed)[job.first_move + move - 1];
}

/// How actuators move at a fraction of a move, on the side that ends or begins there.
inline Directions directions_at(const Job& job, std::size_t move, double u, Side side) {
  return job.directions == nullptr ? Directions{} : job.directions->at(move, u, side);
}

/// The machine with tool number `tool` in its spindle.
const Model& model_with(const Model& model, const ToolModels* tools, long tool);

/// The machine that makes a move of the program. Nearly always there is only one: no move is looked at then.
inline const Model& model_of(const Job& job, std::size_t move) {
  if (job.tools == nullptr || job.tools->empty()) return job.model;
  return model_with(job.model, job.tools, job.program.moves[move].tool);
}
inline const Model& model_of(const Job& job, const Segment& segment) {
  return model_of(job, segment.move);
}

/// Why a run was refused: the kind of error, line of the original program, what happened, and the line of the
/// corrected program, if there is one (0: none).
struct Failure {
  ErrorKind kind = ErrorKind::not_compensated;
  int line = 0;
  std::string what;
  int corrected_line = 0;
  Status status = Status::converged;  ///< of the machine, where that is the reason
};

// Places on the path, with the deviations of the tip there.

inline constexpr std::size_t no_segment = static_cast<std::size_t>(-1);

/// One line or arc of what is written into a program, and the part [u0, u1] of a wanted segment that it
/// should follow. Positions of targets in M (m). A rapid, or a move whose start is unknown, is judged at its
/// end alone.
struct Piece {
  /// Index into Toolpath::segments; no_segment for a position reached from an unknown one.
  std::size_t segment = 0;
  std::size_t move = 0;    ///< index into Program::moves of the original
  int line = 0;            ///< of the original program
  int corrected_line = 0;  ///< of the corrected one; 0: none
  double u0 = 0, u1 = 1;
  std::size_t frame = 0;  ///< index into Toolpath::frames
  Curve commanded;
  BoxedOptional<Turn> turn{};  ///< commanded, where the program gives orientations
  bool end_only = false;
  bool exempt = false;      ///< listed as not split: its inside may miss the tolerance
  bool exempt_end = false;  ///< listed as not written in all axes: its end may miss it, too
};

/// Where a deviation comes from, and what it becomes without the force; as for a waypoint.
struct Causes {
  Vector6 geometry = Vector6::Zero();       ///< before, assembly errors alone: no force, no weight
  Vector6 load = Vector6::Zero();           ///< before, forces alone: perfect assembly, no weight
  Vector6 fixture = Vector6::Zero();        ///< before, forces on the part alone: they are not in `load`
  Vector6 gravity = Vector6::Zero();        ///< before, weights alone; zero for a machine without masses
  Vector6 superposition = Vector6::Zero();  ///< sum of these, what preloads do alone counted once
  Vector6 air = Vector6::Zero();            ///< the emitted target without force
};

/// Six-vectors: position (m), rotation vector (rad), axes of M, actual minus wanted.
struct Waypoint {
  std::size_t segment = 0;  ///< or no_segment
  double fraction = 1;      ///< of the segment; of a hole of a cycle, of its move
  std::uint32_t move = 0;   ///< index into Program::moves of the original
  int line = 0;
  bool cutting = false;
  bool between = false;  ///< a sample inside a piece
  bool place = true;     ///< of the original path: statistics of `before` and of its causes are over these
  bool exempt = false;
  bool insignificant = false;            ///< above the tolerance, and accepted: `after` is not above its band
  bool in_corner = false;                ///< on the rounding or chamfer that the control puts behind the move
  BoxedOptional<Matrix3> R_MT;           ///< wanted orientation, where the program gives one
  double weight = 0;                     ///< of the cutting length: the way from the waypoint before (m)
  double s = 0;                          ///< cutting path length (m)
  Vector3 p_MT = Vector3::Zero();        ///< wanted tip
  Vector3 direction = Vector3::Zero();   ///< unit vector of the path, zero where it has none
  Vector3 tool_axis = Vector3::UnitZ();  ///< unit, from tip to spindle
  Vector6 wrench = Vector6::Zero();      ///< acting, axes of M
  Vector6 before = Vector6::Zero();      ///< the original program's target, solved forward
  Vector6 after = Vector6::Zero();       ///< the emitted target, solved forward
  Vector6 correction = Vector6::Zero();  ///< emitted target minus the original program's
  Eigen::VectorXd rho;                   ///< actuators of the emitted target (m, rad)
  Directions directions;                 ///< in which they came there
  BoxedOptional<Causes> causes;          ///< where they were asked for and `before` is known
  BoxedOptional<Matrix6> covariance;     ///< of the deviations, where the job has uncertainties
  Status status = Status::converged;
  int iterations = 0;
  int corrected_line = 0;  ///< of the corrected program; 0: none
};

/// Whether `before` is known, and the causes where they were asked for. At other samples only `after` is.
inline bool knows_before(const Waypoint& w) {
  return w.place || !w.between;
}

/// Whether it is the place of a cycle: the bottom of its hole, or the position at which it is called.
inline bool is_place_of_cycle(const Program& program, const Waypoint& w) {
  if (w.cutting) return false;
  const Move& move = program.moves[w.move];
  if (w.segment == no_segment && move.cycle) return true;
  return w.fraction == 1 && (move.makes_hole || move.mills_at_end);
}

/// Whether the tool cuts there: on a feed move, or at the place of a cycle.
inline bool tool_cuts_at(const Program& program, const Waypoint& w) {
  return w.cutting || is_place_of_cycle(program, w);
}

/// The wanted place of a waypoint on its machine.
inline TipPosition wanted_at(const Model& model, const Waypoint& w) {
  return {&model, w.p_MT, w.R_MT ? std::optional(*w.R_MT) : std::nullopt};
}

/// The commanded orientation, where the program gives one.
inline std::optional<Matrix3> commanded_orientation(const Waypoint& w) {
  if (!w.R_MT) return std::nullopt;
  return Matrix3(exp_so3(w.correction.tail<3>()) * *w.R_MT);
}

/// What is solved besides `after`.
struct Questions {
  bool before = true;
  bool attribution = false;  ///< the causes
  bool inside = true;        ///< samples between the ends of feed pieces
  bool bands = false;        ///< starts of feed pieces are waypoints, too, and all have a covariance
};

struct ForwardRun {
  std::vector<Waypoint> waypoints;  ///< in order of pieces; samples between precede their piece's end
  std::optional<Failure> failure;   ///< the first waypoint that could not be solved
};

/// Solves the machine forward along `pieces` (programs/guide/safety.md, "What a run guarantees"): every
/// end, and samples inside feed pieces. `command`: where the piece before them ended (M, m).
///
/// The places of the original path are the ends of its segments, the starts of feed runs (see PathForces)
/// and, along feed moves, the corners of the force and equal steps of at most 5 mm (a 64th of a longer move)
/// and 22.5 degrees of an arc, on all of its turns; closer where the force turns with the arc. Where the
/// force steps, a joint reverses or the tool changes there are two: under what acts before, and under what
/// acts behind it. They do not depend on the pieces. `before` and its causes count there: all runs over one
/// program with one tolerance agree on them. Corners of a line of one step are
/// no places where the bound of its cells, with the corners, is within a tenth of the tolerance and the force
/// is not larger than at its ends.
///
/// A feed piece is sampled at the places inside it. Between neighbouring places of a line the deviation is at
/// most that at the larger of both, and what the tip bends by the bound of its cell. If that is within 0.8 of
/// the tolerance, nothing is solved between them. Otherwise the middle is sampled: a short line in its
/// middle, an arc at least every 11.25 degrees. Where the middle is off the line between the deviations
/// beside it by more than a tenth of the tolerance, or where less than a fifth of the tolerance is left, the
/// odd sixteenths between the two places are sampled, too; of a machine with knees also the places beside
/// corners of the deviation. No piece is inferred from its neighbours.
///
/// What a control puts into a corner between two pieces is sampled at 17 places or more: `in_corner`, with
/// the first of the two pieces. Its wanted way lies between the wanted curves, its command between those of
/// the pieces. `after` is across the wanted way there: the way may begin a little earlier or later.
///
/// What differs from the wanted path is a matter for the caller; only a status other than converged is a
/// failure here.
ForwardRun solve_pieces(const Job& job, std::span<const Piece> pieces, const Questions& questions,
                        const std::optional<Vector3>& command = {});

/// Takes waypoints in order, in one portion or more.
using WaypointTaker = std::function<void(std::vector<Waypoint>&&)>;

/// The same for many pieces: gives their waypoints out in portions. Returns the failure of the last waypoint.
std::optional<Failure> solve_in_portions(const Job& job, std::span<const Piece> pieces,
                                         const Questions& questions, const std::optional<Vector3>& command,
                                         const WaypointTaker& take);

/// The pieces of the original program itself, one for each place of its path.
std::vector<Piece> original_pieces(const Job& job);

/// The same, one for each move.
std::vector<Piece> original_moves(const Job& job);

}  // namespace counterflex
