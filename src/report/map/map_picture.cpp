#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "report/map/map_units.hpp"
#include "report/plot/plot_ticks.hpp"
#include "report/plot/svg.hpp"

namespace counterflex {
namespace {

// px
constexpr double panel_size = 290, panel_left = 62, panel_gap = 22, panel_head = 30, panel_foot = 48;
constexpr double picture_head = 84, legend_width = 190, legend_bar = 18, legend_length = 220;
constexpr int most_panels_of_row = 3;

/// Viridis, which eyes that confuse red and green can read, and which a grey printer keeps in order.
constexpr std::array<std::array<int, 3>, 10> viridis{{{68, 1, 84},
                                                      {72, 40, 120},
                                                      {62, 73, 137},
                                                      {49, 104, 142},
                                                      {38, 130, 142},
                                                      {31, 158, 137},
                                                      {53, 183, 121},
                                                      {110, 206, 88},
                                                      {181, 222, 43},
                                                      {253, 231, 37}}};

/// From 0, the worst, to 1, the best.
std::string colour_at(double goodness) {
  const double u = std::clamp(goodness, 0.0, 1.0) * (viridis.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(u), viridis.size() - 2);
  const double part = u - static_cast<double>(i);
  std::string text = "#";
  for (std::size_t k = 0; k < 3; ++k)
    text += fmt::format("{:02x}",
                        static_cast<int>(std::lround((1 - part) * viridis[i][k] + part * viridis[i + 1][k])));
  return text;
}

/// The values between which colours change, in the unit of the map. Few extreme places, as those beside a
/// singular one, do not use up the colours.
struct ColourScale {
  double low = 0, high = 0;
  double least = 0, most = 0;  ///< of all places
  bool larger_is_better = true;

  double goodness(double value) const {
    if (!(high > low)) return 0.5;
    const double u = (value - low) / (high - low);
    return larger_is_better ? u : 1 - u;
  }
};

ColourScale colour_scale(const WorkspaceMap& map) {
  std::vector<double> values;
  for (const MapPlace& place : map.places)
    if (place.status == Status::converged && std::isfinite(place.value))
      values.push_back(place.value / unit_of(map.request.quantity).si);
  ColourScale scale;
  scale.larger_is_better = map.request.quantity == MapQuantity::stiffness;
  if (values.empty()) return scale;
  std::sort(values.begin(), values.end());
  const std::size_t left_out = values.size() / 50;
  return {values[left_out], values[values.size() - 1 - left_out], values.front(), values.back(),
          scale.larger_is_better};
}

/// How a place without a number is filled, and its entry in the legend.
struct MapFill {
  std::string_view fill, text;
};
constexpr std::array<MapFill, 4> fills{{{"url(#unreachable)", "not reachable"},
                                        {"#c4c4c4", "outside travel"},
                                        {"url(#unsolved)", "singular or unstable"},
                                        {"#ffffff", "rigid"}}};

/// Index of the fill; -1: the place has a number.
int fill_of(const MapPlace& place) {
  switch (place.status) {
    case Status::converged:
      return std::isfinite(place.value) ? -1 : 3;
    case Status::unreachable:
      return 0;
    case Status::outside_travel:
      return 1;
    default:
      return 2;
  }
}

constexpr std::string_view patterns =
    "<defs>\n<pattern id=\"unreachable\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">"
    "<rect width=\"6\" height=\"6\" fill=\"#f3f4f6\"/><path d=\"M0 6L6 0\" stroke=\"#9ca3af\"/></pattern>\n"
    "<pattern id=\"unsolved\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">"
    "<rect width=\"6\" height=\"6\" fill=\"#f3f4f6\"/><path d=\"M0 6L6 0M0 0L6 6\" stroke=\"#6b7280\"/>"
    "</pattern>\n</defs>\n";

/// A layer of the grid on the page: x to the right, y up, one scale for both.
struct MapPanel {
  const WorkspaceMap& map;
  int layer;
  double left, top;  ///< of its cells (px)

