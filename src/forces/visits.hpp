#pragma once
/// Which pass of the tool each row of a log belongs to.
#include <optional>
#include <vector>

namespace counterflex {

/// The path comes near a row's point.
struct Visit {
  double s = 0;        ///< path length (m)
  double squared = 0;  ///< distance from the point (m2)
};

/// One visit of every row, by path length.
struct OrderedPlaces {
  std::vector<double> s;             ///< never decreases
  std::optional<std::size_t> stuck;  ///< a row that the path passes only before those above it
};

/// Chooses the visits, given for each row by growing path length, whose path lengths do not decrease and
/// whose squared distances have the least sum. Positions are measured: a visit may lie up to `within` before
/// that of the row above; it then counts as far away, and is put where that row is. Of equal sums the one
/// that ends earliest, and whose rows follow each other most closely.
OrderedPlaces in_order(const std::vector<std::vector<Visit>>& rows, double within);

}  // namespace counterflex
