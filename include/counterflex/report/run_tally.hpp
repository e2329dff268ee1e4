#pragma once
/// What a run did, gathered window by window in memory that does not grow with the program.
#include <optional>
#include <vector>

#include "counterflex/compensation/compensate.hpp"
#include "counterflex/report/feed_tally.hpp"
#include "counterflex/report/path_curves.hpp"
#include "counterflex/report/path_tally.hpp"
#include "counterflex/report/report.hpp"
#include "counterflex/sanity/path_checks.hpp"

namespace counterflex {

/// The tools and operations of a program as they are met, at most `listed_at_most`: the last one stands for
/// all others then.
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

  /// The same for waypoints of a window, or some of them.
  void add_waypoints(const std::vector<Waypoint>& waypoints, const Job& window);

  /// The next window's moves and forces, before its waypoints.
  void add_window(const Job& window);

  /// The next window's: its ramps, jumps, moves without a force and notes are added to those before.
  void add_forces(const PathForces& forces);

  /// The next window's counts, left-alone blocks, largest correction and size of text. Neither its waypoints
  /// nor its `corrected`.
  void add_compensation(const Compensation& compensation);

  /// The next window of the corrected program as it was read back, its axes that nobody corrects made known
  /// (`ignore_axes`): whole lines, with line numbers of the corrected program. An empty program counts, too:
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
  const Capped<Remark>& force_notes() const { return force_notes_; }
  const Capped<LeftAlone>& left_alone() const { return left_alone_; }
  const Largest& largest_correction() const { return largest_correction_; }
  std::size_t corrected_moves() const { return corrected_moves_; }
  const OtherMoves& other_moves() const { return other_moves_; }
  std::size_t inserted_blocks() const { return inserted_blocks_; }
  std::size_t text_bytes() const { return text_bytes_; }  ///< of compensated text

  /// Of the corrected program; none before `add_corrected`.
  const std::optional<LineLengths>& lines() const { return lines_; }
  const std::optional<ShortBlocks>& short_blocks() const { return short_blocks_; }

 private:
  void add(const Waypoint& w, std::int32_t operation, const MoveFacts& facts, bool is_within);
  void add_to_travel(const Waypoint& w, const Job& window);
  MoveFacts facts_of(const Job& window, const Segment& segment) const;

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
  Capped<Remark> force_notes_;
  Capped<LeftAlone> left_alone_;
  Largest largest_correction_;
  OtherMoves other_moves_;
  std::size_t corrected_moves_ = 0, inserted_blocks_ = 0, text_bytes_ = 0;
  std::optional<LineLengths> lines_;
  std::optional<ShortBlocks> short_blocks_;
};

}  // namespace counterflex
