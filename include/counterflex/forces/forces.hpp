#pragma once
/// Cutting forces: profiles as shops have them, and the wrench that acts at every place of a toolpath. A
/// wrench is what the workpiece does to the tool: (fx fy fz mx my mz), N and N m.
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/forces/force_rows.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/program.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

/// What the rows of a profile are named by. A point is a logged position; it becomes a path length.
enum class ForceKey { line, block_number, path_length, time, point };

/// Wrenches by place. Stepped: each row holds until the next one, the last to the program's end. Linear:
/// between rows, to the last one; before a row that ends the cover the wrench holds.
struct ForceProfile {
  ForceKey key = ForceKey::line;
  ForceFrame frame = ForceFrame::machine;
  bool at_platform = false;  ///< acts at the reference point instead of the tip
  bool linear = false;       ///< interpolated between rows; else each row holds until the next
  ForceRows rows;
  std::optional<double> within{};    ///< of a log: how far from the path its points may lie (m)
  bool machine_coordinates = false;  ///< of a log: points in M; else coordinates of the program
  std::string file{};                ///< that holds the rows; for messages
};

/// One wrench, profile or model, and its moves. The rows of a profile select them, not `selector`.
struct ForceRule {
  std::string name;  ///< as the command line has it, or the file's; for messages
  Location where{};  ///< no file: the command line
  ForceSelector selector{};
  std::variant<ConstantForce, ForceProfile, CutResponse> content{};
};

/// Of a profile: a place.
ForceRank rank(const ForceRule& rule);

/// Of a model: the feed's.
ForceFrame frame_of(const ForceRule& rule);

/// Whether a rule's wrench is given at the platform's reference point, instead of at the tip.
bool at_platform(const ForceRule& rule);

/// Whether a rule's wrench is zero wherever it acts: it acts neither at the tip nor at the platform, and goes
/// with both.
bool is_zero(const ForceRule& rule);

/// Reads a CSV of forces: lines `# frame = machine | work | tool | feed`, `# sense = on_tool | on_workpiece`
/// (both required), `# interpolation = step | linear` (step), `# at = tip | platform` (tip); other lines that
/// begin with `#` are comments. Then a header row with the key's column, `fx_N, fy_N, fz_N` and any of
/// `mx_Nm, my_Nm, mz_Nm`, in any order; then the rows. Keys:
///
///  - `line | n | s_mm | t_s`, which must increase: one rule, a profile. A row without any number but its key
///    ends the cover;
///  - `x_mm, y_mm, z_mm`, logged positions in the order in which they were logged: the same, with settings
///    `# within_mm = 1` and `# coordinates = work | machine`;
///  - `tool` (3 or T3) or `op` (in double quotes where it has commas): one rule a row, in any order.
///
/// Forces on the workpiece change their sign. Throws `InputError` (ErrorKind::machine_or_force) naming the
/// row.
std::vector<ForceRule> read_force_csv(std::string_view text, const std::string& file);

/// The same for a file of any size, in memory that does not grow with the rows of a profile.
std::vector<ForceRule> read_force_csv(FileReader& bytes, const std::string& file);

/// The rules of a TOML file of cutting models, one a section. Throws as `read_cutting_model`.
std::vector<ForceRule> read_force_toml(std::string_view text, const std::string& file);

/// "FX,FY,FZ[,MX,MY,MZ]" in N and N m. Throws `InputError` (ErrorKind::usage).
Vector6 parse_force(std::string_view text);

/// The rule of one `--force`: a wrench for all moves, or "T3=FX,FY,FZ[,MX,MY,MZ]" for those of a tool. Throws
/// as `parse_force`.
ForceRule parse_force_rule(std::string_view text);

/// Where the forces of a run come from: of these rules and the program's FORCE comments, which are rules for
/// places, the most specific one that covers a move acts on it.
struct ForceSource {
  std::vector<ForceRule> rules{};
  /// m; what acts is the mean over the last min(blend, half of the feed run) of feed path.
  double blend = 2e-3;
  double scale = 1.0;
  /// Z of program coordinates: feed moves wholly above it carry no force.
  std::optional<double> air_above_mm{};
  bool is_shared = false;  ///< by several programs: rules may name tools that a program lacks
};

