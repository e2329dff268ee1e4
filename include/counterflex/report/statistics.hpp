#pragma once
/// How far the tip is off along a path, in a few numbers. Lengths in mm and angles in degrees, as reports
/// show them.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/forces/forces.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/boxed_optional.hpp"

namespace counterflex {

/// Deviations that differ by less than this are equally large where the largest is named: solvers for
/// different processors agree to a hundredth of it.
inline constexpr double indistinct_mm = 1e-7;

/// Bands of deviations, k = 2 (see `band`), where covariances are known.
struct BandStatistics {
  double at_max_mm = 0;   ///< of the largest deviation
  double largest_mm = 0;  ///< the widest band of all
  int largest_line = 0;
  /// Over the cutting length; empty without one.
  std::optional<double> rms_mm{};
  std::optional<double> below_percent{};  ///< of that length: the deviation is not larger than its band
};

struct DeviationStatistics {
  double max_mm = 0;  ///< largest norm of the position deviation
  /// Rms, mean and p95 of that norm weigh every sample by its share of the cutting length. Empty where no
  /// sample has a weight, as in a program of holes.
  std::optional<double> rms_mm{};
  std::optional<double> mean_mm{};
  /// On 95 % of the length the norm is not larger; at most 0.1 % above the exact value.
  std::optional<double> p95_mm{};
  int max_line = 0;  ///< where the norm is largest; the first such line; 0 where there was no sample
  Vector3 max_axis_mm = Vector3::Zero();  ///< largest absolute value by axis of the machine
  double max_rotation_deg = 0;            ///< largest rotation angle
  double max_along_mm = 0;                ///< along the path
  double max_across_mm = 0;     ///< across the path, square to the tool axis too: the error of a wall
  double max_tool_axis_mm = 0;  ///< along the tool axis: the error of a floor
  std::optional<BandStatistics> bands{};
};

/// One place where the deviation is known.
struct DeviationSample {
  /// Actual minus wanted: position (m), rotation vector (rad), axes of M.
  Vector6 deviation = Vector6::Zero();
  Vector3 direction = Vector3::Zero();   ///< unit vector of the path in M, zero where it has none
  Vector3 tool_axis = Vector3::UnitZ();  ///< unit, axes of M
  double weight = 0;                     ///< share of the cutting length (m); 0 counts in the maxima alone
  int line = 0;
  const Matrix6* covariance = nullptr;  ///< of the deviation; none: not known
};

/// Parts of a position deviation, not negative, in its unit. `across` is square to path and tool axis; where
/// these are parallel (a plunge) or the path has no direction, it is all that is square to the tool axis. The
/// three are components of an orthogonal frame wherever the tool axis is square to the path.
struct DeviationSplit {
  double along = 0;
  double across = 0;
  double tool_axis = 0;
};
DeviationSplit split_deviation(const Vector3& d, const Vector3& direction, const Vector3& tool_axis);

/// Weights by bin number, in memory that grows with the span of numbers alone.
class Histogram {
 public:
  void add(int bin, double weight);

  /// Calls `take(bin, weight)` for each bin with a weight, in their order.
  template <typename Take>
  void each(const Take& take) const {
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] > 0) take(first_ + static_cast<int>(i), weights_[i]);
  }

 private:
  int first_ = 0;
  std::vector<double> weights_;  ///< of bin `first_` and those behind it
};

/// Collects samples one by one, in memory that does not grow with their number. `p95` comes from a
/// logarithmic histogram with bins of 0.1 %.
class DeviationTally {
 public:
  void add(const DeviationSample& sample);

  /// As if the samples of `later` had been added after those of this one.
  void merge(const DeviationTally& later);

  /// All zero before the first sample.
  DeviationStatistics statistics() const;

  std::size_t samples() const { return samples_; }

 private:
  double percentile(double share) const;

  DeviationStatistics maxima_;
  double weight_ = 0, sum_ = 0, sum_of_squares_ = 0;               ///< m, m mm, m mm2
  double band_weight_ = 0, below_ = 0, sum_of_squared_bands_ = 0;  ///< m, m, m mm2
  double weight_of_none_ = 0;                                      ///< of samples without a deviation
  Histogram weight_by_bin_;
  std::size_t samples_ = 0;
};

// What the tilt of a tool does beside its tip: at the rim of the cutter, and along its flank.

/// The size of a tool (m); unknown dimensions are empty.
struct ToolSize {
  long number = 0;  ///< in the program; 0: none known
  std::optional<double> diameter{};
  std::optional<double> flute{};  ///< length of the cutting edges, from the tip along the axis
};

/// The largest displacement (m) of a circle of `radius` around the tool's axis, `height` above the tip
/// towards the spindle, where the tip's deviation is (d, phi):
///
///     max over alpha of |d + phi x r|,   r = height a + radius (cos(alpha) u + sin(alpha) v)
///
/// a, u and v unit vectors, u and v square to the axis a. A turn of the tool about its own axis is left out:
/// it moves no point of the surface that the turning cutter sweeps. With phi square to a the second part of
/// phi x r lies along a and reaches radius |phi| on either side, so that the maximum is
///
///     sqrt(|b - (d.a) a|^2 + (|d.a| + radius |phi|)^2),   b = d + height phi x a
double largest_on_circle(const Vector6& deviation, const Vector3& axis, double radius, double height);

