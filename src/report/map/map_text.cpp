#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "report/map/map_units.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {
namespace {

/// Four digits, never an exponent.
std::string four_digits(double value) {
  const double size = std::abs(value);
  const int before = size >= 1 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 1;
  return format_fixed(value, std::max(0, 4 - before));
}

std::string map_row(std::string_view label, const std::string& text) {
  return wrapped(fmt::format("  {:<12} ", label), text, 15);
}

std::string title_of(const WorkspaceMap& map) {
  const std::string name = map.machine.empty() ? "Machine without a name" : map.machine;
  return wrapped(
      "", fmt::format("{}: {}, {}", name, quantity_text(map.request), unit_of(map.request.quantity).name), 2);
}

std::string grid_text(const WorkspaceMap& map) {
  const MapGrid& grid = map.request.grid;
  const std::string places = fmt::format("{} x {} x {} places", grid.count[0], grid.count[1], grid.count[2]);
  if (map.rpy.isZero(0)) return places + ", orientation of home";
  const Vector3 rpy = map.rpy / deg;
  return places +
         fmt::format(", orientation of home turned by {:.6g}, {:.6g}, {:.6g} deg", rpy.x(), rpy.y(), rpy.z());
}

/// "1300 of 1323 places; 20 outside_travel, 3 unreachable".
std::string solved_text(const WorkspaceMap& map, const MapRange& range) {
  std::string text = fmt::format("{} of {} places", range.solved, map.places.size());
  if (const std::string unsolved = unsolved_text(map); !unsolved.empty()) text += "; " + unsolved;
  if (range.rigid > 0) text += fmt::format("; {} of the solved ones are rigid", range.rigid);
  return text;
}

std::string place_row(const WorkspaceMap& map, std::size_t index) {
  const MapPlace& place = map.places[index];
  const MapQuantity quantity = map.request.quantity;
  std::string text = fmt::format("{} {} at {} mm", value_text(place.value, quantity), unit_of(quantity).name,
                                 mm_text(map.request.grid.place(index)));
  if (quantity == MapQuantity::deviation) {
    const Vector3 d = place.vector / um;
    text += fmt::format("; along x, y, z: {}, {}, {} um", four_digits(d.x()), four_digits(d.y()),
                        four_digits(d.z()));
  } else if (!map.request.direction) {
    text += fmt::format(", along ({}, {}, {})", format_fixed(place.vector.x(), 3),
                        format_fixed(place.vector.y(), 3), format_fixed(place.vector.z(), 3));
  }
  return text;
}

/// The values of a layer, ascending.
std::vector<double> values_of_layer(const WorkspaceMap& map, int layer) {
  const std::size_t size = map.places.size() / static_cast<std::size_t>(map.request.grid.count[2]);
  std::vector<double> values;
  for (std::size_t i = 0; i < size; ++i) {
    const MapPlace& place = map.places[static_cast<std::size_t>(layer) * size + i];
    if (place.status == Status::converged && std::isfinite(place.value)) values.push_back(place.value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

std::string layers_text(const WorkspaceMap& map) {
  const MapQuantity quantity = map.request.quantity;
  std::string text = fmt::format("\n  {:>10}  {:>8}  {:>10}  {:>10}  {:>10}\n", "z, mm", "places", "least",
                                 "median", std::string("most, ") + unit_of(quantity).name);
  for (int layer = 0; layer < map.request.grid.count[2]; ++layer) {
    const std::vector<double> values = values_of_layer(map, layer);
    text += fmt::format("  {:>10}  {:>8}", format_fixed(map.request.grid.coordinate(2, layer) / mm, 1),
                        values.size());
    if (!values.empty())
      text +=
          fmt::format("  {:>10}  {:>10}  {:>10}", value_text(values.front(), quantity),
                      value_text(values[values.size() / 2], quantity), value_text(values.back(), quantity));
    text += "\n";
  }
  return text;
}

std::string shift_row(const MapShift& shift, MapQuantity quantity) {
  const Vector3 d = shift.shift / mm;
  return fmt::format("move the part by {} mm: {} {}", mm_text(shift.shift), value_text(shift.value, quantity),
                     unit_of(quantity).name) +
         (d.isZero(0) ? " (it is there)" : "");
}

std::string program_text(const WorkspaceMap& map) {
  if (!map.program) return "";
  const MappedProgram& program = *map.program;
  const MapQuantity quantity = map.request.quantity;
  std::string text =
      line_break() + map_row("program", program.name) + map_row("its box", box_text(program.box));
  text += map_row("present", program.present
                                 ? fmt::format("{} {} in the mean", value_text(*program.present, quantity),
                                               unit_of(quantity).name)
                                 : "unknown: a part of the box has no values or is outside the map");
  if (!program.best) return text + map_row("best", "unknown: the box fits nowhere among places with a value");
  if (program.in_plane) text += map_row("best x, y", shift_row(*program.in_plane, quantity));
  return text + map_row("best x, y, z", shift_row(*program.best, quantity));
}

}  // namespace

std::string unsolved_text(const WorkspaceMap& map) {
  std::string text;
  for (const Status status : {Status::unreachable, Status::outside_travel, Status::singular, Status::unstable,
                              Status::not_converged}) {
    const auto count = std::count_if(map.places.begin(), map.places.end(),
                                     [&](const MapPlace& place) { return place.status == status; });
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, to_string(status));
  }
  return text;
}

std::string status_text(const MapPlace& place) {
  if (place.status == Status::converged && !std::isfinite(place.value)) return "rigid";
  return std::string(to_string(place.status));
}

std::string quantity_text(const MapRequest& request) {
  if (request.quantity == MapQuantity::deviation) return "deviation of the tip";
  if (!request.direction) return "least stiffness of the tip";
  const Vector3& d = *request.direction;
  return fmt::format("stiffness of the tip along ({:.3f}, {:.3f}, {:.3f})", d.x(), d.y(), d.z());
}

std::string load_text(const WorkspaceMap& map) {
  const Vector6& F = map.request.load.F;
  if (F.isZero(0)) return map.weighs ? "the machine's own weight" : "";
  return fmt::format(
      "({:.6g}, {:.6g}, {:.6g}) N, ({:.6g}, {:.6g}, {:.6g}) N m at the tool tip, machine axes{}", F[0], F[1],
      F[2], F[3], F[4], F[5], map.weighs ? ", and the machine's own weight" : "");
}

std::string mm_text(const Vector3& p) {
  const auto shown = [](double x) { return rounded(x / mm, 4); };
  return fmt::format("{:.8g}, {:.8g}, {:.8g}", shown(p.x()), shown(p.y()), shown(p.z()));
}

std::string box_text(const MapBox& box) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += fmt::format("{}{} {:.8g} to {:.8g}", axis == 0 ? "" : ", ", "xyz"[axis],
                        rounded(box.least[axis] / mm, 4), rounded(box.most[axis] / mm, 4));
  return text + " mm";
}

std::string value_text(double value, MapQuantity quantity) {
  const double shown = value / unit_of(quantity).si;
  return quantity == MapQuantity::stiffness ? stiffness_text(shown, four_digits(shown)) : four_digits(shown);
}

std::string to_text(const WorkspaceMap& map) {
  const MapRange range = range_of(map);
  std::string text = title_of(map);
  if (!map.unmeasured.empty()) text += wrapped("", map.unmeasured, 2);
  if (!map.tool.empty()) text += wrapped("", "with " + map.tool, 2);
  text += line_break() + map_row("box", box_text(map.request.grid.box)) + map_row("grid", grid_text(map));
  if (const std::string load = load_text(map); !load.empty()) text += map_row("load", load);
  text += map_row("solved", solved_text(map, range));
  if (range.solved == range.rigid) return text;
  text += map_row("best", place_row(map, range.best)) + map_row("worst", place_row(map, range.worst));
  text += map_row("median", fmt::format("{} {}", value_text(range.median, map.request.quantity),
                                        unit_of(map.request.quantity).name));
  return text + layers_text(map) + program_text(map);
}

}  // namespace counterflex
