#include "machine/read/read_fixture.hpp"

#include <fmt/format.h>

#include "counterflex/geometry/types.hpp"
#include "machine/definiteness.hpp"
#include "machine/read/read_spring.hpp"
#include "machine/read/read_transform.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {
namespace {

const std::vector<std::string_view> stiffness_forms = {"stiffness_N_per_um", "stiffness_si", "compliance_si"};

Matrix6 read_compliance_matrix(const toml::node& node, std::string_view form, const Source& source) {
  if (form != "stiffness_N_per_um") return symmetric_inverse(read_definite_stiffness(node, form, source));
  // A fixture that shifts and does not turn.
  Matrix6 C = Matrix6::Zero();
  const Vector3 k = as_vector3(node, form, {source}) * N_per_um;
  for (int i = 0; i < 3; ++i) {
    if (!(k[i] > 0))
      source.fail(
          node, fmt::format("stiffness_N_per_um[{}] is {:.6g}; it must be positive", i + 1, k[i] / N_per_um));
    C(i, i) = 1 / k[i];
  }
  return C;
}

Pose read_place(const toml::table& table, const Source& source, const Machine& machine) {
  const toml::node* node = table.get("work");
  if (node == nullptr) return {};
  const std::string name = as_text(*node, "work", source);
  const std::optional<std::string> offset = work_offset_name(name);
  const auto found = offset ? machine.work.find(*offset) : machine.work.end();
  if (found == machine.work.end()) {
    std::string known;
    for (const auto& entry : machine.work) known += (known.empty() ? "" : ", ") + entry.first;
    source.fail(*node, fmt::format("work is \"{}\"; it must be a work offset of the machine file: {}", name,
                                   known.empty() ? "it has no [work]" : known));
  }
  return found->second.X_MW;
}

/// Numbers of a list as long as `count`, or of any length.
std::vector<double> read_list(const toml::node& node, std::string_view key, std::optional<std::size_t> count,
                              const Source& source) {
  const toml::array& list = as_array(node, key, source);
  if (count && list.size() != *count)
    source.fail(node, fmt::format("{} has {} values, but temperature_C has {}; both must have as many", key,
                                  list.size(), *count));
  std::vector<double> values;
  for (std::size_t i = 0; i < list.size(); ++i) values.push_back(as_number(list[i], {key, i + 1}, {source}));
  return values;
}

}  // namespace

void read_fixture(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("fixture");
  if (node == nullptr) return;
  std::vector<std::string_view> keys = stiffness_forms;
  keys.push_back("work");
  Fixture fixture{read_transform(*node, "[fixture]", {source}, keys)};
  const toml::table& table = *node->as_table();
  const std::string_view form = one_of(table, stiffness_forms, "[fixture]", source);
  if (form.empty())
    source.fail(*node,
                fmt::format("[fixture] has no stiffness; give one of {}", fmt::join(stiffness_forms, ", ")));
  fixture.X_MF = read_place(table, source, machine) * fixture.X_MF;
  fixture.C = read_compliance_matrix(*table.get(form), form, source);
  machine.fixture = fixture;
}

void read_thermal(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("thermal");
  if (node == nullptr) return;
  const toml::table& table = as_table(*node, "[thermal]", source);
  check_keys(table, {"temperature_C", "x_um", "y_um", "z_um", "spindle_um"}, "[thermal]", source);
  ThermalTable thermal;
  const toml::node& temperatures = required(table, "temperature_C", "[thermal]", *node, source);
  thermal.temperatures = read_list(temperatures, "temperature_C", {}, source);
  const std::size_t count = thermal.temperatures.size();
  if (count < 2) source.fail(temperatures, "temperature_C has less than two values; it needs two or more");
  for (std::size_t i = 1; i < count; ++i)
    if (!(thermal.temperatures[i] > thermal.temperatures[i - 1]))
      source.fail(*temperatures.as_array()->get(i),
                  fmt::format("temperature_C[{}] is {:.6g}, not above the one before it ({:.6g}); "
                              "temperatures must increase",
                              i + 1, thermal.temperatures[i], thermal.temperatures[i - 1]));
  thermal.shift.assign(count, Vector3::Zero());
  thermal.growth.assign(count, 0);
  bool any = false;
  const auto read = [&](std::string_view key, const auto& put) {
    const toml::node* list = table.get(key);
    if (list == nullptr) return;
    any = true;
    const std::vector<double> values = read_list(*list, key, count, source);
    for (std::size_t i = 0; i < count; ++i) put(i, values[i] * um);
  };
  read("x_um", [&](std::size_t i, double value) { thermal.shift[i].x() = value; });
  read("y_um", [&](std::size_t i, double value) { thermal.shift[i].y() = value; });
  read("z_um", [&](std::size_t i, double value) { thermal.shift[i].z() = value; });
  read("spindle_um", [&](std::size_t i, double value) { thermal.growth[i] = value; });
  if (!any) source.fail(*node, "[thermal] has no shift; give x_um, y_um, z_um or spindle_um");
  machine.thermal = thermal;
}

}  // namespace counterflex::toml_file
