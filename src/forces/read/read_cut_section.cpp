#include "forces/read/read_cut_section.hpp"

#include <fmt/format.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "forces/read/read_selector.hpp"
#include "toml/suggest.hpp"

namespace counterflex::force_file {
namespace {

using namespace toml_file;

constexpr double steepest_helix_deg = 60, sharpest_point_deg = 60;
constexpr long most_flutes = 100;
// Limits of plausible numbers.
constexpr double narrowest_mm = 0.001, widest_mm = 1000, slowest_rpm = 1, fastest_rpm = 1e6;
constexpr double deepest =
    100;  // cutter diameters: larger values are mistakes, and cost time in the sum over turns

/// A section and its parts while it is read.
struct Part {
  const toml::node& node;
  const toml::table& table;
  std::string name;
  const Source& source;
};

/// The entry of `library` named by the text under `key`.
template <class Value>
const Value& named(const Part& part, std::string_view key,
                   const std::map<std::string, Value, std::less<>>& library, std::string_view kind) {
  const toml::node& node = required(part.table, key, part.name, part.node, part.source);
  const std::string name = as_text(node, key, part.source);
  if (const auto found = library.find(name); found != library.end()) return found->second;
  std::vector<std::string_view> known;
  for (const auto& [entry, value] : library) known.push_back(entry);
  part.source.fail(node, fmt::format("unknown {} \"{}\"{}", key, name, hint(name, known, kind)));
}

double axial_depth(const Part& part, double D) {
  const toml::node& node = required(part.table, "axial_depth_mm", part.name, part.node, part.source);
  const double depth_mm = as_positive(node, {"axial_depth_mm"}, {part.source});
  if (depth_mm * mm > deepest * D)
    part.source.fail(
        node, fmt::format("axial_depth_mm is {}; it must not be greater than {} diameters of the cutter, "
                          "{:.6g} mm",
                          depth_mm, deepest, deepest * D / mm));
  return depth_mm * mm;
}

double angle_deg(const Part& part, std::string_view key) {
  return as_between(required(part.table, key, part.name, part.node, part.source), {key}, 0, 180, part.source);
}

void take_angles(const Part& part, CuttingModel& model) {
  const double entry_deg = angle_deg(part, "entry_deg"), exit_deg = angle_deg(part, "exit_deg");
  if (!(entry_deg < exit_deg))
    part.source.fail(
        *part.table.get("exit_deg"),
        fmt::format("exit_deg is {}; it must be greater than entry_deg, {}", exit_deg, entry_deg));
  model.entry = entry_deg * deg;
  model.exit = exit_deg * deg;
  const bool enters = entry_deg == 0, leaves = exit_deg == 180;
  model.wall = enters && leaves ? Wall::both : enters ? Wall::entry : leaves ? Wall::exit : Wall::none;
}

void check_slot(const Part& part, double D) {
  const toml::node* node = part.table.get("radial_depth_mm");
  if (node == nullptr) return;
  const double depth_mm = as_positive(*node, {"radial_depth_mm"}, {part.source});
  if (std::abs(depth_mm * mm - D) > 1e-9)
    part.source.fail(*node, fmt::format("radial_depth_mm is {}; a slot is as wide as its cutter, {:.6g} mm",
                                        depth_mm, D / mm));
}

/// The angle of immersion for a radial depth.
double immersion(const Part& part, std::string_view side, double D) {
  const toml::node* node = part.table.get("radial_depth_mm");
  if (node == nullptr)
    part.source.fail(
        part.node, fmt::format("{} has no \"radial_depth_mm\", which side = \"{}\" needs", part.name, side));
  const double depth_mm = as_positive(*node, {"radial_depth_mm"}, {part.source});
  if (depth_mm * mm > D * (1 + 1e-12))
    part.source.fail(*node,
                     fmt::format("radial_depth_mm is {}; it must not be greater than the cutter's diameter, "
                                 "{:.6g} mm",
                                 depth_mm, D / mm));
  return std::acos(std::max(-1.0, 1 - 2 * depth_mm * mm / D));
}

void take_side(const Part& part, CuttingModel& model) {
  const toml::node* node = part.table.get("side");
  if (node == nullptr)
    part.source.fail(part.node, fmt::format("{} has no \"side\"; it must be \"up\", \"down\" or \"slot\"; or "
                                            "give entry_deg and exit_deg instead",
                                            part.name));
  const std::string side = as_choice(*node, "side", {"up", "down", "slot"}, part.source);
  const double D = model.mill.diameter;
  model.entry = 0;
  model.exit = pi;
  if (side == "slot") {
    check_slot(part, D);
    model.wall = Wall::both;
  } else if (side == "up") {
    model.exit = immersion(part, side, D);
    model.wall = Wall::entry;
  } else {
    model.entry = pi - immersion(part, side, D);
    model.wall = Wall::exit;
  }
}

void check_one_engagement(const Part& part) {
  for (const std::string_view angle : {"entry_deg", "exit_deg"})
    for (const std::string_view depth : {"side", "radial_depth_mm"})
      if (part.table.contains(angle) && part.table.contains(depth))
        part.source.fail(
            key_of(part.table, angle),
            fmt::format("{} has both \"{}\" and \"{}\"; give either the angles, or side and radial depth",
                        part.name, depth, angle));
}

void take_engagement(const Part& part, CuttingModel& model) {
  check_one_engagement(part);
  const bool angles = part.table.contains("entry_deg") || part.table.contains("exit_deg");
  angles ? take_angles(part, model) : take_side(part, model);
  if (model.force_at == ForceAt::surface && model.wall == Wall::none)
    part.source.fail(
        *part.table.get("entry_deg"),
        "force_at = \"surface\" needs a wall, but the cut neither begins at entry_deg = 0 nor ends at "
        "exit_deg = 180");
}

/// The corner of the end and the point, which a cutter may have.
void read_end(const toml::table& table, const Source& source, EndMill& mill) {
  if (const toml::node* corner = table.get("corner_radius_mm")) {
    mill.corner_radius = as_between(*corner, {"corner_radius_mm"}, 0, widest_mm, source) * mm;
    if (mill.corner_radius > mill.diameter / 2 * (1 + 1e-12))
      source.fail(*corner, fmt::format("corner_radius_mm is {:.6g}; it must not be greater than half of the "
                                       "diameter, {:.6g} mm, which is a ball nose",
                                       mill.corner_radius / mm, mill.diameter / 2 / mm));
  }
  const toml::node *point = table.get("point_angle_deg"), *share = table.get("thrust_share");
  if (point != nullptr)
    mill.point_angle = as_between(*point, {"point_angle_deg"}, sharpest_point_deg, 180, source) * deg;
  if (share == nullptr) return;
  if (point == nullptr)
    source.fail(*share, "thrust_share is of a cutter that drills; give its point_angle_deg, too");
  mill.thrust_share = read_share(*share, "thrust_share", source);
}

Cutter read_cutter(const toml::node& node, const std::string& owner, const Source& source) {
  const toml::table& table = as_table(node, owner, source);
  check_keys(table,
             {"diameter_mm", "flutes", "helix_deg", "corner_radius_mm", "point_angle_deg", "thrust_share"},
             owner, source);
  const toml::node& diameter = required(table, "diameter_mm", owner, node, source);
  const toml::node& flutes = required(table, "flutes", owner, node, source);
  Cutter cutter;
  EndMill& mill = cutter.mill;
  cutter.mills = table.contains("helix_deg") || !table.contains("point_angle_deg");
  const toml::node* helix = cutter.mills ? &required(table, "helix_deg", owner, node, source) : nullptr;
  mill.diameter = as_between(diameter, {"diameter_mm"}, narrowest_mm, widest_mm, source) * mm;
  mill.flutes = static_cast<int>(as_whole(flutes, {"flutes"}, 1, most_flutes, source));
  if (helix != nullptr) mill.helix = as_between(*helix, {"helix_deg"}, 0, steepest_helix_deg, source) * deg;
  read_end(table, source, mill);
  return cutter;
}

/// Completes Kienzle's law by the shares of the section or of the material. A section that only drills needs
/// none.
void take_material(const Part& part, const Material& material, bool mills, CuttingModel& model) {
  model.coefficients = material.coefficients;
  const auto share = [&](std::string_view key, const std::optional<double>& of_material) {
    const toml::node* node = part.table.get(key);
    if (node != nullptr && (!material.is_kienzle || !mills))
      part.source.fail(
          key_of(part.table, key),
          mills ? fmt::format("{} is for materials with kc11_N_mm2 and mc; this one has Ktc_N_mm2", key)
                : fmt::format("{} is for sections that mill; this one only drills", key));
    if (node != nullptr) return read_share(*node, key, part.source);
    if (of_material || !mills) return of_material.value_or(0);
    part.source.fail(
        *part.table.get("material"),
        fmt::format("the material gives the tangential force only; give {} in {} or in the "
                    "material: the part of that force, {} in the milled aluminium of counterflex "
                    "forces --materials",
                    key, part.name, key == "radial_share" ? "0.16 to 0.59" : "0.04 to 0.43"));
  };
  if (!material.is_kienzle && !part.table.contains("radial_share") && !part.table.contains("axial_share"))
    return;
  model.coefficients.K_rc = share("radial_share", material.radial_share) * model.coefficients.K_tc;
  model.coefficients.K_ac = share("axial_share", material.axial_share) * model.coefficients.K_tc;
}

/// A section without a depth drills. Nothing about a cut sideways belongs into it.
void refuse_engagement(const Part& part) {
  for (const std::string_view key : {"side", "radial_depth_mm", "entry_deg", "exit_deg", "force_at"})
    if (part.table.contains(key))
      part.source.fail(
          key_of(part.table, key),
          fmt::format("{} has no axial_depth_mm, so it only drills; {} is for milling", part.name, key));
}

/// The local angles of a cutter whose width changes over the depth are those of the radial depth.
void take_corner(const Part& part, CuttingModel& model) {
  if (model.mill.corner_radius == 0) return;
  if (model.force_at == ForceAt::surface)
    part.source.fail(*part.table.get("cutter"),
                     "the cutter has a corner radius; force_at = \"surface\" is for cutters without one, use "
                     "\"mean\"");
  if (const toml::node* depth = part.table.get("radial_depth_mm"))
    if (model.wall != Wall::both)
      model.radial_depth = as_positive(*depth, {"radial_depth_mm"}, {part.source}) * mm;
}

}  // namespace

Cutters read_cutters(const toml::table& document, const Source& source) {
  Cutters cutters;
  const toml::node* node = document.get("cutters");
  if (node == nullptr) return cutters;
  for (const auto& [key, entry] : as_table(*node, "cutters", source))
    cutters.emplace(key.str(), read_cutter(entry, fmt::format("[cutters.{}]", key.str()), source));
  return cutters;
}

ForceAt read_force_at(const toml::node& node, const Source& source) {
  const std::string text = as_choice(node, "force_at", {"mean", "surface"}, source);
  return text == "mean" ? ForceAt::mean : ForceAt::surface;
}

CutSection read_cut_section(const toml::node& node, std::size_t number, const CutLibrary& library,
                            const Source& source) {
  const std::string counted = fmt::format("section {}", number);
  const toml::table& table = as_table(node, counted, source);
  check_keys(
      table,
      {"name", "tool", "op", "lines", "blocks", "cutter", "material", "axial_depth_mm", "radial_depth_mm",
       "side", "entry_deg", "exit_deg", "spindle_rpm", "force_at", "radial_share", "axial_share"},
      "a section", source);
  const toml::node* name = table.get("name");
  const Part part{node, table, name == nullptr ? counted : as_text(*name, "name", source), source};
  CutSection section{part.name, source.at(node.source()), {}, {}, read_selector(table, source), {}};
  CuttingModel& model = section.model;
  const Cutter& cutter = named(part, "cutter", library.cutters, "cutters");
  const Material& material = named(part, "material", library.materials, "materials");
  model.mill = cutter.mill;
  section.cutter = as_text(*table.get("cutter"), "cutter", source);
  section.material = as_text(*table.get("material"), "material", source);
  const bool mills = table.contains("axial_depth_mm") || cutter.mill.point_angle == 0;
  if (mills) {
    if (!cutter.mills)
      source.fail(*table.get("axial_depth_mm"),
                  fmt::format("the cutter \"{}\" has no helix_deg, so it only drills; give it one, or leave "
                              "axial_depth_mm out",
                              section.cutter));
    model.axial_depth = axial_depth(part, model.mill.diameter);
    const toml::node* force_at = table.get("force_at");
    model.force_at = force_at == nullptr ? library.force_at : read_force_at(*force_at, source);
    take_engagement(part, model);
    take_corner(part, model);
  } else {
    refuse_engagement(part);
  }
  take_material(part, material, mills, model);
  if (const toml::node* rpm = table.get("spindle_rpm"))
    model.spindle_rpm = as_between(*rpm, {"spindle_rpm"}, slowest_rpm, fastest_rpm, source);
  return section;
}

}  // namespace counterflex::force_file
