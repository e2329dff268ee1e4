#pragma once
/// Assigns each row of a log to a pass of the tool.
#include <optional>
#include <vector>

namespace counterflex {

/// A place where the path comes near a row's point.
struct Visit {
  double s = 0;        ///< path length (m)
  double squared = 0;  ///< distance from the point (m2)
};

/// One visit of every row, by path length.
struct OrderedPlaces {
  std::vector<double> s;             ///< never decreases
  std::optional<std::size_t> stuck;  ///< a row that the path passes only before the rows above it
};

/// Chooses one visit for each row so that path lengths do not decrease and the sum of squared distances is
/// least. `rows` has the visits of each row in order of path length. Positions are measured: a visit may be
/// up to `within` before that of the row above. It is then moved to that place, with the largest distance.
/// Among equal sums chooses the one that ends earliest with the closest rows.
OrderedPlaces in_order(const std::vector<std::vector<Visit>>& rows, double within);

}  // namespace counterflex
