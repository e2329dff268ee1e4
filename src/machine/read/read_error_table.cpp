#include "machine/read/read_error_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex::toml_file {
namespace {

constexpr double arcsec = deg / 3600;
constexpr std::size_t most_positions = 10000;
constexpr std::string_view component_letters = "XYZABC";  // in the order of six-vectors

struct ErrorUnit {
  std::string_view name;
  double si;
  bool is_angle;
};
constexpr std::array<ErrorUnit, 5> error_units = {{{"um", um, false},
                                                   {"mm", mm, false},
                                                   {"um_per_m", um, true},
                                                   {"urad", um, true},
                                                   {"arcsec", arcsec, true}}};

/// The parts of a key: EXX_um is the component X of the axis X.
struct ErrorComponent {
  Eigen::Index index = 0;
  std::string_view axis;
  double si = 1;
};

std::optional<ErrorComponent> error_component(std::string_view key) {
  const std::size_t bar = key.find('_');
  if (bar == std::string_view::npos || bar < 3 || key[0] != 'E') return std::nullopt;
  const std::size_t index = component_letters.find(key[1]);
  const std::string_view axis = key.substr(2, bar - 2);
  const bool is_axis =
      axis[0] >= 'A' && axis[0] <= 'Z' && axis.find_first_not_of("0123456789", 1) == std::string_view::npos;
  if (index == std::string_view::npos || !is_axis) return std::nullopt;
  for (const ErrorUnit& unit : error_units)
    if (unit.name == key.substr(bar + 1) && unit.is_angle == (index >= 3))
      return ErrorComponent{static_cast<Eigen::Index>(index), axis, unit.si};
  return std::nullopt;
}

std::vector<double> read_positions(const toml::node& node, std::string_view key, double unit,
                                   const Source& source) {
  const toml::array& list = as_array(node, key, source);
  if (list.size() < 2)
    source.fail(node, fmt::format("{} has {} value{}; a table of errors needs 2 or more", key, list.size(),
                                  list.size() == 1 ? "" : "s"));
  if (list.size() > most_positions)
    source.fail(node,
                fmt::format("{} has {} values; at most {} are allowed", key, list.size(), most_positions));
  std::vector<double> positions;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double position = as_number(list[i], {key, i + 1}, {source}) * unit;
    if (i > 0 && !(position > positions.back()))
      source.fail(
          list[i],
          fmt::format("{}[{}] = {:.9g} is not above the position before it, {:.9g}; positions must increase",
                      key, i + 1, position / unit, positions.back() / unit));
    positions.push_back(position);
  }
  return positions;
}

/// The components of a table; each position has a value of each of them.
class ComponentReader {
 public:
  ComponentReader(std::string_view owner, std::string_view positions_key, const Source& source,
                  ErrorTable& table)
      : owner_(owner), positions_key_(positions_key), source_(source), table_(table) {
    table.errors.assign(table.positions.size(), Vector6::Zero());
  }

  void read(const toml::key& key, const toml::node& node) {
    const std::optional<ErrorComponent> component = error_component(key.str());
    if (!component)
      source_.fail(
          key,
          fmt::format("unknown key \"{}\" in {}; its errors are EXX_um, EYX_um, EZX_um, EAX_um_per_m, "
                      "EBX_um_per_m, ECX_um_per_m, with the letter of the axis in the place of the last X. "
                      "Units: um, mm; um_per_m, urad, arcsec",
                      key.str(), owner_));
    if (axis_.empty()) axis_ = component->axis;
    if (axis_ != component->axis)
      source_.fail(key, fmt::format("{} has errors of the axes {} and {}; all of a table are of one axis",
                                    owner_, axis_, component->axis));
    std::string_view& before = given_[static_cast<std::size_t>(component->index)];
    if (!before.empty())
      source_.fail(key, fmt::format("{} has both {} and {}; give one", owner_, before, key.str()));
    before = key.str();
    read_values(key.str(), node, *component);
  }

