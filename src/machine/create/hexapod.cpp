#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/pose.hpp"
#include "machine/create/words.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 6> node_columns = {"base_x_mm",     "base_y_mm",     "base_z_mm",
                                                          "platform_x_mm", "platform_y_mm", "platform_z_mm"};

[[noreturn]] void refuse_header(const Location& where) {
  csv::fail(
      where,
      "the first line must name the columns base_x_mm, base_y_mm, base_z_mm, platform_x_mm, platform_y_mm, "
      "platform_z_mm, in this order");
}

std::vector<csv::Field> fields_of(std::string_view line, const Location& where) {
  const char separator = line.find(';') == std::string_view::npos ? ',' : ';';
  std::vector<csv::Field> fields = csv::split(line, 1, separator);
  if (fields.size() != node_columns.size())
    csv::fail(where, fmt::format("the line has {} cells, must have {}", fields.size(), node_columns.size()));
  return fields;
}

LegNodes nodes_of(std::string_view line, Location where) {
  LegNodes nodes;
  const std::vector<csv::Field> fields = fields_of(line, where);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    where.column = fields[i].column;
    std::string text(fields[i].text);
    if (line.find(';') != std::string_view::npos) std::replace(text.begin(), text.end(), ',', '.');
    const auto value = read_number(text);
    if (!value)
      csv::fail(where, fmt::format("{} is '{}', must be a finite number in mm", node_columns[i],
                                   without_controls(fields[i].text)));
    (i < 3 ? nodes.base_mm : nodes.platform_mm)[static_cast<int>(i % 3)] = *value;
  }
  return nodes;
}

}  // namespace

std::vector<LegNodes> read_leg_nodes(std::string_view text, const std::string& file) {
  std::vector<LegNodes> legs;
  bool has_header = false;
  for (Location where{file, 1, 1}; !text.empty(); ++where.line) {
    const std::string_view line = csv::trimmed(csv::take_line(text));
    if (line.empty()) continue;
    if (has_header) {
      if (legs.size() == 6) csv::fail(where, "the table has more than six legs");
      legs.push_back(nodes_of(line, where));
      continue;
    }
    const std::vector<csv::Field> fields =
        csv::split(line, 1, line.find(';') == std::string_view::npos ? ',' : ';');
    if (fields.size() != node_columns.size()) refuse_header(where);
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (fields[i].text != node_columns[i]) refuse_header({file, where.line, fields[i].column});
    has_header = true;
  }
  if (legs.size() != 6)
    csv::fail({file, 1, 1}, fmt::format("the table has {} legs, must have six", legs.size()));
  return legs;
}