  /// The side of a cell (m).
  double cell(int axis) const {
    const double width = map.request.grid.spacing(axis);
    return width > 0 ? width : 10 * mm;
  }
  double span(int axis) const { return cell(axis) * map.request.grid.count[static_cast<std::size_t>(axis)]; }
  double scale() const { return panel_size / std::max(span(0), span(1)); }
  /// The outer side of the first cell (m).
  double begin(int axis) const { return map.request.grid.coordinate(axis, 0) - cell(axis) / 2; }
  double x(double value) const { return left + scale() * (value - begin(0)); }
  double y(double value) const { return top + scale() * (span(1) - (value - begin(1))); }
  double right() const { return left + scale() * span(0); }
  double bottom() const { return top + scale() * span(1); }
  std::size_t index(int i, int j) const {
    const auto& count = map.request.grid.count;
    return static_cast<std::size_t>((layer * count[1] + j) * count[0] + i);
  }
};

std::string cells_svg(const MapPanel& panel, const ColourScale& scale) {
  const MapGrid& grid = panel.map.request.grid;
  std::string svg = "<g shape-rendering=\"crispEdges\">\n";
  for (int j = 0; j < grid.count[1]; ++j)
    for (int i = 0; i < grid.count[0]; ++i) {
      const MapPlace& place = panel.map.places[panel.index(i, j)];
      const int fill = fill_of(place);
      const double x = panel.x(grid.coordinate(0, i) - panel.cell(0) / 2),
                   y = panel.y(grid.coordinate(1, j) + panel.cell(1) / 2);
      svg += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                         x, y, panel.scale() * panel.cell(0), panel.scale() * panel.cell(1),
                         fill < 0
                             ? colour_at(scale.goodness(place.value / unit_of(panel.map.request.quantity).si))
                             : std::string(fills[static_cast<std::size_t>(fill)].fill));
    }
  return svg + "</g>\n";
}

std::string axes_svg(const MapPanel& panel) {
  std::string svg = fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#374151\"/>\n",
      panel.left, panel.top, panel.right() - panel.left, panel.bottom() - panel.top);
  const MapBox& box = panel.map.request.grid.box;
  constexpr double tick_px = 58;  // room of a label
  const auto most_ticks = [&](int axis) {
    return std::clamp(static_cast<int>(panel.scale() * panel.span(axis) / tick_px), 1, 5);
  };
  const PlotTicks along_x = ticks_within(box.least.x() / mm, box.most.x() / mm, most_ticks(0)),
                  along_y = ticks_within(box.least.y() / mm, box.most.y() / mm, most_ticks(1));
  for (const double value : along_x.values) {
    const double x = panel.x(value * mm);
    svg += svg_line(x, panel.bottom(), x, panel.bottom() + 5, " stroke=\"#374151\"") +
           svg_text(x, panel.bottom() + 18, Anchor::middle, format_fixed(value, along_x.decimals));
  }
  for (const double value : along_y.values) {
    const double y = panel.y(value * mm);
    svg += svg_line(panel.left - 5, y, panel.left, y, " stroke=\"#374151\"") +
           svg_text(panel.left - 8, y + 4, Anchor::end, format_fixed(value, along_y.decimals));
  }
  svg += svg_text((panel.left + panel.right()) / 2, panel.bottom() + 34, Anchor::middle, "x, mm");
  svg += svg_text(panel.left - 8, panel.top - 8, Anchor::end, "y, mm");
  return svg + svg_text(panel.left, panel.top - 8, Anchor::start,
                        fmt::format("z {:.8g} mm",
                                    rounded(panel.map.request.grid.coordinate(2, panel.layer) / mm, 4)),
                        " font-weight=\"bold\"");
}

std::string best_mark(double x, double y) {
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"#ffffff\" stroke=\"#000000\" "
      "stroke-width=\"2\"/>\n",
      x, y);
}

std::string worst_mark(double x, double y) {
  const std::string path =
      fmt::format("<path d=\"M{:.1f} {:.1f}l10 10m0 -10l-10 10\" fill=\"none\" stroke=", x - 5, y - 5);
  return path + "\"#ffffff\" stroke-width=\"5\"/>\n" + path + "\"#000000\" stroke-width=\"2\"/>\n";
}

