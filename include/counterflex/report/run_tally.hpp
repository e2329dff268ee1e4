#pragma once
/// What a run did, gathered window by window in memory that does not grow with the program.
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/report/path_curves.hpp"
#include "counterflex/report/report.hpp"
#include "counterflex/report/statistics.hpp"
#include "counterflex/sanity/checks.hpp"

namespace counterflex {

// From waypoints to numbers, waypoint by waypoint, in memory that does not grow with their number.

/// What is known of the feed move or cycle of a waypoint besides its path.
struct MoveFacts {
  Vector3 common_shift = Vector3::Zero();  ///< of its work offset where no datum is stated (m)
  ToolSize tool;
  bool is_hole = false;  ///< or another place of a cycle: it has no length
  bool is_own = true;    ///< corrected on its own, if at all: not held, nor with its contour
};

/// The deviations of one tool.
struct ToolTally {
  ToolSize size;
  ToolDeviationTally before, after;
};

struct Measures {
  DeviationTally before, after, geometry, load, gravity, superposition;
  DeviationTally rest;              ///< before, without the common shift
  std::map<long, ToolTally> tools;  ///< by number
  DeviationTally preloads, fixture;
  DeviationTally without_force;
  double worst_mm = -1;                    ///< the largest `before`
  std::optional<SourcesAtWorst> at_worst;  ///< there, where the causes are known
  UnknownCauses without_causes;
  Largest air, correction;
  double largest_N = 0, largest_Nm = 0;
  double path_mm = 0;
  double corrected_mm = 0;  ///< of it, pieces that are within the tolerance everywhere
  double accepted_mm = 0;   ///< of it, pieces that are within it or insignificant everywhere
  std::size_t segments_changed =
      0;  ///< moves, each corrected on its own, whose target is not the original one
};

/// The moves of a tool and an operation, wherever they are in the program.
struct OperationTally {
  DeviationTally before, after;
  int first_line = 0, last_line = 0;
  std::size_t moves = 0;
  double length_mm = 0, corrected_mm = 0;  ///< of feed moves, and of these whole pieces within the tolerance
  std::optional<std::pair<std::size_t, int>> last_move;  ///< segment and line
};

/// Rows by line, one a line, of which the worst are wanted. From the 4096th line on all are forgotten now and
/// then but the worst and the two asked for last: lines that come in order lose nothing, and one that comes
/// back much later (a subprogram called again) starts again from zero.
class WorstLines {
 public:
  /// The row of `line`, made where it is missing.
  WorstRow& row(int line);

  /// At most ten rows, the largest `key` first; of equal ones the smaller line.
  std::vector<WorstRow> worst(double WorstRow::*key) const;

 private:
  void keep_the_worst();

  std::vector<WorstRow> rows_;  ///< by line
  int last_ = 0, last_but_one_ = 0;
};

/// Waypoints that were not solved are ignored. Feed moves and places of cycles alone, but for `correction`
/// and `segments_changed`. They come in the order of the path; a segment is known by its number and line, so
/// that numbers may start again with every window.
class PathTally {
 public:
  /// `operation` counts from 0, as the caller does; `no_operation`: it is not known.
  static constexpr std::int32_t no_operation = -1;
  /// `facts`: of a feed move or a cycle. `is_within`: the tolerance, what the tip's controlled position
  /// misses there.
  void add(const Waypoint& w, std::int32_t operation = no_operation, const MoveFacts& facts = {},
           bool is_within = true);

  /// Of all waypoints so far, the last of which ends the path.
  Measures measures() const;
  std::vector<WorstRow> worst(double WorstRow::*key) const;
  std::vector<OperationTally> operations() const;  ///< by their numbers; one that has no feed move is empty

 private:
  /// A place of the original path, and what it weighs so far, in all and in its own operation.
  struct End {
    Waypoint at;
    std::int32_t operation = no_operation;
    double weight = 0, weight_there = 0;
    MoveFacts facts{};
  };

  void add_target(const Waypoint& w, bool is_own);
  void add_cutting(const Waypoint& w, std::int32_t operation, const MoveFacts& facts, bool is_within);
  void add_to_operation(const Waypoint& w, std::int32_t operation);
  void close_piece(const Waypoint& w, std::int32_t operation);
  void add_place(const Waypoint& w, std::int32_t operation, const MoveFacts& facts);
  void share_piece(const Waypoint& w, std::int32_t operation, double share);
  ToolTally& tally_of(const ToolSize& tool);
  OperationTally* tally_of(std::int32_t operation);
  void finish_end();
  void measure_end(const End& end);
  void measure_causes(const Waypoint& w, const Causes& causes, double weight);

  Measures m_;
  WorstLines lines_;
  std::optional<std::pair<std::size_t, int>> last_changed_;  ///< move and line
  bool piece_missed_ = false;   ///< somewhere the piece under way misses the tolerance
  bool piece_refused_ = false;  ///< somewhere it does so significantly
  double piece_weight_ = 0;     ///< of the piece under way
  /// Of the way since the last place of the original path: all means but those of `after` are over these
  /// places.
  double place_weight_ = 0;
  std::optional<End> end_;  ///< the last one
  std::vector<OperationTally> operations_;
};

/// The tools and operations of a program as they are met, at most `listed_at_most`: beyond that the last one
/// represents all others.
class OperationNames {
 public:
  struct Name {
    long tool = 0;
    std::string operation;
  };