/// The largest deviations of a tool along a path: of its tip, of the rim at its tip, and of its flank where
/// the cutting edges end. Lengths in mm, angles in degrees; rim and flank are empty where the tool's size is
/// not known.
struct ToolDeviation {
  double tip_mm = 0;
  std::optional<double> rim_mm{}, flank_mm{};
  double tilt_deg = 0;  ///< of the tool's axis
  int line = 0;         ///< where the largest of tip, rim and flank is; the first such line

  double largest_mm() const;
};

/// Collects the deviations of one tool.
class ToolDeviationTally {
 public:
  void add(const ToolSize& size, const Vector6& deviation, const Vector3& axis, int line);

  /// Empty before the first one.
  const std::optional<ToolDeviation>& largest() const { return largest_; }

 private:
  std::optional<ToolDeviation> largest_;
};

// The verdict of a run: one word for all feed moves of a program, and what it is derived from.

enum class Verdict {
  ok,                 ///< every feed move that was read is within the tolerance
  predicted,          ///< `predict`: every feed move was solved; its deviation is not judged
  partly,             ///< some feed moves miss the tolerance, or their deviation is unknown
  nothing_corrected,  ///< no feed move was corrected, or the program has no move
  failed,             ///< the run stopped: a target was not solved, a limit exceeded, a corrected move missed
};

/// "OK", "PREDICTED", "PARTLY", "NOTHING CORRECTED", "FAILED".
std::string_view to_string(Verdict verdict);

/// The feed moves of a program, by what a run knows of them: lines, arcs, holes of cycles (which
/// have no length) and blocks that are not followed and may cut, as calls that are not expanded. A move that
/// goes nowhere does not count.
struct FeedMoves {
  std::size_t count = 0;           ///< all that were read
  std::size_t within = 0;          ///< every place that was solved is within the tolerance
  std::size_t missed = 0;          ///< some place is not
  std::size_t unknown = 0;         ///< the deviation is not known
  std::size_t unknown_length = 0;  ///< of `unknown`: the length is not known either
  std::size_t known_ends = 0;      ///< of `unknown`: the end was corrected
  double length_mm = 0;            ///< of all moves whose length is known
  double within_mm = 0;            ///< of it, pieces that are within the tolerance everywhere
  double worst_mm = 0;             ///< largest deviation of the controlled position
  int worst_line = 0;              ///< 0: nothing was solved
  std::size_t rapid_ends = 0;      ///< ends of rapids that were solved
};

/// Of a run that did not fail.
Verdict verdict_of(const FeedMoves& moves);

/// "54 % of the cutting length, worst 0.0095 mm > 0.005, 12 feed moves of unknown length": why a run is
/// `partly`.
std::string partly_reason(const FeedMoves& moves, double tolerance_mm);

/// "OK", or "PARTLY (REASON)".
std::string verdict_text(Verdict verdict, std::string_view reason);

// Counts the feed moves of a program by what a run knows of them, window by window.

class FeedTally {
 public:
  /// The moves of the next window.
  void add_window(const Job& window);

  /// A waypoint of the window that was added last; waypoints come in the order of its moves. `miss`: see
  /// `position_miss` (m).
  void add(const Waypoint& w, double miss, const Job& window);

  /// Without `within_mm`: pieces of lines and arcs are measured elsewhere.
  FeedMoves moves() const;

 private:
  /// The feed moves and holes of a move.
  struct Parts {
    std::uint32_t count = 0;
    std::uint32_t known_lengths = 0;
    std::uint32_t measured = 0;
  };

  static void add_unknown(const std::vector<Parts>& window, FeedMoves& moves);
  void add_measured(std::size_t move, bool is_within);

  FeedMoves moves_;                     ///< unknown ones: of the windows before
  std::vector<Parts> parts_;            ///< of the moves of the window
  std::optional<std::size_t> segment_;  ///< of the last waypoint of a feed move
  bool missed_ = false;                 ///< that move misses the tolerance
};

// Feed moves that are cut without a force, gathered in memory that does not grow with their number.

/// All of one reason.
struct WithoutForceReason {
  std::string why;
  std::size_t moves = 0;
  std::size_t unknown_length = 0;  ///< of them
  double length_mm = 0;            ///< of the others
  int first_line = 0;              ///< the least
};

/// One of them.
struct WithoutForceRow {
  int line = 0;
  double length_mm = 0;  ///< NaN: not known
  std::string why;
};

struct WithoutForce {
  std::size_t moves = 0;
  std::size_t unknown_length = 0;  ///< of them
  double length_mm = 0;            ///< of the others
  /// As they were first met; where there are more than `listed_at_most` the last one represents all others.
  std::vector<WithoutForceReason> reasons;
  Capped<WithoutForceRow> rows;
};

/// Adds the next one of the program.
void add_unforced(WithoutForce& without, const Unforced& move);

}  // namespace counterflex
