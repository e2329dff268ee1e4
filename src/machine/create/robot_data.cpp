#include "machine/create/robot_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/machine/create.hpp"
#include "machine/create/words.hpp"
#include "toml/fields.hpp"

namespace counterflex {
namespace made {
namespace {

using namespace toml_file;

std::string text_of(const toml::table& table, std::string_view key, const Source& source) {
  const toml::node* node = table.get(key);
  return node == nullptr ? "" : as_text(*node, key, source);
}

double value_of(const toml::table& table, std::string_view key, double otherwise, const Source& source) {
  const toml::node* node = table.get(key);
  return node == nullptr ? otherwise : as_number(*node, {key}, {source});
}

/// "xyz_mm = [0, 0, 675], rpy_deg = [0, 90, 0]": those that `table` has.
std::string place_of(const toml::table& table, const Source& source) {
  std::string place;
  for (const std::string_view key : {"xyz_mm", "rpy_deg"})
    if (const toml::node* node = table.get(key))
      place +=
          fmt::format("{}{} = {}", place.empty() ? "" : ", ", key, triple(as_vector3(*node, key, {source})));
  return place;
}

std::string shown_of(const toml::table& table, const Source& source) {
  std::string shown;
  if (const double sign = value_of(table, "sign", 1, source); sign != 1)
    shown += fmt::format(", shown_sign = {}", number(sign));
  if (const double zero = value_of(table, "zero_deg", 0, source); zero != 0)
    shown += fmt::format(", shown_zero_deg = {}", number(zero));
  if (const toml::node* with = table.get("with"))
    for (const auto& [key, factor] : as_table(*with, "with", source))
      shown += fmt::format(", shown_with = {{ {} = {} }}", key.str(),
                           number(as_number(factor, {"with"}, {source})));
  return shown;
}

RobotJoint read_joint(const toml::table& table, const Source& source) {
  RobotJoint joint;
  joint.place = place_of(table, source);
  joint.axis = text_of(table, "axis", source);
  joint.shown = shown_of(table, source);
  joint.min = value_of(table, "min_deg", 0, source);
  joint.max = value_of(table, "max_deg", 0, source);
  joint.home = value_of(table, "home_deg", 0, source);
  if (const toml::node* node = table.get("compliance_urad_per_Nm"))
    joint.compliance = as_positive(*node, {"compliance_urad_per_Nm"}, {source}) * 1e-6;
  if (const toml::node* node = table.get("kg")) joint.kg = as_positive(*node, {"kg"}, {source});
  if (const toml::node* node = table.get("at_mm")) joint.at_mm = as_vector3(*node, "at_mm", {source});
  return joint;
}

Robot read_robot(std::string_view name, const toml::table& table, const Source& source) {
  Robot robot;
  robot.name = name;
  robot.title = text_of(table, "title", source);
  robot.maker = text_of(table, "maker", source);
  robot.payload_kg = value_of(table, "payload_kg", 0, source);
  robot.lengths = text_of(table, "lengths", source);
  robot.stiffness = text_of(table, "stiffness", source);
  robot.masses = text_of(table, "masses", source);
  for (const toml::node& joint : as_array(required(table, "joints", name, table, source), "joints", source))
    robot.joints.push_back(read_joint(as_table(joint, "joints", source), source));
  robot.flange = place_of(as_table(required(table, "flange", name, table, source), "flange", source), source);
  return robot;
}

std::vector<Robot> read_robots() {
  const Source source(robots_toml(), "robots.toml");
  const toml::table document = source.parse();
  std::vector<const toml::key*> keys;
  for (const auto& [key, entry] : document) keys.push_back(&key);
  std::sort(keys.begin(), keys.end(),
            [](const auto* a, const auto* b) { return before(a->source(), b->source()); });
  std::vector<Robot> robots;
  for (const toml::key* key : keys)
    robots.push_back(read_robot(key->str(), as_table(*document.get(key->str()), key->str(), source), source));
  return robots;
}

}  // namespace

const std::vector<Robot>& robots() {
  static const std::vector<Robot> all = read_robots();
  return all;
}

}  // namespace made

std::vector<KnownRobot> known_robots() {
  std::vector<KnownRobot> known;
  for (const made::Robot& robot : made::robots())
    known.push_back({robot.name, robot.title, robot.lengths, robot.stiffness, robot.masses});
  return known;
}

}  // namespace counterflex
