#include "counterflex/report/machine_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/skeleton.hpp"
#include "report/plot/drawn_parts.hpp"
#include "report/plot/svg.hpp"

namespace counterflex {
namespace {

constexpr double view_size = 380, view_gap = 20, view_margin = 60, views_top = 62, legend_height = 40;  // px
constexpr double drawing_width = 3 * view_size + 4 * view_gap;
constexpr double near_px = 9;  // parts that are nearer share a label

/// A view: which components of M are to the right and up.
struct DrawnView {
  std::string_view title;
  int right, up;
};
constexpr std::array<DrawnView, 3> views = {
    {{"front: x right, z up", 0, 2}, {"side: y right, z up", 1, 2}, {"top: x right, y up", 0, 1}}};

/// From M to the pixels of a view, in the scale of all.
struct ViewFrame {
  DrawnView view;
  double left = 0;   ///< px
  double scale = 1;  ///< px per m
  Vector3 middle = Vector3::Zero();

  double x(const Vector3& p) const {
    return left + view_size / 2 + scale * (p[view.right] - middle[view.right]);
  }
  double y(const Vector3& p) const {
    return views_top + view_size / 2 - scale * (p[view.up] - middle[view.up]);
  }
};

struct DrawnBounds {
  Vector3 least = Vector3::Constant(HUGE_VAL), most = Vector3::Constant(-HUGE_VAL);

  void add(const Vector3& p) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
};

std::string lines_svg(const std::vector<SkeletonLine>& lines, const ViewFrame& frame) {
  std::string svg;
  for (const SkeletonLine& line : lines) {
    svg += "<polyline points=\"";
    for (const Vector3& p : line) svg += fmt::format("{:.1f},{:.1f} ", frame.x(p), frame.y(p));
    svg += "\" fill=\"none\" stroke=\"#6b7280\" stroke-width=\"3\"/>\n";
  }
  return svg;
}

std::string symbol(DrawnKind kind, double x, double y) {
  switch (kind) {
    case DrawnKind::linear_axis:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"10\" height=\"10\" fill=\"#1d4ed8\"/>\n",
                         x - 5, y - 5);
    case DrawnKind::rotary_axis:
      return fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5.5\" fill=\"#ffffff\" stroke=\"#1d4ed8\" "
          "stroke-width=\"3\"/>\n",
          x, y);
    case DrawnKind::spring:
      return fmt::format(
          "<path d=\"M{:.1f} {:.1f}l2 -6l4 12l4 -12l4 12l2 -6\" fill=\"none\" stroke=\"#15803d\" "
          "stroke-width=\"1.5\"/>\n",
          x - 8, y);
    case DrawnKind::mass:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"#7c2d12\"/>\n", x, y);
    case DrawnKind::work:
      return fmt::format(
          "<path d=\"M{0:.1f} {1:.1f}v-16M{0:.1f} {1:.1f}h16\" fill=\"none\" stroke=\"#b45309\" "
          "stroke-width=\"2\"/>\n",
          x, y);
    case DrawnKind::tip:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l-5 -10h10z\" fill=\"#b91c1c\"/>\n", x, y);
  }
  return "";
}

/// Parts at one place of a view, and what is written beside them.
struct DrawnLabel {
  double x, y;  ///< of the place
  std::string text;
};

/// The rectangle of a written label (px).
struct LabelBox {
  double left, right, base;

  bool meets(const LabelBox& other) const {
    constexpr double line_px = 12;
    return left < other.right && other.left < right && std::abs(base - other.base) < line_px;
  }
};

LabelBox box_of(const DrawnLabel& label, bool is_left, double base) {
  constexpr double digit_px = 7, gap_px = 11;  // at most, for a character
  const double width = digit_px * static_cast<double>(label.text.size());
  return is_left ? LabelBox{label.x - gap_px - width, label.x - gap_px, base}
                 : LabelBox{label.x + gap_px, label.x + gap_px + width, base};
}

/// The labels beside their places, on the side that has more room, moved up or down where they would meet.
std::string labels_svg(const std::vector<DrawnLabel>& labels, double middle) {
  std::string svg;
  std::vector<LabelBox> taken;
  for (const DrawnLabel& label : labels) {
    const bool is_left = label.x > middle;
    LabelBox box = box_of(label, is_left, label.y - 6);
    constexpr double step_px = 13;
    for (int k = 1; k < 20 && std::any_of(taken.begin(), taken.end(),
                                          [&](const LabelBox& other) { return box.meets(other); });
         ++k)
      box.base = label.y - 6 + (k % 2 == 1 ? step_px : -step_px) * ((k + 1) / 2);
    taken.push_back(box);
    svg +=
        svg_text(is_left ? box.right : box.left, box.base, is_left ? Anchor::end : Anchor::start, label.text);
  }
  return svg;
}