/// Whether the wrenches act at the platform's reference point instead of the tip: all that are not zero do.
bool acts_at_platform(const ForceSource& source);

/// Whether a rule's frame turns with the tool.
bool needs_tool_axes(const ForceSource& source);

/// Half of the last digit of forces (N) and moments (N m) in reports.
inline constexpr double shown_force = 0.05, shown_moment = 0.005;

struct ForceNote {
  int line = 0;
  std::string what;
};

/// A feed move without a force, and why: no force is given, the given force is zero, no force can act there,
/// or its position is not known; `length` is that of the move (m), 0 for the hole of a cycle, NaN where it is
/// not known.
struct Unforced {
  int line = 0;
  double length = 0;
  std::string why;
};

/// The wrench before blending, linear over [s0, s1] of cutting path length (m), machine axes; `integral` is
/// that from the start of its feed run to s0 (N m, N m2).
struct ForcePiece {
  double s0 = 0;
  double s1 = 0;
  Vector6 F0 = Vector6::Zero();
  Vector6 F1 = Vector6::Zero();
  Vector6 integral = Vector6::Zero();
  bool goes_on = false;      ///< smoothly from the piece before it: its start is not a corner
  bool is_constant = false;  ///< known to be: F0 and F1 are the same
};

/// Feed moves between two rapids: cutting path length [s0, s1] (m), pieces and corners [first, end).
struct FeedRun {
  double s0 = 0;
  double s1 = 0;
  double blend = 0;  ///< m
  std::size_t first_piece = 0;
  std::size_t end_piece = 0;
  std::size_t first_corner = 0;
  std::size_t end_corner = 0;
};

/// A feed run that may continue behind a window, and the wrench that still acts there.
struct OpenRun {
  FeedRun run;
  Vector3 end = Vector3::Zero();   ///< where it has come, M (m)
  std::vector<ForcePiece> pieces;  ///< over the last blend of it, and its corners there
  std::vector<double> corners;
};

/// What the forces of one window leave to those of the next.
struct ForceTail {
  std::optional<OpenRun> open;
  std::optional<long> block_number;  ///< N of the moves so far
};

/// The place on a path where its forces were last read. The next read is fast where its place is near. Any
/// cursor gives the same answers.
struct ForceCursor {
  std::size_t from = 0, to = 0;             ///< pieces in which a mean begins and ends
  std::size_t corner = 0, ramp_corner = 0;  ///< corners behind a segment's start, and those a blend before
};

/// Whether a cycle drills a hole with a move, in a place that is known.
inline bool drills(const Move& move) {
  const bool makes_hole = move.cycle ? move.cycle->repeats > 0 : move.makes_hole;
  return makes_hole && move.known_end[0] && move.known_end[1];
}

/// Fractions closer than this to the end of a segment, or to each other, are the same place.
inline constexpr double same_fraction = 1e-9;

/// The side of a step on which a wrench is read. A place within `same_fraction` of a step is at the step.
enum class Side { before, after };

/// The wrench along a toolpath, machine axes, blended. A wrench in the feed frame turns with the tangent of
/// an arc: its pieces follow it to within 1e-4, without corners. Built once in linear time, then read from
/// any thread; a query costs the logarithm of the number of moves.
///
/// With b = min(blend, half of the feed run), u the path length and f the unblended wrench, zero before the
/// run:
///
///     F(s) = 1/b int_(s-b)^s f(u) du
///
/// A feed run is a sequence of cutting segments that join, without a rapid between.
///
/// The hole of a cycle is not on the path. Its bottom has the wrench of a plunge with the move's feed,
/// which is constant: the value of f there. Profiles, whose keys are places of the path, have none.
/// Retracts have no force.
class PathForces {
 public:
  /// `R_MT` gives the wanted orientation of the tool in the machine frame: one for all, one a segment, or for
  /// each segment as many, at equal fractions from its start to its end, between which the tool turns evenly.
  /// Throws what `ForceCover` throws.
  PathForces(const ForceSource& source, const Program& program, const Toolpath& path,
             const std::vector<Matrix3>& R_MT);

