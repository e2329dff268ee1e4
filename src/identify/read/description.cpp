#include "identify/read/description.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "toml/fields.hpp"

namespace counterflex::measurement_file {
namespace {

using namespace toml_file;

constexpr std::string_view format = "counterflex-measurements 1";

Matrix3 from_axes(const Vector3& first, const Vector3& second, const Vector3& third, const Vector3& turns) {
  return (Eigen::AngleAxisd(turns[0], first) * Eigen::AngleAxisd(turns[1], second) *
          Eigen::AngleAxisd(turns[2], third))
      .toRotationMatrix();
}

/// "rotvec"; "xyz" and "zyx": turns about the axes of the turned body, the first angle first.
std::function<Matrix3(const Vector3&)> convention(const std::string& name) {
  if (name == "xyz")
    return
        [](const Vector3& a) { return from_axes(Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ(), a); };
  if (name == "zyx")
    return [](const Vector3& a) {
      return from_axes(Vector3::UnitZ(), Vector3::UnitY(), Vector3::UnitX(), Vector3(a[2], a[1], a[0]));
    };
  return exp_so3;
}

std::optional<MeasurementKind> kind_of(const toml::table& document, const Source& source) {
  const toml::node* node = document.get("kind");
  if (node == nullptr) return {};
  std::vector<std::string_view> names;
  for (int k = 0; k <= static_cast<int>(MeasurementKind::ballbar); ++k)
    names.push_back(name_of(static_cast<MeasurementKind>(k)));
  const std::string name = as_choice(*node, "kind", names, source);
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return static_cast<MeasurementKind>(k);
  return {};
}

void read_columns(const toml::table& table, const Source& source, const Machine& machine,
                  Description& description) {
  for (const auto& [key, node] : table) {
    const std::optional<Quantity> quantity = quantity_of(key.str(), machine);
    if (!quantity)
      source.fail(key, fmt::format("unknown quantity \"{}\"; known: {}", key.str(), column_names(machine)));
    if (node.is_string())
      description.names.emplace_back(as_text(node, key.str(), source), *quantity);
    else
      description.constants[quantity->name] = {0, 1, as_number(node, {key.str()}, {source}) * quantity->si,
                                               quantity->is_angle};
  }
  description.is_mapped = true;
}

/// Where the table is in its file, and how its fields are separated.
void read_layout(const toml::table& document, const Source& source, Description& description) {
  const auto line = [&](std::string_view key, int least) {
    const toml::node* node = document.get(key);
    return node == nullptr ? 0 : static_cast<int>(as_whole(*node, {key}, least, 1000000, source));
  };
  const toml::node* names = document.get("names_line");
  description.names_line = line("names_line", 0);
  description.has_no_names = names != nullptr && description.names_line == 0;
  description.units_line = line("units_line", 1);
  description.first_row = line("first_row", 1);
  if (description.has_no_names && description.units_line > 0)
    source.fail(*document.get("units_line"), "units_line needs a row of names; names_line is 0");
  if (description.units_line > 0 && description.units_line <= description.names_line)
    source.fail(*document.get("units_line"),
                fmt::format("units_line is {}; it must be behind names_line ({})", description.units_line,
                            description.names_line));
  if (description.first_row > 0 &&
      description.first_row <= std::max(description.names_line, description.units_line))
    source.fail(*document.get("first_row"), fmt::format("first_row is {}; it must be behind the rows of "
                                                        "names and units",
                                                        description.first_row));
  if (const toml::node* separator = document.get("separator")) {
    const std::string name =
        as_choice(*separator, "separator", {"comma", "semicolon", "tab", "blank"}, source);
    description.separator = name == "comma" ? ',' : name == "semicolon" ? ';' : name == "tab" ? '\t' : ' ';
  }
}

void read_probe(const toml::node& node, const Source& source, Description& description) {
  const toml::table& table = as_table(node, "probe", source);
  check_keys(table, {"xyz_mm", "rpy_deg", "sigma_mm"}, "a probe", source);
  if (const toml::node* xyz = table.get("xyz_mm"))
    description.X_TB.p = as_vector3(*xyz, "xyz_mm", {source}) * mm;
  if (const toml::node* rpy = table.get("rpy_deg"))
    description.X_TB.R = from_rpy(as_vector3(*rpy, "rpy_deg", {source}) * deg);
  if (const toml::node* sigma = table.get("sigma_mm")) {
    description.probe_sigma = as_number(*sigma, {"sigma_mm"}, {source}) * mm;
    if (!(*description.probe_sigma > 0))
      source.fail(*sigma, fmt::format("sigma_mm is {:g}; it must be above 0", *description.probe_sigma / mm));
  }
}

}  // namespace

Description read_description(std::string_view text, const std::string& file, const Machine& machine) {
  const Source source(text, file);
  const toml::table document = source.parse();
  const toml::node* stated = document.get("format");
  if (stated == nullptr || !stated->is_string() || stated->as_string()->get() != format)
    source.fail_at_start(fmt::format("a description of measurements begins with format = \"{}\"", format));
  check_keys(document,
             {"format", "file", "states", "kind", "session", "direction", "frame", "orientation",
              "names_line", "units_line", "first_row", "separator", "columns", "probe"},
             "a description of measurements", source);
  Description description;
  description.file = file;
  const std::string csv =
      as_text(required(document, "file", "the description", document, source), "file", source);
  description.csv = (std::filesystem::path(file).parent_path() / csv).generic_string();
  if (const toml::node* states = document.get("states"))
    description.states =
        (std::filesystem::path(file).parent_path() / as_text(*states, "states", source)).generic_string();
  description.kind = kind_of(document, source);
  read_layout(document, source, description);
  if (const toml::node* session = document.get("session"))
    description.session = without_controls(as_text(*session, "session", source));
  if (const toml::node* direction = document.get("direction"))
    description.direction = as_text(*direction, "direction", source);
  if (const toml::node* frame = document.get("frame"))
    description.has_known_frame = as_choice(*frame, "frame", {"unknown", "machine"}, source) == "machine";
  if (const toml::node* orientation = document.get("orientation"))
    description.rotation_of =
        convention(as_choice(*orientation, "orientation", {"rotvec", "xyz", "zyx"}, source));
  if (const toml::node* columns = document.get("columns"))
    read_columns(as_table(*columns, "columns", source), source, machine, description);
  if (const toml::node* probe = document.get("probe")) read_probe(*probe, source, description);
  return description;
}

}  // namespace counterflex::measurement_file
