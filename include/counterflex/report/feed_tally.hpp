#pragma once
/// Counts the feed moves of a program by what a run knows of them, window by window.
#include <optional>

#include "counterflex/compensation/options.hpp"
#include "counterflex/compensation/waypoint.hpp"
#include "counterflex/report/verdict.hpp"

namespace counterflex {

class FeedTally {
 public:
  /// The moves of the next window.
  void add_window(const Job& window);

  /// A waypoint of that window; waypoints come in the order of its moves. `miss`: see `position_miss` (m).
  void add(const Waypoint& w, double miss, const Job& window);

  /// Without `within_mm`: pieces of lines and arcs are measured elsewhere.
  FeedMoves moves() const;

 private:
  const Move* move_without_segment(const Waypoint& w, const Program& program);
  void add_measured(bool is_within);

  FeedMoves moves_;
  std::size_t known_lengths_ = 0;
  std::optional<std::size_t> segment_;  ///< of the last waypoint of a feed move
  bool missed_ = false;                 ///< that move misses the tolerance
  std::size_t next_ = 0;                ///< moves before it have no more waypoints
};

}  // namespace counterflex