  /// The same for a window of a program, behind the one that has left `before`. `source` has been settled by
  /// `ForceCover`. `R_at_holes`: the tool's orientation at the hole of each move that `drills`, in order;
  /// empty: the first of `R_MT`.
  PathForces(const ForceSource& source, const Program& window, const Toolpath& path,
             const std::vector<Matrix3>& R_MT, const ForceTail& before,
             const std::vector<Matrix3>& R_at_holes = {});

  /// Whether what follows the window changes nothing in it: its last feed run has ended, or is long enough.
  bool is_final() const { return is_final_; }

  /// What the next window needs.
  const ForceTail& tail() const { return tail_; }

  /// Wrench at `fraction` (0 to 1) of a segment; zero in rapid moves, but for the end of one at which a cycle
  /// drills. Steps occur with blend 0 only. At the ends of a segment the wrench is the segment's own for any
  /// `side`: `at(i, 1)` is that before a step between two segments, `at(i + 1, 0)` that after it.
  Vector6 at(std::size_t segment, double fraction, Side side = Side::after) const;
  Vector6 at(std::size_t segment, double fraction, Side side, ForceCursor& cursor) const;

  /// Wrench at the bottom of the hole that a cycle drills with a move of the window; zero for other moves.
  Vector6 in_hole(std::size_t move) const;

  /// Whether a segment is the first of its feed run.
  bool begins_run(std::size_t segment) const;

  /// Whether a segment's start is the end of the one before it, with the same wrench.
  bool follows(std::size_t segment) const;

  /// Whether the wrench steps where a segment begins inside its feed run.
  bool begins_with_step(std::size_t segment) const;

  /// Whether the wrench is linear between breaks: what is blended has steps, and no slopes.
  bool is_linear_between_breaks() const { return is_linear_between_breaks_; }

  bool at_platform() const { return at_platform_; }

  /// Fractions strictly inside a segment where the wrench has a corner or a step, increasing: no smooth
  /// interpolation across them. With a blend these are the starts and ends of ramps, and where the profile
  /// changes its slope and a blend behind it: between them the mean is a parabola. Where a component of a
  /// parabola is larger or less inside than at both ends by what reports show is a fraction, too.
  std::vector<double> breaks(std::size_t segment) const;
  /// The same in `fractions`, whose memory is used again.
  void breaks(std::size_t segment, ForceCursor& cursor, std::vector<double>& fractions) const;

  /// How many breaks all segments have, about.
  std::size_t count_of_breaks() const { return 2 * corners_.size(); }

  const std::vector<ForceNote>& notes() const { return notes_; }

  /// Feed moves of the window without a force, in order.
  const std::vector<Unforced>& unforced() const { return unforced_; }

  /// Steps that the mean turned into ramps, and steps that act as steps (blend 0). The entry into a feed run,
  /// from no force to the first one, is a step.
  std::size_t ramps() const { return ramps_; }
  std::size_t jumps() const { return jumps_; }
  double largest_step_N() const { return largest_step_N_; }
  const std::vector<double>& steps() const { return steps_; }  ///< where all of these are: path lengths (m)

 private:
  /// Where a segment lies.
  struct Place {
    double s0 = 0;
    double s1 = 0;
    std::size_t run = 0;   ///< `no_run` for a rapid
    std::size_t move = 0;  ///< index into Program::moves
  };

  void take_up(const OpenRun& before);
  void close_run(double blend);
  void find_corners(FeedRun& run);
  void add_extremes(const Place& place, ForceCursor& cursor, std::vector<double>& fractions) const;
  void leave_tail(const Program& window, const Toolpath& path, double blend);