std::string parts_svg(const std::vector<DrawnPart>& parts, const ViewFrame& frame) {
  std::string svg;
  std::vector<DrawnLabel> labels;
  for (const DrawnPart& part : parts) {
    const double x = frame.x(part.at), y = frame.y(part.at);
    svg += symbol(part.kind, x, y);
    const auto there = std::find_if(labels.begin(), labels.end(), [&](const DrawnLabel& label) {
      return std::abs(label.x - x) < near_px && std::abs(label.y - y) < near_px;
    });
    // The springs of legs from one template have one name: it is written once.
    const bool is_written = part.kind == DrawnKind::spring &&
                            std::any_of(labels.begin(), labels.end(),
                                        [&](const DrawnLabel& label) { return label.text == part.name; });
    if (there == labels.end() && !is_written)
      labels.push_back({x, y, part.name});
    else if (there == labels.end())
      continue;
    else if ((", " + there->text + ", ").find(", " + part.name + ", ") == std::string::npos)
      there->text += ", " + part.name;
  }
  for (DrawnLabel& label : labels) label.text = shortened(label.text, 40);
  return svg + labels_svg(labels, frame.left + view_size / 2);
}

std::string legend(double y) {
  constexpr std::array<std::pair<DrawnKind, std::string_view>, 6> kinds = {
      {{DrawnKind::linear_axis, "linear axis"},
       {DrawnKind::rotary_axis, "rotary axis"},
       {DrawnKind::spring, "spring"},
       {DrawnKind::mass, "mass"},
       {DrawnKind::work, "work frame"},
       {DrawnKind::tip, "tool tip"}}};
  std::string svg;
  double x = view_gap + 10;
  for (const auto& [kind, text] : kinds) {
    svg += symbol(kind, x, y) + svg_text(x + 22, y + 4, Anchor::start, text);
    x += 130;
  }
  return svg;
}

/// A length of 1, 2 or 5 times a power of ten mm, about a quarter of a view.
std::string scale_bar(double scale, double y) {
  double length_mm = 1;
  for (int i = 0; length_mm * mm * scale < view_size / 5 && i < 20; ++i) length_mm *= i % 3 == 1 ? 2.5 : 2;
  const double px = length_mm * mm * scale, right = drawing_width - view_gap;
  return svg_line(right - px, y, right, y, " stroke=\"#1a1a1a\" stroke-width=\"2\"") +
         svg_text(right - px - 8, y + 4, Anchor::end, fmt::format("{:g} mm", length_mm));
}

}  // namespace

std::string machine_drawing(const Machine& machine, const Model& model) {
  const std::vector<SkeletonLine> lines = skeleton(model.mechanism, model.home);
  const std::vector<DrawnPart> parts = drawn_parts(machine, model);
  DrawnBounds extent;
  for (const SkeletonLine& line : lines)
    for (const Vector3& p : line) extent.add(p);
  for (const DrawnPart& part : parts) extent.add(part.at);
  const double size = std::max((extent.most - extent.least).maxCoeff(), 1 * mm);
  const double height = views_top + view_size + view_gap + legend_height;
  const std::string name = machine.name.empty() ? "machine without a name" : machine.name;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" "
      "role=\"img\" aria-labelledby=\"title\">\n<title id=\"title\">{2}: {3}</title>\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n"
      "<g font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"#1a1a1a\">\n",
      drawing_width, height, drawing_mark, xml_escaped(name));
  svg += svg_text(view_gap, 26, Anchor::start, name, " font-size=\"16\" font-weight=\"bold\"");
  ViewFrame frame{views[0], view_gap, (view_size - 2 * view_margin) / size, (extent.least + extent.most) / 2};
  for (const DrawnView& view : views) {
    frame.view = view;
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
        "stroke=\"#d1d5db\"/>\n",
        frame.left, views_top, view_size, view_size);
    svg += svg_text(frame.left, views_top - 8, Anchor::start, view.title);
    svg += lines_svg(lines, frame) + parts_svg(parts, frame);
    frame.left += view_size + view_gap;
  }
  const double foot = views_top + view_size + view_gap + 10;
  return svg + legend(foot) + scale_bar(frame.scale, foot) + "</g>\n</svg>\n";
}

}  // namespace counterflex