std::string box_svg(const MapPanel& panel, const MapBox& box, std::string_view dash) {
  const double x = panel.x(box.least.x()), y = panel.y(box.most.y());
  const std::string rect =
      fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\"", x, y,
                  std::max(1.0, panel.x(box.most.x()) - x), std::max(1.0, panel.y(box.least.y()) - y));
  return rect + " stroke=\"#ffffff\" stroke-width=\"4\"/>\n" + rect +
         fmt::format(" stroke=\"#000000\" stroke-width=\"2\"{}/>\n", dash);
}

constexpr std::string_view moved_dash = " stroke-dasharray=\"6 4\"";

/// Whether a box is in the slab of a layer.
bool is_in_layer(const MapPanel& panel, const MapBox& box) {
  const double z = panel.map.request.grid.coordinate(2, panel.layer), half = panel.cell(2) / 2;
  return panel.map.request.grid.count[2] == 1 || (box.least.z() <= z + half && box.most.z() >= z - half);
}

std::string program_svg(const MapPanel& panel) {
  if (!panel.map.program) return "";
  const MappedProgram& program = *panel.map.program;
  std::string svg = fmt::format(
      "<clipPath id=\"layer{}\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
      "height=\"{:.1f}\"/></clipPath>\n"
      "<g clip-path=\"url(#layer{})\">\n",
      panel.layer, panel.left, panel.top, panel.right() - panel.left, panel.bottom() - panel.top,
      panel.layer);
  if (is_in_layer(panel, program.box)) svg += box_svg(panel, program.box, "");
  if (program.in_plane && !program.in_plane->shift.isZero(0)) {
    const Vector3& shift = program.in_plane->shift;
    const MapBox there{program.box.least + shift, program.box.most + shift};
    if (is_in_layer(panel, there)) svg += box_svg(panel, there, moved_dash);
  }
  return svg + "</g>\n";
}

std::string panel_svg(const MapPanel& panel, const ColourScale& scale, const MapRange& range) {
  std::string svg = cells_svg(panel, scale) + axes_svg(panel) + program_svg(panel);
  if (range.solved == range.rigid) return svg;
  const MapGrid& grid = panel.map.request.grid;
  const std::size_t size = panel.map.places.size() / static_cast<std::size_t>(grid.count[2]);
  const auto is_here = [&](std::size_t index) {
    return index / size == static_cast<std::size_t>(panel.layer);
  };
  const auto at = [&](std::size_t index, auto mark) {
    const Vector3 p = grid.place(index);
    return mark(panel.x(p.x()), panel.y(p.y()));
  };
  if (is_here(range.worst)) svg += at(range.worst, worst_mark);
  if (is_here(range.best)) svg += at(range.best, best_mark);
  return svg;
}

/// The bar of colours with its values.
std::string bar_svg(const WorkspaceMap& map, const ColourScale& scale, double left, double top) {
  constexpr int bands = 44;
  constexpr double band = legend_length / bands;
  std::string svg = svg_text(
      left, top - 10, Anchor::start,
      fmt::format("{}, {}", map.request.quantity == MapQuantity::stiffness ? "stiffness" : "deviation",
                  unit_of(map.request.quantity).name),
      " font-weight=\"bold\"");
  svg += "<g shape-rendering=\"crispEdges\">\n";
  for (int i = 0; i < bands; ++i)  // from the largest value down
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{:.1f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                       left, top + band * i, legend_bar, band + 0.5,
                       colour_at(scale.larger_is_better ? 1 - (i + 0.5) / bands : (i + 0.5) / bands));
  svg += "</g>\n";
  if (!(scale.high > scale.low)) return svg;
  const PlotTicks ticks = ticks_within(scale.low, scale.high, 6);
  for (const double value : ticks.values) {
    const double y = top + legend_length * (scale.high - value) / (scale.high - scale.low);
    svg += svg_line(left + legend_bar, y, left + legend_bar + 5, y, " stroke=\"#374151\"") +
           svg_text(left + legend_bar + 9, y + 4, Anchor::start, format_fixed(value, ticks.decimals));
  }
  return svg;
}

