#include <fmt/core.h>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/report/page.hpp"
#include "report/plot/plot_page.hpp"
#include "report/plot/svg.hpp"
#include "report/tally/causes.hpp"

namespace counterflex {

namespace {

constexpr std::size_t most_columns = 704;  // one per px
constexpr std::size_t title_width = 80;    // characters

// Colours of Okabe and Ito, which colour-blind readers can distinguish. The superposition is a broad line
// below the thin line of all causes together: both are visible where they coincide.
constexpr PlotStyle superposition_style{"superposition", "#e69f00", 4.2, "5 6", Quantity::superposition_x};
constexpr std::array<PlotStyle, all_causes.size()> cause_styles{{
    {"geometry alone", "#0072b2", 1.8, "", all_causes[0].curve},
    {"load alone", "#d55e00", 1.8, "9 4", all_causes[1].curve},
    {"fixture alone", "#56b4e9", 1.8, "12 3 2 3", all_causes[2].curve},
    {"gravity alone", "#009e73", 1.8, "2 4", all_causes[3].curve},
    {"preloads alone", "#cc79a7", 1.8, "6 2 2 2", all_causes[4].curve},
}};
constexpr PlotStyle together_style{"acting together", "#000000", 1.3, "", Quantity::before_x};

std::vector<PlotStyle> styles_of(const RunReport& report) {
  if (!report.sources) return {together_style};
  std::vector<PlotStyle> styles;
  for (std::size_t i = 0; i < all_causes.size(); ++i)
    if ((*report.sources).*all_causes[i].statistics) styles.push_back(cause_styles[i]);
  styles.insert(styles.end(), {superposition_style, together_style});
  return styles;
}

PlotUnits units_of(const ShownUnits& units) {
  if (units.program == LengthUnit::inches) return {"inch", mm / inch, 5, "inch", mm / inch};
  if (units.revolute) return {"mm", 1, 4, "mm", 1};
  return {"\u00b5m", 1000, 1, "mm", 1};
}

PlotPage page_of(const PathCurves& curves, const RunReport& report) {
  const auto& stretches = curves.stretches();
  const double path = stretches.empty() ? 0 : stretches.back().s_mm;
  return {.curves = curves,
          .report = report,
          .units = units_of(report.units),
          .columns = plot_columns(curves, most_columns),
          .x = {plot_left, path > 0 ? (plot_right - plot_left) / path : 0},
          .path_mm = path,
          .styles = styles_of(report)};
}

std::string opening(const PlotPage& page, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 {0:.0f}\" width=\"800\" "
      "height=\"{0:.0f}\" "
      "role=\"img\" aria-labelledby=\"title description\">\n"
      "<title id=\"title\">{3}: {1}</title>\n<desc id=\"description\">{2}</desc>\n"
      "<rect width=\"800\" height=\"{0:.0f}\" fill=\"#ffffff\"/>\n"
      "<g font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"#1a1a1a\" "
      "stroke-linecap=\"round\" stroke-linejoin=\"round\">\n",
      height, xml_escaped(page_title(page.report)), xml_escaped(plot_description(page)), plot_mark);
}

}  // namespace

std::string PlotPage::deviation_text(double value_mm) const {
  return fmt::format("{} {}", format_fixed(value_mm * units.deviation_per_mm, units.deviation_decimals),
                     units.deviation);
}

std::string stroke_of(const PlotStyle& style) {
  const std::string dash = *style.dash == '\0' ? "" : fmt::format(" stroke-dasharray=\"{}\"", style.dash);
  return fmt::format(" stroke=\"{}\" stroke-width=\"{:.1f}\"{}", style.colour, style.width, dash);
}

std::string to_svg(const PathCurves& curves, const RunReport& report) {
  const PlotPage page = page_of(curves, report);
  const PlotPart legend = plot_legend(page, 76);
  const PlotPart panels = plot_panels(page, legend.bottom + 16);
  const PlotPart caption = plot_caption(page, panels.bottom + 12);
  std::string svg = opening(page, caption.bottom + 14);
  svg += svg_text(plot_left, 28, Anchor::start, shortened(page_title(report), title_width),
                  " font-size=\"16\" font-weight=\"600\"");
  svg += svg_text(plot_left, 50, Anchor::start, "Deviation of the tool tip before, and its causes");
  return svg + legend.svg + panels.svg + caption.svg + "</g>\n</svg>\n";
}

}  // namespace counterflex