namespace made {
namespace {

constexpr AxisRange usual_stroke{-200, 200};
constexpr double usual_leg = 60;  // N/µm

/// A hexapod of 600 mm radius that hangs over the table.
std::vector<LegNodes> example_nodes() {
  constexpr std::array<double, 6> base = {-12, 12, 108, 132, 228, 252},
                                  platform = {-48, 48, 72, 168, 192, 288};
  const auto on_ring = [](double radius_mm, double angle_deg, double z_mm) {
    return Vector3(radius_mm * std::cos(angle_deg * deg), radius_mm * std::sin(angle_deg * deg), z_mm);
  };
  std::vector<LegNodes> legs;
  for (std::size_t i = 0; i < base.size(); ++i)
    legs.push_back({on_ring(600, base[i], 1500), on_ring(250, platform[i], 0)});
  return legs;
}

/// A rotation whose z axis is `direction`, nearest to the identity.
Matrix3 along_z(const Vector3& direction) {
  const Vector3 axis = Vector3::UnitZ().cross(direction);
  const double sine = axis.norm(), cosine = direction.z();
  if (sine < 1e-9) return cosine > 0 ? Matrix3::Identity() : exp_so3(pi * Vector3::UnitX());
  return exp_so3(axis / sine * std::atan2(sine, cosine));
}

std::string leg(std::size_t i, const LegNodes& nodes, const Vector3& home_mm) {
  const Vector3 along = home_mm + nodes.platform_mm - nodes.base_mm;
  const double length_mm = along.norm();
  if (length_mm < 1)
    throw InputError(ErrorKind::usage, {},
                     fmt::format("leg {} has no length at the home of the platform", i + 1));
  const Matrix3 R = along_z(along / length_mm);
  return fmt::format(
      "\n[[chain]]\nname = \"leg{}\"\nuse = \"leg\"\n"
      "transforms.base_joint = {{ xyz_mm = {}, {} }}\n"
      "transforms.platform_axes = {{ {} }}\n"
      "transforms.platform_joint = {{ xyz_mm = {} }}\n"
      "values.length = {}\n",
      i + 1, triple(nodes.base_mm), turned(R), turned(R.transpose()), triple(-nodes.platform_mm),
      number(length_mm));
}

std::string leg_template(const MachineFacts& facts) {
  const AxisRange stroke = travel_of(facts, 'L', usual_stroke);
  return fmt::format(
      "\n[templates.leg]  # z: from the base to the platform at home. The length is that between the joints\n"
      "elements = [\n"
      "  {{ error = \"base_joint\" }},      # in the axes of M\n"
      "  {{ rigid = \"base_joint\" }},\n"
      "  {{ passive = \"revolute\", axis = \"y\" }},\n"
      "  {{ passive = \"revolute\", axis = \"x\" }},\n"
      "  {{ actuator = \"prismatic\", axis = \"z\", min_mm = {}, max_mm = {} }},  # from home\n"
      "  {{ rigid = {{ xyz_mm = [0, 0, \"$length\"] }} }},\n"
      "  {{ error = \"length\" }},\n"
      "  {{ compliance = \"prismatic\", axis = \"z\", stiffness_N_per_m = {}, name = \"strut\" }},\n"
      "  {{ passive = \"revolute\", axis = \"x\" }},\n"
      "  {{ passive = \"revolute\", axis = \"y\" }},\n"
      "  {{ passive = \"revolute\", axis = \"z\" }},\n"
      "  {{ rigid = \"platform_axes\" }},\n"
      "  {{ error = \"platform_joint\" }},  # in the axes of the platform\n"
      "  {{ rigid = \"platform_joint\" }},\n"
      "]\n",
      number(stroke.min), number(stroke.max), number(facts.leg_stiffness.value_or(usual_leg * N_per_um)));
}

std::string leg_parameters(const MachineFacts& facts) {
  const Knowledge node{sigma(0.2), NumberSource::prior, "usual before calibration"};
  const Knowledge stiffness =
      facts.leg_stiffness ? Knowledge{percent(10), NumberSource::catalogue, "--leg-stiffness-N-per-um"}
                          : Knowledge{percent(100), NumberSource::prior,
                                      "60 N/µm, usual for a leg with a ball screw: 20 to 150"};
  std::string text = parameters_header();
  for (int i = 1; i <= 6; ++i) {
    const std::string name = fmt::format("leg{}", i);
    text += stated(name + ".strut.compliance_m_per_N", stiffness) +
            stated_errors(name + ".base_joint", {"x_mm", "y_mm", "z_mm"}, node, node) +
            stated_errors(name + ".length", {"z_mm"}, node, node) +
            stated_errors(name + ".platform_joint", {"x_mm", "y_mm", "z_mm"}, node, node);
  }
  return text;
}

}  // namespace

std::string hexapod_file(const MachineFacts& facts) {
  const std::vector<LegNodes> legs = facts.nodes.empty() ? example_nodes() : facts.nodes;
  const Vector3 home_mm = facts.home_mm.value_or(Vector3(0, 0, 800));
  std::string text =
      title({"counterflex new hexapod",
             facts.nodes.empty()
                 ? "Six legs between a base and a platform. The nodes are an example: give yours with "
                   "--nodes FILE and --home-mm X,Y,Z."
                 : "Six legs between a base and a platform, with the nodes of --nodes.",
             facts.name.empty() ? "Hexapod" : facts.name, R"("x", "y", "z", "rx", "ry", "rz")"}) +
      fmt::format(
          "\n[home]  # the platform in M, where all legs have the length of their drawing\n"
          "xyz_mm = {}\n"
          "\n[tool]  # from the platform to the tip: replace it by yours\n"
          "xyz_mm = [0, 0, -150]\n",
          triple(home_mm)) +
      work_offset("G54", home_mm + Vector3(0, 0, -200)) + "\n[limits]\nmax_correction_mm = 3\n" +
      leg_template(facts);
  for (std::size_t i = 0; i < legs.size(); ++i) text += leg(i, legs[i], home_mm);
  return text + leg_parameters(facts);
}

}  // namespace made
}  // namespace counterflex
