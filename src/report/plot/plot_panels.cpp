#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "report/plot/plot_page.hpp"
#include "report/plot/svg.hpp"

namespace counterflex {

namespace {

constexpr double component_height = 150, residual_height = 110, panel_gap = 16, residual_gap = 36;  // px
constexpr double label_x = 15;  // of the turned label of a scale
constexpr int most_component_ticks = 5, most_residual_ticks = 4, most_path_ticks = 8;

constexpr std::string_view grid_stroke = R"( stroke="#e4e4e4")";
constexpr std::string_view zero_stroke = R"( stroke="#9a9a9a")";
constexpr std::string_view step_stroke = R"( stroke="#909090" stroke-dasharray="1 3")";
constexpr std::string_view tolerance_stroke =
    R"( stroke="#d55e00" stroke-width="1.3" stroke-dasharray="6 4")";

constexpr PlotStyle residual_style{"", "#000000", 1.3, "", Quantity::after};

/// One panel: its place and its scale.
struct PlotPanel {
  double top = 0, height = 0;
  PlotTicks ticks;  ///< in the unit of deviations
  PlotMap y;        ///< of mm

  double bottom() const { return top + height; }
};

/// The range of values, in mm.
struct PlotRange {
  double least = 0, largest = 0;
};

PlotPanel panel_at(const PlotPage& page, double top, double height, PlotRange range, int most_ticks) {
  const double per_mm = page.units.deviation_per_mm;
  const PlotTicks ticks = ticks_around(range.least * per_mm, range.largest * per_mm, most_ticks);
  const double px = height / (ticks.values.back() - ticks.values.front());
  return {top, height, ticks, {top + ticks.values.back() * px, -px * per_mm}};
}

Quantity component_of(Quantity x, int axis) {
  return static_cast<Quantity>(static_cast<int>(x) + axis);
}

/// The range of all upper panels, with zero: one scale makes them comparable.
PlotRange range_of_components(const PlotPage& page) {
  PlotRange range;
  for (const PlotStyle& style : page.styles)
    for (int axis = 0; axis < 3; ++axis)
      for (const PlotPoint& p : plot_points(page.curves, page.columns, component_of(style.x, axis))) {
        range.least = std::min(range.least, p.least);
        range.largest = std::max(range.largest, p.largest);
      }
  return range;
}

/// The range of the residual. Includes the tolerance unless the residual would then be a line at zero.
PlotRange range_of_residual(const PlotPage& page) {
  constexpr double far = 8;
  double largest = 0;
  for (const PlotPoint& p : plot_points(page.curves, page.columns, Quantity::after))
    largest = std::max(largest, p.largest);
  const double tolerance = page.report.tolerance_mm;
  if (largest == 0 || tolerance < far * largest) largest = std::max(largest, tolerance);
  return {0, largest};
}

std::string scale(const PlotPage& page, const PlotPanel& panel, const std::string& label) {
  std::string svg;
  for (const double value : panel.ticks.values) {
    const double y = panel.y(value / page.units.deviation_per_mm);
    svg += svg_line(plot_left, y, plot_right, y, value == 0 ? zero_stroke : grid_stroke);
    svg += svg_text(plot_left - 7, y + 4, Anchor::end, format_fixed(value, panel.ticks.decimals));
  }
  const double middle = panel.top + panel.height / 2;
  return svg + svg_text(label_x, middle, Anchor::middle, label,
                        fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", label_x, middle));
}

PlotTicks path_ticks(const PlotPage& page) {
  return ticks_within(0, page.path_mm * page.units.path_per_mm, most_path_ticks);
}

/// Marks of round path lengths, and of steps of the force.
std::string upright_lines(const PlotPage& page, const PlotPanel& panel) {
  std::string svg;
  for (const double s : path_ticks(page).values) {
    const double x = page.x(s / page.units.path_per_mm);
    svg += svg_line(x, panel.top, x, panel.bottom(), grid_stroke);
  }
  const PathMarks& steps = page.curves.force_steps();
  if (steps.count > most_steps_drawn) return svg;
  for (const double s : steps.s_mm)
    svg += svg_line(page.x(s), panel.top, page.x(s), panel.bottom(), step_stroke);
  return svg;
}

/// A filled band with a thin solid outline. The band of all causes together is nearly transparent, because it
/// covers the others.
std::string curve_of(const PlotPage& page, const PlotStyle& style, Quantity quantity, const PlotMap& y) {
  const auto points = plot_points(page.curves, page.columns, quantity);
  if (points.empty()) return "";
  const std::string data = path_data(points, page.columns.single, page.x, y);
  if (page.columns.single) return fmt::format("<path fill=\"none\"{} d=\"{}\"/>\n", stroke_of(style), data);
  return fmt::format(
      "<path fill=\"{0}\" fill-opacity=\"{1}\" stroke=\"{0}\" stroke-width=\"0.8\" d=\"{2}\"/>\n",
      style.colour, style.x == Quantity::before_x ? "0.06" : "0.25", data);
}

std::string frame_of(const PlotPanel& panel) {
  return fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#606060\"/>\n",
      plot_left, panel.top, plot_right - plot_left, panel.height);
}

/// Broad curves below narrow ones.
std::string component_panel(const PlotPage& page, const PlotPanel& panel, int axis) {
  std::string svg = scale(page, panel, fmt::format("in {}, {}", "xyz"[axis], page.units.deviation));
  svg += upright_lines(page, panel);
  std::vector<PlotStyle> styles = page.styles;
  std::stable_sort(styles.begin(), styles.end(),
                   [](const PlotStyle& a, const PlotStyle& b) { return a.width > b.width; });
  for (const PlotStyle& style : styles) svg += curve_of(page, style, component_of(style.x, axis), panel.y);
  return svg + frame_of(panel);
}

/// The line of the tolerance, or a note if it is outside the panel.
std::string tolerance_line(const PlotPage& page, const PlotPanel& panel) {
  const std::string text = "tolerance " + page.deviation_text(page.report.tolerance_mm);
  const double y = panel.y(page.report.tolerance_mm), text_x = plot_right - 6;
  if (y < panel.top - 0.5)
    return svg_text(text_x, panel.top + 15, Anchor::end, text + ", far above this panel");
  return svg_line(plot_left, y, plot_right, y, tolerance_stroke) +
         svg_text(text_x, y < panel.top + 16 ? y + 15 : y - 5, Anchor::end, text, " fill=\"#a04500\"");
}

PlotPart residual_panel(const PlotPage& page, double top) {
  const PlotPanel panel = panel_at(page, top, residual_height, range_of_residual(page), most_residual_ticks);
  std::string svg =
      svg_text(plot_left, top - 9, Anchor::start, "Model residual after", " font-weight=\"600\"");
  svg += scale(page, panel, fmt::format("size, {}", page.units.deviation)) + upright_lines(page, panel);
  svg += curve_of(page, residual_style, residual_style.x, panel.y);
  return {svg + tolerance_line(page, panel) + frame_of(panel), panel.bottom()};
}

PlotPart path_axis(const PlotPage& page, double top) {
  std::string svg;
  const PlotTicks ticks = path_ticks(page);
  for (const double s : ticks.values)
    svg += svg_text(page.x(s / page.units.path_per_mm), top + 17, Anchor::middle,
                    format_fixed(s, ticks.decimals));
  svg += svg_text((plot_left + plot_right) / 2, top + 36, Anchor::middle,
                  fmt::format("cutting path length, {}", page.units.path));
  return {svg, top + 36};
}

}  // namespace

PlotPart plot_panels(const PlotPage& page, double top) {
  const PlotRange range = range_of_components(page);
  PlotPart part;
  for (int axis = 0; axis < 3; ++axis, top += component_height + panel_gap)
    part.svg +=
        component_panel(page, panel_at(page, top, component_height, range, most_component_ticks), axis);
  part.bottom = top - panel_gap;
  if (page.curves.corrected()) {
    const PlotPart residual = residual_panel(page, part.bottom + residual_gap);
    part = {part.svg + residual.svg, residual.bottom};
  }
  const PlotPart axis = path_axis(page, part.bottom);
  return {part.svg + axis.svg, axis.bottom};
}

}  // namespace counterflex
