#pragma once
/// Programs of any length on a machine, window by window: predict, compensate and verify.
#include <cstddef>
#include <functional>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/program/program_reader.hpp"

namespace counterflex {

/// Moves that are not corrected each on its own.
struct OtherMoves {
  std::size_t grouped = 0;  ///< with their contour, by one motion in its plane
  std::size_t held = 0;     ///< they keep the correction with which they are entered
  std::size_t in_part = 0;  ///< in some axes, or without their force
  std::size_t left = 0;     ///< they are not changed
};

/// A contour under G41 or G42 whose blocks are divided beside an inner corner, so that less room is left
/// there for the control's offset by the radius of the tool.
struct NarrowedContour {
  int line = 0;                              ///< of the divided block that leaves the least room
  std::int32_t tool = 0;                     ///< `Move::tool`
  double programmed_mm = 0, written_mm = 0;  ///< largest radius that passes the corners of the contour
  std::optional<double> diameter_mm{};       ///< of the tool, by D of G41.1 or G42.1
};

/// What comes of a window. The kind of a failure is `not_compensated` (not solved, or not within the
/// tolerance), `limit` (travel or correction) or `usage` (too few decimals).
struct Compensation {
  std::optional<Failure> failure;   ///< then `text` must not be written
  std::string text;                 ///< the corrected program
  Program corrected;                ///< `text`, read again
  std::vector<Waypoint> waypoints;  ///< of the emitted, rounded text; of windows that are not given out
  /// What the plan could not correct or split, besides the program's own list.
  std::vector<LeftAlone> left_alone;
  std::vector<NarrowedContour> narrowed;  ///< contours of the window
  Rewritten counts;                       ///< its text is moved to `text`
  /// Each on its own. Of a verification those alone that have no waypoint: of the others the waypoints have
  /// the correction.
  std::size_t corrected_moves = 0;
  OtherMoves other_moves;
};

/// The failure of words that are written too coarsely for the tolerance (ErrorKind::usage), if there are any.
std::optional<Failure> decimals_failure(const Program& program, const Toolpath& path,
                                        const CompensationOptions& options);

/// The controlled part of a waypoint's `after`: what the tolerance applies to (m).
double position_miss(const Job& job, const Waypoint& w);

/// Whether a miss (m) is within the tolerance of position, up to the noise of the arithmetic.
bool is_within_tolerance(const CompensationOptions& options, double miss);

/// The larger of the shares that a deviation (m, rad; axes of M) has in the tolerances of position, and of
/// tilt and spin where the orientation `R_MT` is given.
double share_of_tolerance(const CompensationOptions& options, const Mechanism& mechanism,
                          const BoxedOptional<Matrix3>& R_MT, const Vector6& deviation);

/// Whether `after` is at most `share` of its own band, k = 2: the controlled position of its band, and where
/// the program gives the orientation tilt (and spin, if that has a tolerance) of its tolerance or its band.
/// False without a covariance.
bool is_below_band(const Job& job, const Waypoint& w, double share = 1);

/// The failure of the first waypoint that misses the tolerance in a move that the plan corrects (not
/// `exempt`, not `insignificant`).
std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints);

/// The part of a tolerance (m) that rounding words to their digits takes: half the last digit times sqrt 3.
double rounding_allowance(const Move& move, const WriteOptions& options);

/// What all windows of a run have in common. Borrowed: everything outlives it.
struct RunInput {
  const Model& model;
  const std::vector<WorkFrame>& frames;  ///< by index into the program's work offsets, all of them
  const std::array<bool, 3>& ignored;    ///< program axes that no target needs (`ignore_axes`)
  const ForceSource& source;
  const CompensationOptions& options;
  const ReadOptions& read;
  const ToolModels* tools = nullptr;                ///< as for a job
  const StartTables* starts = nullptr;              ///< as for a job
  Directions first_directions{};                    ///< of actuators before they have moved:
                                                    ///< `first_directions`
  const TipUncertainties* uncertainties = nullptr;  ///< as for a job
  /// Wanted turn about the spindle axis at the end of each move of the program (rad), by its number; see
  /// `best_spins`. None: as programmed.
  const std::vector<double>* spins = nullptr;
  const std::vector<bool>* as_programmed = nullptr;  ///< as for a job
};