  bool any() const { return !axis_.empty(); }

 private:
  void read_values(std::string_view key, const toml::node& node, const ErrorComponent& component) {
    const toml::array& list = as_array(node, key, source_);
    if (list.size() != table_.positions.size())
      source_.fail(node, fmt::format("{} has {} values, but {} has {}; both must have as many", key,
                                     list.size(), positions_key_, table_.positions.size()));
    for (std::size_t i = 0; i < list.size(); ++i)
      table_.errors[i][component.index] = as_number(list[i], {key, i + 1}, {source_}) * component.si;
  }

  std::string_view owner_, positions_key_;
  const Source& source_;
  ErrorTable& table_;
  std::string_view axis_{};
  std::array<std::string_view, 6> given_{};
};

/// The optional key sigma_UNIT: how well the errors of the axis' own motion are known.
std::optional<double> read_sigma(const toml::table& table, JointKind kind, std::string_view owner,
                                 const Source& source) {
  std::vector<std::string> keys;
  for (const ErrorUnit& unit : error_units)
    if (unit.is_angle == (kind == JointKind::revolute)) keys.push_back(fmt::format("sigma_{}", unit.name));
  for (const auto& [key, value] : table)
    if (key.str().starts_with("sigma_") && std::find(keys.begin(), keys.end(), key.str()) == keys.end())
      source.fail(key, fmt::format("unknown key \"{}\" in {}; use one of {}", key.str(), owner,
                                   fmt::join(keys, ", ")));
  const std::string_view form = one_of(table, {keys.begin(), keys.end()}, owner, source);
  if (form.empty()) return {};
  for (const ErrorUnit& unit : error_units)
    if (unit.name == form.substr(form.find('_') + 1))
      return as_positive(*table.get(form), {form}, {source}) * unit.si;
  return {};
}

}  // namespace

KindedTable read_error_table(const toml::node& node, const std::string& name, const Source& source) {
  const std::string owner = fmt::format("error table \"{}\"", name);
  const toml::table& table = as_table(node, owner, source);
  const std::string_view form = one_of(table, {"positions_mm", "positions_deg"}, owner, source);
  if (form.empty())
    source.fail(node, fmt::format("{} has no positions; give positions_mm, or positions_deg of a rotary axis",
                                  owner));
  const JointKind kind = form == "positions_mm" ? JointKind::prismatic : JointKind::revolute;
  KindedTable result{{name}, kind};
  result.table.positions =
      read_positions(*table.get(form), form, kind == JointKind::prismatic ? mm : deg, source);
  result.table.sigma = read_sigma(table, kind, owner, source);
  ComponentReader components(owner, form, source, result.table);
  std::vector<std::pair<const toml::key*, const toml::node*>> entries;
  for (const auto& [key, value] : table)
    if (key.str() != form && !key.str().starts_with("sigma_")) entries.emplace_back(&key, &value);
  std::ranges::sort(
      entries, [](const auto& a, const auto& b) { return before(a.first->source(), b.first->source()); });
  for (const auto& [key, value] : entries) components.read(*key, *value);
  if (!components.any()) source.fail(node, fmt::format("{} has no errors; give EXX_um or others", owner));
  return result;
}

const ErrorTable& checked_for(const Actuator& actuator, const KindedTable& found, const toml::node& node,
                              const Source& source) {
  if (found.kind != actuator.joint.kind)
    source.fail(node,
                fmt::format("error table \"{}\" has {}, but the actuator is {}; use {}", found.table.name,
                            found.kind == JointKind::prismatic ? "positions_mm" : "positions_deg",
                            found.kind == JointKind::prismatic ? "rotary" : "linear",
                            found.kind == JointKind::prismatic ? "positions_deg" : "positions_mm"));
  if (!actuator.shown.coupled.empty())
    source.fail(node,
                "error_table is not allowed with shown_with: its positions would depend on two actuators");
  return found.table;
}

}  // namespace counterflex::toml_file