std::string legend_svg(const WorkspaceMap& map, const ColourScale& scale, const MapRange& range, double left,
                       double top) {
  std::string svg;
  const bool any = range.solved > range.rigid;
  if (any) {
    svg += bar_svg(map, scale, left, top);
    top += legend_length + 20;
    const MapUnit unit = unit_of(map.request.quantity);
    svg +=
        svg_text(left, top, Anchor::start,
                 fmt::format("all places: {} to {}", value_text(scale.least * unit.si, map.request.quantity),
                             value_text(scale.most * unit.si, map.request.quantity)));
    svg += best_mark(left + 7, top + 18) + svg_text(left + 22, top + 22, Anchor::start, "best place");
    svg += worst_mark(left + 7, top + 38) + svg_text(left + 22, top + 42, Anchor::start, "worst place");
    top += 60;
  }
  const auto box_entry = [&](std::string_view style, std::string_view text) {
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"14\" height=\"12\" {}/>\n", left, top - 6,
                       style);
    svg += svg_text(left + 22, top + 4, Anchor::start, text);
    top += 20;
  };
  if (map.program) {
    box_entry("fill=\"none\" stroke=\"#000000\" stroke-width=\"2\"", "program");
    if (map.program->in_plane && !map.program->in_plane->shift.isZero(0))
      box_entry(fmt::format("fill=\"none\" stroke=\"#000000\" stroke-width=\"2\"{}", moved_dash),
                "best shift in x, y");
  }
  for (std::size_t i = 0; i < fills.size(); ++i)
    if (std::any_of(map.places.begin(), map.places.end(),
                    [&](const MapPlace& place) { return fill_of(place) == static_cast<int>(i); }))
      box_entry(fmt::format("fill=\"{}\" stroke=\"#6b7280\"", fills[i].fill), fills[i].text);
  return svg;
}

std::string subtitle(const WorkspaceMap& map) {
  std::string text = quantity_text(map.request);
  if (const std::string load = load_text(map); !load.empty()) text += "; load: " + load;
  return text + (map.tool.empty() ? "" : "; " + map.tool);
}

}  // namespace

std::string map_picture(const WorkspaceMap& map) {
  const MapRange range = range_of(map);
  const ColourScale scale = colour_scale(map);
  const int layers = map.request.grid.count[2], columns = std::min(layers, most_panels_of_row);
  const MapPanel first{map, 0, panel_left, picture_head + panel_head};
  const double wide = panel_left + (first.right() - first.left) + panel_gap;
  const double high = panel_head + (first.bottom() - first.top) + panel_foot;
  const int rows = (layers + columns - 1) / columns;
  const double left_of_legend = columns * wide + 16;
  const double width = std::max(left_of_legend + legend_width, 640.0);
  const double height = std::max(picture_head + rows * high, picture_head + panel_head + legend_length + 220);
  const std::string name = map.machine.empty() ? "machine without a name" : map.machine;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" role=\"img\" aria-labelledby=\"title\">\n<title id=\"title\">{2}: {3}</title>\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n{4}"
      "<g font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"#1a1a1a\">\n",
      width, height, map_picture_mark, xml_escaped(name), patterns);
  const auto most_characters = static_cast<std::size_t>((width - 40) / 6);  // px of a character
  svg += svg_text(20, 28, Anchor::start, shortened(name, 80), " font-size=\"16\" font-weight=\"bold\"");
  svg += svg_text(20, 48, Anchor::start, shortened(subtitle(map), most_characters));
  if (!map.unmeasured.empty())
    svg += svg_text(20, 66, Anchor::start, map.unmeasured, " font-weight=\"bold\"");
  for (int layer = 0; layer < layers; ++layer)
    svg += panel_svg({map, layer, panel_left + wide * (layer % columns),
                      picture_head + panel_head + high * (layer / columns)},
                     scale, range);
  return svg + legend_svg(map, scale, range, left_of_legend, picture_head + panel_head) + "</g>\n</svg>\n";
}

}  // namespace counterflex
