#pragma once
/// The parts of the plot of a path. Places on the page are in px, values in mm unless a unit is stated.
#include <string>
#include <vector>

#include "counterflex/report/page.hpp"
#include "report/plot/plot_points.hpp"
#include "report/plot/plot_ticks.hpp"

namespace counterflex {

inline constexpr double plot_left = 78, plot_right = 782;  // of the panels, on a page of 800
inline constexpr std::size_t most_steps_drawn = 100;       // of the force; more lines would be a grey area

/// The style of a curve. Each curve has its own dashes and colour.
struct PlotStyle {
  const char* label;
  const char* colour;
  double width;
  const char* dash;  ///< empty: solid
  Quantity x;        ///< its component in x; those in y and z follow
};

/// The SVG attributes of a style.
std::string stroke_of(const PlotStyle& style);

/// Units of deviations and of path lengths, as usual for the program.
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

  /// A length with its unit, as "4.1 µm" or "0.16 mil".
  std::string deviation_text(double value_mm) const;
};

/// An SVG fragment, and its lower end on the page.
struct PlotPart {
  std::string svg;
  double bottom = 0;
};

/// Three panels with the components of the deviation before, and where there is a corrected program one with
/// the residual; with the axis of path lengths below.
PlotPart plot_panels(const PlotPage& page, double top);

/// The label of each curve beside a sample of its line, in as many rows as they need.
PlotPart plot_legend(const PlotPage& page, double base_line);

/// The caption of the plot.
PlotPart plot_caption(const PlotPage& page, double top);

/// The largest deviations in words, for screen readers.
std::string plot_description(const PlotPage& page);

}  // namespace counterflex
