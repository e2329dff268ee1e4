#pragma once
/// Cutting forces: profiles as shops have them, and the wrench that acts at every place of a toolpath. A wrench is what
/// the workpiece does to the tool: (fx fy fz mx my mz), N and N m.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/program.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

enum class ForceKey { line, block_number, path_length, time };
enum class ForceFrame { machine, work, tool, feed };

struct ForceRow {
  double key = 0;  ///< line, N, m or s
  Vector6 F = Vector6::Zero();  ///< on the tool, axes of the profile's frame
  Location where;
};

struct ForceProfile {
  ForceKey key = ForceKey::line;
  ForceFrame frame = ForceFrame::machine;
  bool at_platform = false;  ///< acts at the reference point instead of the tip
  bool linear = false;       ///< interpolated between rows; else each row holds until the next
  std::vector<ForceRow> rows;
};

/// Reads a CSV profile (DESIGN.md, "Force profiles"). Throws `InputError` (Exit::machine_or_force) naming the row.
ForceProfile read_force_csv(std::string_view text, const std::string& file);

/// "FX,FY,FZ[,MX,MY,MZ]" in N and N m. Throws `InputError` (Exit::usage).
Vector6 parse_force(std::string_view text);

/// Where the forces of a run come from; at most one of `constant` and `profile`. Neither: the program's comments.
struct ForceSource {
  std::optional<Vector6> constant;  ///< machine axes, at the tip
  std::optional<ForceProfile> profile;
  double blend = 2e-3;  ///< m; what acts is the mean over the last min(blend, half of the feed run) of feed path
  double scale = 1.0;
};

struct ForceNote {
  int line = 0;
  std::string what;
};

/// The wrench along a toolpath, machine axes, blended. Built once, then read from any thread.
class PathForces {
 public:
  /// `R_MT` gives the wanted orientation of the tool in the machine frame, one a segment, or one for all.
  /// Throws `InputError` (Exit::machine_or_force) naming the row whose key lies beyond the program or is missing.
  PathForces(const ForceSource& source, const Program& program, const Toolpath& path,
             const std::vector<Matrix3>& R_MT);

  /// Wrench at `fraction` (0 to 1) of a segment; zero in rapid moves.
  Vector6 at(std::size_t segment, double fraction) const;

  bool at_platform() const { return at_platform_; }

  /// Fractions strictly inside a segment where the wrench has a corner or a step: no smooth interpolation across them.
  std::vector<double> breaks(std::size_t segment) const;

  const std::vector<ForceNote>& notes() const { return notes_; }
  std::size_t ramps() const { return ramps_; }   ///< steps of the profile that the mean turned into ramps
  std::size_t jumps() const { return jumps_; }   ///< steps that act as steps (blend 0)
  double largest_step_N() const { return largest_step_N_; }

 private:
  /// The unblended wrench, linear over [s0, s1] of cutting path length, with the run's integral up to s0.
  struct Piece {
    double s0, s1;
    Vector6 F0, F1, integral;
  };
  /// Feed moves between two rapids.
  struct Run {
    double s0, s1, blend;
    std::size_t first_piece, last_piece;
  };
  bool at_platform_ = false;
  std::vector<Piece> pieces_;
  std::vector<Run> runs_;
  std::vector<std::size_t> run_of_segment_;
  std::vector<Segment> segments_;
  std::vector<ForceNote> notes_;
  std::size_t ramps_ = 0, jumps_ = 0;
  double largest_step_N_ = 0;
};

}  // namespace counterflex