  bool at_platform_ = false;
  std::vector<ForcePiece> pieces_;
  std::size_t taken_up_ = 0;  ///< of them, from the window before
  std::vector<double> corners_;
  std::vector<FeedRun> runs_;
  std::vector<Place> places_;
  std::vector<std::pair<std::size_t, Vector6>> holes_;  ///< by move, in order: those with a force
  std::vector<ForceNote> notes_;
  std::vector<Unforced> unforced_;
  ForceTail tail_;
  bool is_final_ = true;
  bool is_linear_between_breaks_ = true;
  std::size_t ramps_ = 0, jumps_ = 0;
  double largest_step_N_ = 0;
  std::vector<double> steps_;
};

/// Whether the rules have one force for every feed move of a program, gathered window by window before
/// anything is solved. Some sources need the program more than once:
///
///     ForceCover cover(source);
///     while (cover.needs_pass()) {
///       for (each window) cover.add(window, path);
///       cover.end_pass();
///     }
///
/// Each function throws `InputError` (ErrorKind::machine_or_force, or ErrorKind::usage for the command line)
/// at the row or section that is wrong: two of equal rank that cover one move; one that names what the
/// program has not; a key that the program cannot have; a logged position far from the path or out of order.
/// A feed move that no rule covers is named at its line.
class ForceCover {
 public:
  /// Makes path lengths of the logged positions in `source`, which outlives this. Throws where wrenches at
  /// the tip and at the platform would meet in one run.
  explicit ForceCover(ForceSource& source);
  ~ForceCover();

  bool needs_pass() const;

  /// The next window of the pass.
  void add(const Program& window, const Toolpath& path);

  /// Behind the last window.
  void end_pass();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The wrench of each feed move as its rule gives it, before the mean over the path is taken.

/// From path length s (m) on: a wrench in the feed frame (N, N m).
struct ForceStep {
  double s = 0;
  Vector6 F = Vector6::Zero();
};

/// The torque of a cut about the tool's axis: of the chip, in proportion to K_tc, and of the edge (N m).
struct CutTorque {
  double chip = 0, edge = 0;
};

/// A feed move and the wrench in its middle.
struct MoveForce {
  int line = 0;
  long tool = 0;       ///< 0: none known
  double s_start = 0;  ///< cutting path length at its start (m); NaN: its position is not known
  double length = 0;   ///< m; NaN: not known
  double feed_m_s = 0;
  double spindle_rpm = 0;       ///< the model's own where one acts, else the program's
  double feed_per_tooth = 0;    ///< m; 0: no cutting model acts
  Vector6 F = Vector6::Zero();  ///< on the tool, scaled, axes of the feed frame (N, N m)
  bool only_z = false;   ///< no feed across the tool, but F acts across it: only its part along it is known
  bool comment = false;  ///< the program's FORCE comment covers it
  bool comment_altered = false;  ///< and the scale, or a bound of the air, makes another force of its own
  bool changes = false;          ///< the wrench is not the same all along the move: `F` is that in the middle
  double largest_N = 0;          ///< of the force anywhere on the move
  std::vector<ForceStep> steps;  ///< what acts, from the start on; none where it changes between steps
  const ForceRule* model = nullptr;  ///< whose cutting model acts in the middle, of the source
  /// Torques of this model in equal parts of the move, not scaled: in one part where they are even. A part
  /// without a force has none.
  std::vector<std::optional<CutTorque>> torques;
  std::string why;  ///< empty: F acts; else why no force acts
};

/// The feed moves of a window that is not the first: `block_number` is N of the moves before, and then of
/// these. `R_MT` as for `PathForces`; `source` has been settled by `ForceCover`. Throws `InputError` as
/// `PathForces` does.
std::vector<MoveForce> move_forces(const ForceSource& source, const Program& window, const Toolpath& path,
                                   const std::vector<Matrix3>& R_MT, std::optional<long>& block_number);

}  // namespace counterflex
