#include "counterflex/machine/read_machine.hpp"

#include <fmt/format.h>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "machine/corrected.hpp"
#include "machine/read/read_chains.hpp"
#include "machine/read/read_fixture.hpp"
#include "machine/read/read_load_limits.hpp"
#include "machine/read/read_parameters.hpp"
#include "machine/read/read_settings.hpp"
#include "machine/read/read_shown.hpp"
#include "machine/read/read_tools.hpp"
#include "machine/read/read_uncertainty.hpp"
#include "toml/fields.hpp"

namespace counterflex {
namespace {

using namespace toml_file;

void check_format(const toml::table& document, const Source& source, std::string_view format,
                  std::string_view kind) {
  const toml::node* node = document.get("format");
  if (node == nullptr)
    source.fail_at_start(fmt::format("no format; {} begins with format = \"{}\"", kind, format));
  const auto* text = node->as_string();
  if (text == nullptr || text->get() != format)
    source.fail(*node, fmt::format("format is {}; it must be \"{}\"", seen(*node), format));
}

/// Throws unless `controlled` has as many components as there are actuators, or is empty.
void check_controlled(const toml::table& document, const Source& source, const Machine& machine) {
  const std::size_t count = actuators(machine).size();
  if (machine.controlled.empty() || machine.controlled.size() == count) return;
  const toml::node& node = *document.get("controlled");
  if (count > 6)
    source.fail(node,
                fmt::format("the machine has {} actuators; with more than 6, controlled must be []", count));
  source.fail(node, fmt::format("controlled names {} of the tip's components, but the number of actuators is "
                                "{}; it must name as many, or be []",
                                machine.controlled.size(), count));
}

void check_home(const toml::table& document, const Source& source, const Machine& machine) {
  if (machine.chains.size() < 2 || machine.home_X_MP) return;
  source.fail(*document.get("chain")->as_array()->get(1),
              "a machine of more than one chain needs [home], the pose where its inverse kinematics starts");
}

/// The mass of [tool] is fixed to the platform, at the end of the first chain.
void add_tool_mass(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* tool = document.get("tool");
  const toml::node* node = tool == nullptr ? nullptr : tool->as_table()->get("mass");
  if (node == nullptr) return;
  PointMass mass = read_tool_mass(*node, source);
  mass.at = machine.X_PT * mass.at;
  machine.chains.front().elements.push_back(mass);
  machine.ends_with_tool_mass = true;
}

}  // namespace

Machine read_machine(std::string_view text, const std::string& file) {
  const Source source(text, file);
  const toml::table document = source.parse();
  check_format(document, source, "counterflex-machine 1", "a machine file");
  check_keys(document, {"format",       "name",       "serial",       "date",
                        "controlled",   "home",       "gravity_m_s2", "gravity_reference",
                        "tool",         "spindle",    "tools",        "work",
                        "fixture",      "thermal",    "program",      "controller",
                        "limits",       "parameters", "uncertainty",  "springs",
                        "error_tables", "branches",   "templates",    "chain"},
             "a machine file", source);
  Machine machine;
  if (const toml::node* name = document.get("name"))
    machine.name = without_controls(as_text(*name, "name", source));
  read_identity(document, source, machine);
  read_controlled(document, source, machine);
  read_home(document, source, machine);
  read_gravity(document, source, machine);
  read_tool(document, source, machine);
  read_spindle(document, source, machine);
  read_tools(document, source, machine);
  read_work(document, source, machine);
  read_fixture(document, source, machine);
  read_thermal(document, source, machine);
  read_program(document, source, machine);
  read_controller(document, source, machine);
  read_limits(document, source, machine);
  machine.chains = read_chains(document, source);
  add_tool_mass(document, source, machine);
  convert_homes(machine);
  read_load_limits(document, source, machine);
  read_parameters(document, source, machine);
  machine.uncertainty = toml_file::read_uncertainty(document, source, machine);
  if (!machine.home_X_MP) machine.home_at = source.at(document.get("chain")->as_array()->get(0)->source());
  check_controlled(document, source, machine);
  check_home(document, source, machine);
  leave_out_corrected(machine);
  return machine;
}

Uncertainty read_uncertainty(std::string_view text, const std::string& file, const Machine& machine) {
  const Source source(text, file);
  const toml::table document = source.parse();
  check_format(document, source, "counterflex-uncertainty 1", "an uncertainty file");
  check_keys(document, {"format", "uncertainty"}, "an uncertainty file", source);
  const std::optional<Uncertainty> read = toml_file::read_uncertainty(document, source, machine);
  if (!read) source.fail_at_start("no [uncertainty]; an uncertainty file has this table");
  return *read;
}

Machine load_machine(const std::string& file) {
  return read_machine(read_file(file), file);
}

}  // namespace counterflex
