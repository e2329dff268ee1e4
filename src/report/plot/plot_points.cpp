#include "report/plot/plot_points.hpp"

#include <algorithm>
#include <cmath>

#include "report/plot/svg.hpp"

namespace counterflex {

namespace {

/// Columns of equal length; only one if the path has no length.
std::vector<PlotColumn> equal_columns(const std::vector<Stretch>& stretches, std::size_t most) {
  std::vector<PlotColumn> columns;
  const double width = stretches.back().s_mm / static_cast<double>(most);
  double number = -1;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double s = stretches[i].s_mm;
    const double own = width > 0 ? std::ceil(s / width) : 0;
    if (columns.empty() || own != number) columns.push_back({i, 0, s});
    number = own;
    ++columns.back().count;
    columns.back().s_mm = s;
  }
  return columns;
}

void append_point(std::string& data, char command, double x, double y) {
  data += command;
  append_px(data, x);
  data += ' ';
  append_px(data, y);
}

/// A single point gets a small length: line caps make it a visible dot.
std::string line_data(const std::vector<PlotPoint>& points, const PlotMap& x, const PlotMap& y) {
  std::string data;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlotPoint& p = points[i];
    append_point(data, p.begins ? 'M' : 'L', x(p.s_mm), y(p.largest));
    const bool alone = p.begins && (i + 1 == points.size() || points[i + 1].begins);
    if (alone) data += "h0.1";
  }
  return data;
}

std::string band_data(const std::vector<PlotPoint>& points, const PlotMap& x, const PlotMap& y) {
  std::string data;
  for (std::size_t i = 0; i < points.size(); ++i)
    append_point(data, i == 0 ? 'M' : 'L', x(points[i].s_mm), y(points[i].largest));
  for (std::size_t i = points.size(); i-- > 0;)
    append_point(data, 'L', x(points[i].s_mm), y(points[i].least));
  return points.empty() ? data : data + 'Z';
}

}  // namespace

PlotColumns plot_columns(const PathCurves& curves, std::size_t most) {
  PlotColumns result;
  const std::vector<Stretch>& stretches = curves.stretches();
  result.single = curves.waypoints_per_stretch() == 1 && stretches.size() <= 2 * most;
  if (!result.single) {
    result.columns = equal_columns(stretches, most);
    return result;
  }
  for (std::size_t i = 0; i < stretches.size(); ++i) result.columns.push_back({i, 1, stretches[i].s_mm});
  return result;
}

std::vector<PlotPoint> plot_points(const PathCurves& curves, const PlotColumns& columns, Quantity quantity) {
  std::vector<PlotPoint> points;
  const auto which = static_cast<std::size_t>(quantity);
  bool begins = true;
  for (const PlotColumn& column : columns.columns) {
    PlotPoint point{.s_mm = column.s_mm, .least = INFINITY, .largest = -INFINITY};
    for (std::size_t i = column.first; i < column.first + column.count; ++i) {
      const Stretch& stretch = curves.stretches()[i];
      begins = begins || (columns.single && stretch.begins_after_rapid);
      if (std::isnan(stretch.largest[which])) continue;
      point.least = std::min(point.least, static_cast<double>(stretch.least[which]));
      point.largest = std::max(point.largest, static_cast<double>(stretch.largest[which]));
    }
    if (point.largest < point.least) continue;
    point.begins = begins;
    begins = false;
    points.push_back(point);
  }
  return points;
}

std::string path_data(const std::vector<PlotPoint>& points, bool single, const PlotMap& x, const PlotMap& y) {
  return single ? line_data(points, x, y) : band_data(points, x, y);
}

}  // namespace counterflex