// Orientations of the nominal tool along a program, with which the forces of a run are computed.

/// Orientations of the tool in M on the path of a window, as `PathForces` takes them: one for all if every
/// move has home's; else as many for each segment, at equal fractions. A place that the machine does not
/// reach has home's.
std::vector<Matrix3> tool_orientations(const RunInput& input, const Program& window, const Toolpath& path);

/// The same at the hole of each move that `drills`, in order.
std::vector<Matrix3> tool_orientations_at_holes(const RunInput& input, const Program& window);

/// A window with its path and forces. It does not change while others are read.
struct JobWindow {
  Program program;
  Toolpath path;
  std::optional<PathForces> forces;
  std::optional<TipPosition> from;  ///< as for a job
  PathDirections directions{};      ///< of a machine with reversals
  std::size_t first_move = 0;       ///< as for a job
};

/// In which direction each actuator moves first on the path of a program: of a machine with reversals.
/// `input` has the directions that are known before. Reads `reader` as far as necessary.
Directions first_directions(const RunInput& input, ProgramReader& reader);

/// Reads the windows of a run, and carries path and forces from one to the next.
class JobWindows {
 public:
  JobWindows(const RunInput& input, ProgramReader& reader);

  /// Reads the next window, which is as long as its forces need; false at the program's end. The memory of
  /// `window` is used again. Throws `InputError` as reader and forces do.
  bool next(JobWindow& window);
  Job job(const JobWindow& window) const;
  const RunInput& input() const { return input_; }

 private:
  void build(JobWindow& window) const;

  const RunInput input_;
  ProgramReader& reader_;
  std::size_t moves_ = 0;  // before the window
  std::size_t part_;       // divides the size of the next window
  PathEnd path_end_{};
  ForceTail forces_{};
  std::optional<TipPosition> tip_{};
  DirectionsEnd directions_{};
};

/// Functions that are called with the windows of a run, each by one thread at a time.
struct WindowEvents {
  /// A window has been read, perhaps while others before it are still being solved. What this throws is
  /// thrown by the run when all windows before it are done.
  std::function<void(const Job&)> read;
  /// In the order of windows, before `solved` and `done`: all windows before it are done.
  std::function<void(const Job&)> begun;
  /// Waypoints of the window in order, in one portion or more.
  std::function<void(const Job&, const std::vector<Waypoint>&)> solved;
  /// The window is done, or has failed. Its waypoints have been given to `solved`.
  std::function<void(const Job&, Compensation&)> done;
};

/// Each of the following takes all windows of a run to the first that fails, and returns its failure. An
/// `InputError` is thrown when all windows before it are done. Several windows are in progress at once on
/// `threads` threads. Events, their numbers and bytes do not depend on `threads`. Behind a window that fails
/// only `read` may be called.

/// Solves the original program forward.
std::optional<Failure> predict_windows(JobWindows& windows, int threads, const WindowEvents& events);

/// The same, sampled as closely as a verification, with a covariance at each waypoint.
std::optional<Failure> predict_bands(JobWindows& windows, int threads, const WindowEvents& events);

/// Compensates a program. `corrected` reads the text that is written. With `attribution` each waypoint has
/// its causes.
std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution, const WindowEvents& events);

/// Judges a corrected program by its text alone, however many places miss the tolerance: returns the failure
/// of the first window that cannot be matched or solved, else the first miss of the tolerance. `corrected` is
/// read to its end.
std::optional<Failure> verify_windows(JobWindows& windows, int threads, ProgramReader& corrected,
                                      bool attribution, const WindowEvents& events);

/// Calls `first` and then `behind` for all windows of `reader`, each in their order. With more than one
/// thread, `behind` looks at a window while the next one is read and `first` looks at that. What `behind`
/// gets is without remarks and path tolerances (`take_window`). Throws what the reader or either of them
/// throws.
void for_each_window(ProgramReader& reader, int threads, const std::function<void(const Program&)>& first,
                     const std::function<void(const Program&)>& behind);

}  // namespace counterflex
