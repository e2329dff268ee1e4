#pragma once
/// The parts of the plot of a path. Places on the page in px, values in mm unless said otherwise.
#include <string>
#include <vector>

#include "counterflex/report/page.hpp"
#include "plot_points.hpp"
#include "plot_ticks.hpp"

namespace counterflex {

inline constexpr double plot_left = 78, plot_right = 782;  // of the panels, on a page of 800
inline constexpr std::size_t most_steps_drawn = 100;       // of the force; more would be a grey ground

/// How one curve is drawn. Dashes differ as the colours do.
struct PlotStyle {
  const char* label;
  const char* colour;
  double width;
  const char* dash;  ///< empty: solid
  Quantity x;        ///< its component in x; those in y and z follow
};

/// The attributes that it draws with.
std::string stroke_of(const PlotStyle& style);

/// Lengths of deviations and of the path in the units that people expect.
struct PlotUnits {
  const char* deviation;
  double deviation_per_mm;
  int deviation_decimals;
  const char* path;
  double path_per_mm;
};

struct PlotPage {
  const PathCurves& curves;
  const RunReport& report;
  PlotUnits units;
  PlotColumns columns;
  PlotMap x;  ///< of path length
  double path_mm = 0;
  std::vector<PlotStyle> styles;  ///< of the upper panels

  /// "4.1 um".
  std::string deviation_text(double value_mm) const;
};

/// What is drawn, and where it ends on the page.
struct PlotPart {
  std::string svg;
  double bottom = 0;
};

/// Three panels with the components of the deviation before, and where there is a corrected program one with
/// the residual; with the axis of path lengths below.
PlotPart plot_panels(const PlotPage& page, double top);

/// The label of each curve beside a piece of it.
std::string plot_legend(const PlotPage& page, double base_line);

/// What the plot shows, in sentences.
PlotPart plot_caption(const PlotPage& page, double top);

/// The largest deviations, for those who do not see the plot.
std::string plot_description(const PlotPage& page);

}  // namespace counterflex
