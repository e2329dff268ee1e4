#pragma once
/// Curves of a path, reduced to the points that a plot has room for.
#include <string>
#include <vector>

#include "counterflex/report/path_curves.hpp"

namespace counterflex {

/// A point of the drawn path: one stretch, or a column of several.
struct PlotColumn {
  std::size_t first = 0, count = 0;  ///< stretches
  double s_mm = 0;                   ///< its place: the end of its last stretch
};

struct PlotColumns {
  std::vector<PlotColumn> columns;
  bool single = true;  ///< each column is one waypoint, and a rapid interrupts a curve
};

/// `most`: largest number of columns.
PlotColumns plot_columns(const PathCurves& curves, std::size_t most);

/// A value of a curve.
struct PlotPoint {
  double s_mm = 0;
  double least = 0, largest = 0;
  bool begins = false;  ///< after a rapid, or the first point
};

/// The curve of one quantity, without columns of unknown value.
std::vector<PlotPoint> plot_points(const PathCurves& curves, const PlotColumns& columns, Quantity quantity);

/// Maps values to px: `px(v)` is `offset + factor v`.
struct PlotMap {
  double offset = 0, factor = 1;
  double operator()(double value) const { return offset + factor * value; }
};

/// The points as the data of an SVG path: lines if each point is one value, else the outline of the band
/// between least and largest.
std::string path_data(const std::vector<PlotPoint>& points, bool single, const PlotMap& x, const PlotMap& y);

}  // namespace counterflex