  /// The number of the operation of a window's move.
  std::int32_t number_of(const Program& window, const Move& move);

  const std::vector<Name>& names() const { return names_; }

 private:
  std::vector<Name> names_;
  std::int32_t last_ = -1;
};

/// Collects what stays as programmed.
class AsProgrammedTally {
 public:
  /// The next waypoint of a run with `only_significant`. `cuts`: `tool_cuts_at` it.
  void add(const Waypoint& w, bool cuts);
  const AsProgrammed& found() const { return found_; }

 private:
  AsProgrammed found_;
  double move_mm_ = 0;  ///< feed length of the move under way
  bool stays_ = false;  ///< from the end of the move before on it has no correction
};

/// Each part is added in the order of the program. Where it is cut into windows changes nothing in the
/// report.
class RunTally {
 public:
  /// `min_block_ms`: feed moves that take less are short blocks (RunFacts).
  /// `curves`: where the path is to be drawn, too. `tools`: what is known of their sizes.
  explicit RunTally(double min_block_ms, std::optional<PathCurves> curves = {},
                    std::vector<ToolSize> tools = {});

  /// The next waypoints of the path, cut anywhere; of the operations of their moves nothing is known.
  void add_waypoints(const std::vector<Waypoint>& waypoints);

  /// The same for waypoints of the window that was added last, or some of them: those of a corner together.
  /// Lists corners that miss the tolerance.
  void add_waypoints(const std::vector<Waypoint>& waypoints, const Job& window);

  /// The next window's moves and forces, before its waypoints.
  void add_window(const Job& window);

  /// The next window's: its ramps, jumps, moves without a force and notes are added to those before.
  void add_forces(const PathForces& forces);

  /// The next window's counts, left-alone blocks, narrowed contours and size of text. Neither its waypoints
  /// nor its `corrected`.
  void add_compensation(const Compensation& compensation);

  /// The failure of the first contour that the tool passes as programmed, but not as it is written.
  std::optional<Failure> contour_failure(const Compensation& compensation) const;

  /// The next window of the corrected program as it was read back, after `ignore_axes`: whole lines, with
  /// line numbers of the corrected program. An empty program counts, too:
  /// nothing is added only where no program was written.
  void add_corrected(const Program& corrected_window);

  const PathTally& path() const { return path_; }
  FeedMoves feed_moves() const;
  const TravelTally& travel() const { return travel_; }  ///< of waypoints that came with their window
  const FeedForceTally& feed_force() const { return feed_force_; }
  const std::optional<PathCurves>& curves() const { return curves_; }
  const std::vector<OperationNames::Name>& operation_names() const { return operation_names_.names(); }
  LengthUnit unit() const { return unit_.value_or(LengthUnit::millimetres); }  ///< of the first feed move
  const ForceSummary& forces() const { return forces_; }  ///< of ramps, jumps, steps and moves without one
  const Capped<Remark>& direction_notes() const { return direction_notes_; }
  const Capped<Remark>& contour_notes() const { return contour_notes_; }
  const Capped<Remark>& force_notes() const { return force_notes_; }
  const Capped<LeftAlone>& left_alone() const { return left_alone_; }
  std::size_t corrected_moves() const { return corrected_moves_; }
  const OtherMoves& other_moves() const { return other_moves_; }
  const std::optional<Capped<ReversalRow>>& reversals() const { return reversals_; }
  const std::optional<AsProgrammedTally>& as_programmed() const { return as_programmed_; }
  std::size_t inserted_blocks() const { return inserted_blocks_; }
  std::size_t text_bytes() const { return text_bytes_; }  ///< of compensated text

  /// Of the corrected program; none before `add_corrected`.
  const std::optional<LineLengths>& lines() const { return lines_; }
  const std::optional<ShortBlocks>& short_blocks() const { return short_blocks_; }
  const std::optional<Zones>& zones() const { return zones_; }

 private:
  void add(const Waypoint& w, std::int32_t operation, const MoveFacts& facts, bool is_within);
  void add_to_travel(const std::vector<Waypoint>& waypoints, const Job& window);
  void add_as_programmed(const Waypoint& w, bool cuts);
  void list_corners(const std::vector<Waypoint>& waypoints, const Job& window);
  void add_reversals(const Job& window);
  ToolSize size_of(long tool) const;
  ToolSize size_in(const NarrowedContour& contour) const;
  MoveFacts facts_of(const Job& window, const Waypoint& w) const;

  double min_block_ms_;
  std::vector<ToolSize> tools_;
  PathTally path_;
  FeedTally feed_;
  TravelTally travel_;
  FeedForceTally feed_force_;
  std::optional<PathCurves> curves_;
  OperationNames operation_names_;
  std::optional<LengthUnit> unit_;
  ForceSummary forces_;
  Capped<Remark> contour_notes_;  ///< of contours that are narrowed
  Capped<Remark> force_notes_;
  Capped<Remark> direction_notes_;  ///< of reversals
  Capped<LeftAlone> left_alone_;
  OtherMoves other_moves_;
  std::optional<Capped<ReversalRow>> reversals_;
  std::optional<AsProgrammedTally> as_programmed_;  ///< with `only_significant`
  std::size_t corrected_moves_ = 0, inserted_blocks_ = 0, text_bytes_ = 0;
  std::optional<LineLengths> lines_;
  std::optional<ShortBlocks> short_blocks_;
  std::optional<Zones> zones_;
};

}  // namespace counterflex
