#include "machine/read/read_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/program/dialects.hpp"
#include "machine/read/read_load_limits.hpp"
#include "machine/read/read_transform.hpp"
#include "machine/spindle_axes.hpp"
#include "toml/suggest.hpp"

namespace counterflex::toml_file {
namespace {

const std::vector<std::string_view> component_names = {"x", "y", "z", "rx", "ry", "rz"};

constexpr double strongest_gravity = 100;  // m/s2: larger values probably have a wrong unit

/// "true" is the former spelling of "machine".
Datum read_datum(const toml::node& node, const Source& source) {
  if (const auto* text = node.as_string(); text != nullptr && (*text == "machine" || *text == "true"))
    return {.is_machine = true};
  if (!node.is_table())
    source.fail(node, fmt::format("datum must be \"machine\" or {{ touched_at_mm = [x, y, z] }}, not {}",
                                  seen(node)));
  const toml::table& table = *node.as_table();
  check_keys(table, {"touched_at_mm"}, "a datum", source);
  const toml::node& touched = required(table, "touched_at_mm", "a datum", node, source);
  return {.touched_at = Vector3(as_vector3(touched, "touched_at_mm", {source}) * mm)};
}

std::string read_offset_name(const toml::key& key, const Source& source) {
  const auto name = work_offset_name(key.str());
  if (!name)
    source.fail(key, fmt::format("\"{}\" is not a work offset; use {}", key.str(), work_offset_names));
  return *name;
}

/// An axis letter, in upper case.
std::string read_axis_letter(const toml::node& node, const Source& source) {
  std::string axis = as_text(node, "an axis of tool_change_moves", source);
  if (axis.size() == 1 && axis[0] >= 'a' && axis[0] <= 'z') axis[0] = static_cast<char>(axis[0] - 'a' + 'A');
  if (axis.size() != 1 || std::string_view("XYZABCUVW").find(axis[0]) == std::string_view::npos)
    source.fail(
        node,
        fmt::format("an axis of tool_change_moves is \"{}\"; allowed: X, Y, Z, A, B, C, U, V, W", axis));
  return axis;
}

std::vector<std::string> read_tool_change_moves(const toml::node& node, const Source& source) {
  std::vector<std::string> axes;
  for (const toml::node& entry : as_array(node, "tool_change_moves", source)) {
    const std::string axis = read_axis_letter(entry, source);
    if (std::find(axes.begin(), axes.end(), axis) != axes.end())
      source.fail(entry, fmt::format("tool_change_moves names {} twice", axis));
    axes.push_back(axis);
  }
  return axes;
}

std::set<std::string, std::less<>> read_harmless_calls(const toml::node& node, const Source& source) {
  std::set<std::string, std::less<>> names;
  for (const toml::node& entry : as_array(node, "harmless_calls", source)) {
    const std::string text = as_text(entry, "a name of harmless_calls", source);
    std::string name;
    for (const char c : text)
      if (c != ' ') name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (name.empty() || name.find_first_of("()\"'") != std::string::npos)
      source.fail(entry,
                  fmt::format("a name of harmless_calls is \"{}\"; write the name of a program without "
                              "brackets and quotes: \"SPINDLE_ON\", \"O9001\"",
                              text));
    if (!names.insert(std::move(name)).second)
      source.fail(entry, fmt::format("harmless_calls names \"{}\" twice", text));
  }
  return names;
}

/// A day, as a date of TOML or in quotes: "2026-11-20".
std::string read_day(const toml::node& node, std::string_view name, const Source& source) {
  if (const auto* day = node.as_date())
    return fmt::format("{:04}-{:02}-{:02}", day->get().year, day->get().month, day->get().day);
  const auto* text = node.as_string();
  const auto digits = [&](std::size_t begin, std::size_t count) {
    int value = 0;
    for (const char c : text->get().substr(begin, count))
      value = value < 0 || c < '0' || c > '9' ? -1 : 10 * value + (c - '0');
    return value;
  };
  if (text != nullptr && text->get().size() == 10 && text->get()[4] == '-' && text->get()[7] == '-') {
    const int year = digits(0, 4), month = digits(5, 2), day = digits(8, 2);
    if (year >= 0 && month >= 0 && day >= 0 &&
        std::chrono::year_month_day(std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                    std::chrono::day(static_cast<unsigned>(day)))
            .ok())
      return text->get();
  }
  source.fail(node, fmt::format("{} must be a day as 2026-11-20, not {}", name, seen(node)));
}

}  // namespace

void read_identity(const toml::table& document, const Source& source, Machine& machine) {
  if (const toml::node* serial = document.get("serial"))
    machine.serial = without_controls(as_text(*serial, "serial", source));
  if (const toml::node* date = document.get("date")) machine.date = read_day(*date, "date", source);
}

void read_controlled(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("controlled");
  if (node == nullptr) return;
  std::array<bool, 6> listed{};
  for (const toml::node& entry : as_array(*node, "controlled", source)) {
    const std::string name = as_choice(entry, "a controlled component", component_names, source);
    const auto index = static_cast<std::size_t>(
        std::find(component_names.begin(), component_names.end(), name) - component_names.begin());
    if (listed[index]) source.fail(entry, fmt::format("controlled names {} twice", name));
    listed[index] = true;
  }
  for (int i = 0; i < 6; ++i)
    if (listed[static_cast<std::size_t>(i)]) machine.controlled.push_back(static_cast<Component>(i));
}

void read_home(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("home");
  if (node == nullptr) return;
  machine.home_X_MP = read_transform(*node, "[home]", {source});
  machine.home_at = source.at(key_of(document, "home").source());
}

void read_gravity(const toml::table& document, const Source& source, Machine& machine) {
  Gravity& gravity = machine.gravity;
  const toml::node* g = document.get("gravity_m_s2");
  if (g != nullptr) {
    gravity.g = gravity.of_hung = as_vector3(*g, "gravity_m_s2", {source});
    if (!(gravity.g.norm() > 0))
      source.fail(*g, "gravity_m_s2 is a zero vector; leave it out if there is no weight");
    if (!(gravity.g.norm() <= strongest_gravity))
      source.fail(*g, fmt::format("gravity_m_s2 has the length {:.6g}; it is in m/s2, at most {} is allowed",
                                  gravity.g.norm(), strongest_gravity));
  }
  const toml::node* reference = document.get("gravity_reference");
  if (reference == nullptr) return;
  const std::string when = as_choice(*reference, "gravity_reference", {"unloaded", "home"}, source);
  if (g == nullptr)
    source.fail(key_of(document, "gravity_reference"),
                "gravity_reference needs gravity_m_s2: without it there is no weight");
  gravity.true_at_home = when == "home";
  gravity.reference_at = source.at(reference->source());
  if (gravity.true_at_home && machine.controlled.empty())
    source.fail(*reference,
                "gravity_reference is \"home\", but controlled is empty: the control must hold at least one "
                "component of the tip at home");
}

void read_tool(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("tool");
  machine.tool_at = node != nullptr ? source.at(key_of(document, "tool").source()) : Location{source.file()};
  if (node == nullptr) return;
  machine.X_PT = read_transform(*node, "[tool]", {source}, {"allow_inverted", "spindle_axis", "mass"});
  if (const toml::node* axis = node->as_table()->get("spindle_axis")) {
    const std::string name = as_choice(*axis, "spindle_axis", spindle_axis_names, source);
    const auto place = std::ranges::find(spindle_axis_names, name) - spindle_axis_names.begin();
    machine.spindle_axis = static_cast<SpindleAxis>(place);
    machine.X_PT.R = machine.X_PT.R * tool_axes(machine.spindle_axis);
  }
  if (const toml::node* allowed = node->as_table()->get("allow_inverted"))
    machine.allows_inverted_tool = as_truth(*allowed, "allow_inverted", source);
}

void read_spindle(const toml::table& document, const Source& source, Machine& machine) {
  if (const toml::node* node = document.get("spindle")) {
    machine.X_PS = read_transform(*node, "[spindle]", {source});
    machine.X_PS->R = machine.X_PS->R * tool_axes(machine.spindle_axis);
  }
}

void read_work(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("work");
  if (node == nullptr) return;
  if (const auto* text = node->as_string(); text != nullptr && *text == "machine") {
    machine.work_is_machine_frame = true;
    return;
  }
  if (!node->is_table())
    source.fail(*node, fmt::format("work must be \"machine\" or tables as [work.G54], not {}", seen(*node)));
  for (const auto& [key, entry] : *node->as_table()) {
    const std::string name = read_offset_name(key, source);
    WorkOffset offset{
        read_transform(entry, fmt::format("[work.{}]", key.str()), {source}, {"datum", "offset_mm"}), {}};
    if (const toml::node* datum = entry.as_table()->get("datum")) offset.datum = read_datum(*datum, source);
    if (const toml::node* shown = entry.as_table()->get("offset_mm"))
      offset.shown = as_vector3(*shown, "offset_mm", {source}) * mm;
    if (!machine.work.emplace(name, offset).second)
      source.fail(key, fmt::format("work offset {} is defined twice", name));
  }
}

void read_program(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("program");
  if (node == nullptr) return;
  const toml::table& table = as_table(*node, "program", source);
  check_keys(table, {"dialect", "units", "tool_change_moves", "arc_centres", "harmless_calls"}, "[program]",
             source);
  if (const toml::node* dialect = table.get("dialect"))
    machine.control.dialect = as_choice(*dialect, "dialect", known_dialects(), source);
  if (const toml::node* units = table.get("units"))
    machine.control.units = as_choice(*units, "units", {"mm", "inch"}, source);
  if (const toml::node* moves = table.get("tool_change_moves"))
    machine.control.tool_change_moves = read_tool_change_moves(*moves, source);
  if (const toml::node* calls = table.get("harmless_calls"))
    machine.control.harmless_calls = read_harmless_calls(*calls, source);
  if (const toml::node* centres = table.get("arc_centres"))
    machine.control.absolute_centres =
        std::string(as_choice(*centres, "arc_centres", {"incremental", "absolute"}, source)) == "absolute";
}

namespace {

std::vector<Corrected> read_already_corrects(const toml::node& node, const Source& source) {
  const std::vector<std::string_view> allowed(corrected_names.begin(), corrected_names.end());
  std::vector<Corrected> corrects;
  for (const toml::node& entry : as_array(node, "already_corrects", source)) {
    const std::string name = as_choice(entry, "already_corrects", allowed, source);
    const auto which = static_cast<Corrected>(std::ranges::find(allowed, name) - allowed.begin());
    if (std::ranges::find(corrects, which) != corrects.end())
      source.fail(entry, fmt::format("already_corrects names \"{}\" twice", name));
    corrects.push_back(which);
  }
  return corrects;
}

}  // namespace

void read_controller(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("controller");
  if (node == nullptr) return;
  const toml::table& table = as_table(*node, "controller", source);
  check_keys(table, {"kinematics", "joint_values", "already_corrects"}, "[controller]", source);
  if (const toml::node* joint_values = table.get("joint_values"))
    machine.joint_values_as_shown =
        as_choice(*joint_values, "joint_values", {"as_shown"}, source) == "as_shown";
  if (const toml::node* kinematics = table.get("kinematics"))
    machine.kinematics = as_choice(*kinematics, "kinematics", {"catalogue", "factory"}, source) == "factory"
                             ? ControlKinematics::factory
                             : ControlKinematics::catalogue;
  if (const toml::node* corrects = table.get("already_corrects"))
    machine.already_corrects = read_already_corrects(*corrects, source);
}

void read_limits(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("limits");
  if (node == nullptr) return;
  const toml::table& table = as_table(*node, "limits", source);
  check_keys(table, with_load_keys({"max_correction_mm"}), "[limits]", source);
  if (const toml::node* most = table.get("max_correction_mm"))
    machine.max_correction = as_positive(*most, {"max_correction_mm"}, {source}) * mm;
}

}  // namespace counterflex::toml_file
