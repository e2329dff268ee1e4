#include "identify/read/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::measurement_file {
namespace {

struct Unit {
  std::string_view name;
  double si;
};

constexpr std::array lengths = {Unit{"mm", mm}, Unit{"m", 1}, Unit{"um", um}, Unit{"in", inch}};
constexpr std::array angles = {Unit{"deg", deg}, Unit{"rad", 1}, Unit{"mrad", 1e-3}, Unit{"mdeg", 1e-3 * deg},
                               Unit{"arcsec", deg / 3600}};
constexpr std::array forces = {Unit{"N", 1}, Unit{"kN", 1e3}};
constexpr std::array moments = {Unit{"Nm", 1}};
constexpr std::array masses = {Unit{"kg", 1}};
constexpr std::array slopes = {Unit{"um_per_m", 1e-6}, Unit{"mrad", 1e-3}, Unit{"deg", deg},
                               Unit{"arcsec", deg / 3600}};
constexpr std::array scales = {Unit{"um_per_m", 1e-6}, Unit{"ppm", 1e-6}};
constexpr std::array none = {Unit{"", 1}};

struct Kind {
  std::vector<std::string_view> names;
  std::vector<Unit> units;
  bool is_angle = false;
};

template <std::size_t N>
std::vector<Unit> list(const std::array<Unit, N>& units) {
  return {units.begin(), units.end()};
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {{"x", "y", "z", "reading", "length", "radius", "sigma", "gauge_x", "gauge_y", "gauge_z", "force_x",
        "force_y", "force_z"},
       list(lengths)},
      {{"rx", "ry", "rz", "sigma_angle"}, list(angles), true},
      {{"position", "deviation", "reversal"}, list(lengths)},
      {{"position", "deviation", "reversal"}, list(angles), true},
      {{"fx", "fy", "fz"}, list(forces)},
      {{"mx", "my", "mz", "torque"}, list(moments)},
      {{"mass"}, list(masses)},
      {{"squareness", "sigma_squareness"}, list(slopes)},
      {{"scale", "sigma_scale"}, list(scales)},
      {{"gx", "gy", "gz", "session", "kind", "bar", "axes", "axis", "direction", "point", "phase", "place"},
       list(none)},
  };
  return all;
}

/// The name and the unit of "q1_deg".
std::pair<std::string_view, std::string_view> parts_of(std::string_view column, std::string_view name) {
  if (column == name) return {name, ""};
  if (column.size() > name.size() + 1 && column.starts_with(name) && column[name.size()] == '_')
    return {name, column.substr(name.size() + 1)};
  return {"", ""};
}

std::optional<double> unit_in(const std::vector<Unit>& units, std::string_view unit) {
  for (const Unit& known : units)
    if (known.name == unit) return known.si;
  return {};
}

}  // namespace

std::string_view letter_of(const std::string& actuator) {
  return std::string_view(actuator).substr(actuator.find(' ') + 1);
}

std::optional<Quantity> quantity_of(std::string_view column, const Machine& machine) {
  const std::vector<Actuator> all = actuators(machine);
  const std::vector<std::string> names = actuator_names(machine);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string number = fmt::format("q{}", i + 1);
    const bool turns = all[i].joint.kind == JointKind::revolute;
    const std::vector<Unit> units = turns ? list(angles) : list(lengths);
    for (const std::string_view name : {std::string_view(number), letter_of(names[i])})
      if (const auto [found, unit] = parts_of(column, name); !found.empty())
        if (const auto si = unit_in(units, unit)) return Quantity{number, *si, turns, std::string(unit)};
  }
  for (const Kind& kind : kinds())
    for (const std::string_view name : kind.names)
      if (const auto [found, unit] = parts_of(column, name); !found.empty())
        if (const auto si = unit_in(kind.units, unit))
          return Quantity{std::string(name), *si, kind.is_angle, std::string(unit)};
  return {};
}

std::string column_names(const Machine& machine) {
  std::string text;
  const std::vector<Actuator> all = actuators(machine);
  for (std::size_t i = 0; i < all.size(); ++i)
    text += fmt::format("q{}_{}, ", i + 1, all[i].joint.kind == JointKind::revolute ? "deg" : "mm");
  return text +
         "x_mm, y_mm, z_mm, rx_deg, ry_deg, rz_deg, fx_N, fy_N, fz_N, mx_Nm, my_Nm, mz_Nm, mass_kg, gx, gy, "
         "gz, gauge_x_mm, gauge_y_mm, gauge_z_mm, force_x_mm, force_y_mm, force_z_mm, phase, "
         "reading_um, length_mm, squareness_um_per_m, axes, axis, direction, position_mm, deviation_um, "
         "reversal_um, scale_um_per_m, radius_mm, torque_Nm, bar, point, place, sigma_mm, sigma_angle_deg, "
         "sigma_squareness_um_per_m, sigma_scale_um_per_m, session, kind (other units: m, um, in, rad, mrad, "
         "mdeg, arcsec, kN)";
}

double number_of(const csv::Field& field, std::string_view name, bool decimal_comma, const Location& line) {
  std::string text(field.text);
  if (decimal_comma && std::count(text.begin(), text.end(), ',') == 1 && text.find('.') == std::string::npos)
    std::replace(text.begin(), text.end(), ',', '.');
  // Spreadsheets write powers of ten with a capital letter.
  std::replace(text.begin(), text.end(), 'E', 'e');
  const std::optional<double> value = read_number(text);
  if (!value)
    csv::fail({line.file, line.line, field.column},
              fmt::format("{} is \"{}\"; it must be a number", name, without_controls(field.text)));
  return *value;
}

}  // namespace counterflex::measurement_file
