#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "report/plot/plot_page.hpp"
#include "report/plot/svg.hpp"

namespace counterflex {

namespace {

constexpr std::size_t caption_width = 112;  // characters
constexpr double caption_line = 16;         // px

/// The largest distance between all causes together and the superposition.
double largest_discrepancy(const PlotPage& page) {
  constexpr auto norm = static_cast<std::size_t>(Quantity::discrepancy);
  double largest = 0;
  for (const Stretch& stretch : page.curves.stretches())
    if (const double value = stretch.largest[norm]; value > largest) largest = value;
  return largest;
}

/// Rounded up to the last digit shown, in mm: a quoted limit is never too low.
double rounded_up(double value_mm, const PlotUnits& units) {
  const double per_mm =
      units.deviation_per_mm * small_powers_of_ten[static_cast<std::size_t>(units.deviation_decimals)];
  constexpr double slack = 1e-3;
  return std::max(1.0, std::ceil(value_mm * per_mm - slack)) / per_mm;
}

std::string caption_text(const PlotPage& page) {
  const RunReport& report = page.report;
  std::string text =
      "Actual minus wanted position of the tool tip in the axes of the machine, when the original program "
      "runs.";
  if (report.sources)
    text += fmt::format(" All acting together are within {} of the superposition.",
                        page.deviation_text(rounded_up(largest_discrepancy(page), page.units)));
  if (page.curves.corrected())
    text +=
        " Below, the size of what the model leaves of it when the corrected program runs: not the accuracy "
        "of the "
        "part.";
  const std::size_t steps = page.curves.force_steps().count;
  if (steps > most_steps_drawn)
    text += fmt::format(" The force steps {} times.", steps);
  else if (steps > 0)
    text += " Dotted lines: steps of the force.";
  if (!page.columns.single)
    text += " Bands: from the least to the largest of neighbouring places.";
  else if (const auto& rapids = page.curves.rapids().s_mm; !rapids.empty() && rapids.back() > 0)
    text += " Curves are interrupted at rapids.";
  if (report.failure) text += " The run failed: " + report.failure->what;
  return text;
}

/// The length of `text` that fits into a line: to its last blank, or to the first one after a longer word.
std::size_t line_end(std::string_view text) {
  if (text.size() <= caption_width) return text.size();
  const std::size_t last = text.rfind(' ', caption_width);
  return std::min(last != std::string_view::npos ? last : text.find(' '), text.size());
}

}  // namespace

PlotPart plot_caption(const PlotPage& page, double top) {
  const std::string text = caption_text(page);
  PlotPart part{"", top};
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = line_end(rest);
    part.bottom += caption_line;
    part.svg += svg_text(plot_left, part.bottom, Anchor::start, rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return part;
}

PlotPart plot_legend(const PlotPage& page, double base_line) {
  constexpr double sample = 30, gap = 8, item_gap = 22, character = 6.4, row = 18;  // px
  PlotPart part{"", base_line};
  double x = plot_left;
  for (const PlotStyle& style : page.styles) {
    const auto letters = static_cast<double>(std::string_view(style.label).size());
    const double width = sample + gap + character * letters;
    if (x > plot_left && x + width > plot_right) {
      x = plot_left;
      part.bottom += row;
    }
    part.svg += fmt::format("<path fill=\"none\"{} d=\"M{:.1f} {:.1f}h{:.0f}\"/>\n", stroke_of(style), x,
                            part.bottom - 4, sample);
    part.svg += svg_text(x + sample + gap, part.bottom, Anchor::start, style.label);
    x += width + item_gap;
  }
  return part;
}

std::string plot_description(const PlotPage& page) {
  const RunReport& report = page.report;
  if (!report.before) return "Nothing was solved.";
  std::string text = fmt::format("Before, the tip is off by up to {}, in line {}.",
                                 page.deviation_text(report.before->max_mm), report.before->max_line);
  if (report.after)
    text += fmt::format(" After, the model leaves up to {}, in line {}.",
                        page.deviation_text(report.after->max_mm), report.after->max_line);
  return text;
}

}  // namespace counterflex
