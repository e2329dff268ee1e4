#include <fmt/format.h>

#include <cmath>

#include "counterflex/files/text.hpp"
#include "report/json/fixed_digits.hpp"
#include "report/json/json_numbers.hpp"
#include "report/map/map_units.hpp"

namespace counterflex {
namespace {

constexpr int map_mm_digits = 4, map_value_digits = 6;

bool has_number(const MapPlace& place) {
  return place.status == Status::converged && std::isfinite(place.value);
}

/// The components that are shown beside the value: those of a deviation in its unit.
Vector3 shown_vector(const MapPlace& place, MapQuantity quantity) {
  return quantity == MapQuantity::deviation ? Vector3(place.vector / um) : place.vector;
}

Json place_json(const WorkspaceMap& map, std::size_t index) {
  const MapPlace& place = map.places[index];
  const MapQuantity quantity = map.request.quantity;
  Json json{{"place_mm", numbers(Vector3(map.request.grid.place(index) / mm), map_mm_digits)},
            {"status", status_text(place)}};
  if (!has_number(place)) {
    json["value"] = nullptr;
    json["vector"] = nullptr;
    return json;
  }
  json["value"] = number(place.value / unit_of(quantity).si, map_value_digits);
  json["vector"] = numbers(shown_vector(place, quantity), map_value_digits);
  return json;
}

Json box_json(const MapBox& box) {
  return {{"least", numbers(Vector3(box.least / mm), map_mm_digits)},
          {"most", numbers(Vector3(box.most / mm), map_mm_digits)}};
}

Json shift_json(const std::optional<MapShift>& shift, MapQuantity quantity) {
  if (!shift) return nullptr;
  return {{"shift_mm", numbers(Vector3(shift->shift / mm), map_mm_digits)},
          {"value", number(shift->value / unit_of(quantity).si, map_value_digits)}};
}

Json program_json(const MappedProgram& program, MapQuantity quantity) {
  return {{"name", program.name},
          {"box_mm", box_json(program.box)},
          {"present", program.present ? number(*program.present / unit_of(quantity).si, map_value_digits)
                                      : Json(nullptr)},
          {"best_in_plane", shift_json(program.in_plane, quantity)},
          {"best", shift_json(program.best, quantity)}};
}

}  // namespace

std::string to_csv(const WorkspaceMap& map) {
  const MapQuantity quantity = map.request.quantity;
  std::string text = std::string(map_table_mark) + unit_of(quantity).column +
                     (quantity == MapQuantity::stiffness ? ",direction_x,direction_y,direction_z\n"
                                                         : ",deviation_x_um,deviation_y_um,deviation_z_um\n");
  for (std::size_t i = 0; i < map.places.size(); ++i) {
    const MapPlace& place = map.places[i];
    for (const double coordinate : map.request.grid.place(i)) {
      append_fixed(text, coordinate / mm, map_mm_digits);
      text += ',';
    }
    text += status_text(place);
    const bool has = has_number(place);
    text += ',';
    if (has) append_fixed(text, place.value / unit_of(quantity).si, map_value_digits);
    for (const double component : shown_vector(place, quantity)) {
      text += ',';
      if (has) append_fixed(text, component, map_value_digits);
    }
    text += '\n';
  }
  return text;
}

std::string to_json(const WorkspaceMap& map) {
  const MapRequest& request = map.request;
  const MapRange range = range_of(map);
  Json places = Json::array();
  for (std::size_t i = 0; i < map.places.size(); ++i) places.push_back(place_json(map, i));
  const bool any = range.solved > range.rigid;
  Json document{
      {"schema", "counterflex-map 1"},
      {"tool", fmt::format("counterflex {}", map.version)},
      {"machine", map.machine},
      {"quantity", request.quantity == MapQuantity::stiffness ? "stiffness" : "deviation"},
      {"unit", unit_of(request.quantity).name},
      {"direction", request.direction ? numbers(*request.direction, map_value_digits) : Json(nullptr)},
      {"wrench_N_Nm", numbers(request.load.F, map_value_digits)},
      {"rpy_deg", numbers(Vector3(map.rpy / deg), map_value_digits)},
      {"box_mm", box_json(request.grid.box)},
      {"grid", request.grid.count},
      {"solved", range.solved},
      {"best", any ? place_json(map, range.best) : Json(nullptr)},
      {"worst", any ? place_json(map, range.worst) : Json(nullptr)},
      {"median",
       any ? number(range.median / unit_of(request.quantity).si, map_value_digits) : Json(nullptr)}};
  if (!map.unmeasured.empty()) document["unmeasured"] = map.unmeasured;
  if (!map.tool.empty()) document["machine_tool"] = map.tool;
  if (map.program) document["program"] = program_json(*map.program, request.quantity);
  document["places"] = std::move(places);
  return dump(document);
}

}  // namespace counterflex
