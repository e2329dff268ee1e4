#include "machine/read/read_joint.hpp"

#include <fmt/format.h>

#include <array>

#include "counterflex/geometry/types.hpp"
#include "machine/read/read_spring.hpp"

namespace counterflex::toml_file {
namespace {

/// The keys of a kind of joint, and the unit of its values.
struct JointKeys {
  JointKind kind;
  std::string_view name;
  double unit;
  std::string_view min, max, home, preload, stiffness, compliance;
  std::array<std::string_view, 2> reversal;  ///< of which each has its unit in `reversal_units`
  std::array<double, 2> reversal_units;
  std::string_view knee, stiffness_above;
  std::string_view stiffness_per_arcmin{}, stiffness_above_per_arcmin{};  ///< of rotary joints
};

constexpr JointKeys prismatic = {JointKind::prismatic,
                                 "prismatic",
                                 mm,
                                 "min_mm",
                                 "max_mm",
                                 "home_mm",
                                 "preload_mm",
                                 "stiffness_N_per_m",
                                 "compliance_m_per_N",
                                 {"reversal_um", "reversal_mm"},
                                 {um, mm},
                                 "knee_N",
                                 "stiffness_above_N_per_m"};
constexpr JointKeys revolute = {JointKind::revolute,
                                "revolute",
                                deg,
                                "min_deg",
                                "max_deg",
                                "home_deg",
                                "preload_deg",
                                "stiffness_Nm_per_rad",
                                "compliance_rad_per_Nm",
                                {"reversal_mdeg", "reversal_arcsec"},
                                {1e-3 * deg, deg / 3600},
                                "knee_Nm",
                                "stiffness_above_Nm_per_rad",
                                "stiffness_Nm_per_arcmin",
                                "stiffness_above_Nm_per_arcmin"};

constexpr double per_arcmin = 10800 / pi;  // 1 N m/arcmin in N m/rad

std::string_view unit_of(const JointKeys& keys) {
  return keys.kind == JointKind::prismatic ? "N/m" : "N m/rad";
}

/// The keys that give a stiffness.
std::vector<std::string_view> stiffness_keys(const JointKeys& keys) {
  std::vector<std::string_view> all = {keys.stiffness};
  if (!keys.stiffness_per_arcmin.empty()) all.push_back(keys.stiffness_per_arcmin);
  return all;
}

/// A value under one of these keys in SI.
double stiffness_in_si(double value, std::string_view form, const JointKeys& keys) {
  return form == keys.stiffness ? value : value * per_arcmin;
}

const JointKeys& read_kind(const toml::table& table, std::string_view element, const Source& source) {
  const toml::node& node = *table.get(element);
  const std::string kind = as_text(node, element, source);
  if (kind == prismatic.name) return prismatic;
  if (kind == revolute.name) return revolute;
  source.fail(node, fmt::format("{} is \"{}\"; it must be \"prismatic\" or \"revolute\"", element, kind));
}

Vector3 read_axis(const toml::node& node, const Reading& reading) {
  if (const auto* text = node.as_string()) {
    if (text->get() == "x") return Vector3::UnitX();
    if (text->get() == "y") return Vector3::UnitY();
    if (text->get() == "z") return Vector3::UnitZ();
  }
  if (!node.is_array() || node.as_array()->size() != 3)
    reading.source.fail(node,
                        fmt::format("axis must be \"x\", \"y\", \"z\" or 3 numbers, not {}", seen(node)));
  const Vector3 axis = as_vector3(node, "axis", reading);
  if (!(axis.stableNorm() > 0))
    reading.source.fail(
        node, fmt::format("axis is a zero vector{}; it must have a direction", filled_by(node, reading)));
  return axis.stableNormalized();
}

Joint read_joint(const toml::table& table, const JointKeys& keys, std::string_view owner,
                 const Reading& reading) {
  return {keys.kind, read_axis(required(table, "axis", owner, table, reading.source), reading)};
}

/// The value under `key` in SI, or `otherwise`.
double joint_value(const toml::table& table, std::string_view key, const JointKeys& keys, double otherwise,
                   const Reading& reading) {
  const toml::node* node = table.get(key);
  return node == nullptr ? otherwise : as_number(*node, {key}, reading) * keys.unit;
}

template <class WithTravel>
void read_travel(WithTravel& joint, const toml::table& table, const JointKeys& keys, const Reading& reading) {
  joint.min = joint_value(table, keys.min, keys, joint.min, reading);
  joint.max = joint_value(table, keys.max, keys, joint.max, reading);
  if (joint.min < joint.max) return;
  const toml::node& max = *table.get(keys.max);
  std::string origin = filled_by(max, reading);
  if (origin.empty()) origin = filled_by(*table.get(keys.min), reading);
  reading.source.fail(max, fmt::format("{} = {:.9g} is not above {} = {:.9g}{}", keys.max,
                                       joint.max / keys.unit, keys.min, joint.min / keys.unit, origin));
}

void read_reversal(const toml::table& table, const JointKeys& keys, std::string_view owner,
                   const Reading& reading, Actuator& actuator) {
  const std::string_view form = one_of(table, {keys.reversal[0], keys.reversal[1]}, owner, reading.source);
  for (const std::string_view key : {form, std::string_view("error_table")})
    if (actuator.program_axis > 0 && table.contains(key))
      reading.source.fail(key_of(table, key),
                          fmt::format("{} is not allowed with program_axis: the axis does not move", key));
  if (form.empty()) return;
  const double unit = keys.reversal_units[form == keys.reversal[0] ? 0 : 1];
  actuator.reversal = as_not_negative(*table.get(form), {form}, reading) * unit;
}

/// a1, b1 and perhaps a2, b2 in 0.001 deg.
void read_harmonics(const toml::table& table, std::string_view owner, const Reading& reading,
                    Actuator& actuator) {
  const toml::node* node = table.get("harmonics_mdeg");
  if (node == nullptr) return;
  for (const std::string_view other : {"program_axis", "error_table"})
    if (table.contains(other))
      reading.source.fail(
          key_of(table, "harmonics_mdeg"),
          fmt::format("{} has both harmonics_mdeg and {}; an axis has one of them", owner, other));
  const toml::array& list = as_array(*node, "harmonics_mdeg", reading.source);
  if (list.size() != 2 && list.size() != 4)
    reading.source.fail(*node, fmt::format("harmonics_mdeg has {} values; it needs 2, of sin q and cos q, or "
                                           "4, with those of sin 2q and cos 2q",
                                           list.size()));
  for (std::size_t i = 0; i < list.size(); ++i)
    actuator.harmonics.push_back(as_number(list[i], {"harmonics_mdeg", i + 1}, reading) * 1e-3 * deg);
}

void read_preload(Passive& passive, const toml::table& table, const JointKeys& keys, std::string_view owner,
                  const Reading& reading) {
  const std::string_view form = one_of(table, {"preload", keys.preload}, owner, reading.source);
  if (form.empty()) return;
  if (one_of(table, stiffness_keys(keys), owner, reading.source).empty())
    reading.source.fail(key_of(table, form), fmt::format("{} needs {}: a joint without a spring moves freely",
                                                         form, keys.stiffness));
  if (form == keys.preload) {
    passive.rest = joint_value(table, form, keys, 0, reading);
    return;
  }
  check_preload_home(*table.get(form), fmt::format(", or give {}", keys.preload), reading.source);
  passive.rest_at_home = true;
}

/// The keys that give the stiffness above the knee.
std::vector<std::string_view> stiffness_above_keys(const JointKeys& keys) {
  std::vector<std::string_view> all = {keys.stiffness_above};
  if (!keys.stiffness_above_per_arcmin.empty()) all.push_back(keys.stiffness_above_per_arcmin);
  return all;
}

void read_second_slope(const toml::table& table, const JointKeys& keys, std::string_view owner,
                       const Reading& reading, Compliance& compliance) {
  const std::string_view form = one_of(table, stiffness_above_keys(keys), owner, reading.source);
  const toml::node* knee = table.get(keys.knee);
  if (form.empty() && knee == nullptr) return;
  if (form.empty() || knee == nullptr)
    reading.source.fail(
        key_of(table, form.empty() ? keys.knee : form),
        fmt::format("{} has {} without {}; a second slope needs both", owner, form.empty() ? keys.knee : form,
                    form.empty() ? keys.stiffness_above : keys.knee));
  SecondSlope beyond;
  beyond.knee = as_positive(*knee, {keys.knee}, reading);
  const double value = as_positive(*table.get(form), {form}, reading);
  beyond.stiffness = form == keys.stiffness_above ? value : value * per_arcmin;
  refuse_too_stiff(beyond.stiffness, owner, unit_of(keys), *table.get(form), reading.source);
  compliance.beyond = beyond;
}

}  // namespace

Actuator read_actuator(const toml::table& table, const Reading& reading, ActuatorsBefore& before) {
  const JointKeys& keys = read_kind(table, "actuator", reading.source);
  const std::string owner = fmt::format("a {} actuator", keys.name);
  std::vector<std::string_view> allowed = {"actuator", "axis",        keys.min, keys.max,
                                           keys.home,  "error_table", "mass"};
  allowed.insert(allowed.end(), keys.reversal.begin(), keys.reversal.end());
  if (keys.kind == JointKind::revolute) allowed.push_back("harmonics_mdeg");
  for (const std::string_view key : shown_keys(keys.kind)) allowed.push_back(key);
  check_keys(table, allowed, owner, reading.source);
  Actuator actuator;
  actuator.joint = read_joint(table, keys, owner, reading);
  read_travel(actuator, table, keys, reading);
  actuator.home = joint_value(table, keys.home, keys, 0, reading);
  read_shown(table, reading, before, actuator);
  read_reversal(table, keys, owner, reading, actuator);
  read_harmonics(table, owner, reading, actuator);
  return actuator;
}

Passive read_passive(const toml::table& table, const Reading& reading) {
  const JointKeys& keys = read_kind(table, "passive", reading.source);
  const std::string owner = fmt::format("a {} passive joint", keys.name);
  std::vector<std::string_view> allowed = {"passive", "axis",       keys.min,  keys.max,
                                           keys.home, keys.preload, "preload", "mass"};
  for (const std::string_view key : stiffness_keys(keys)) allowed.push_back(key);
  check_keys(table, allowed, owner, reading.source);
  Passive passive;
  passive.joint = read_joint(table, keys, owner, reading);
  read_travel(passive, table, keys, reading);
  passive.home = joint_value(table, keys.home, keys, 0, reading);
  const std::string_view form = one_of(table, stiffness_keys(keys), owner, reading.source);
  if (!form.empty()) {
    const toml::node& node = *table.get(form);
    passive.stiffness = stiffness_in_si(as_not_negative(node, {form}, reading), form, keys);
    refuse_too_stiff(passive.stiffness, owner, unit_of(keys), node, reading.source);
  }
  read_preload(passive, table, keys, owner, reading);
  return passive;
}

Compliance read_compliance(const toml::table& table, const Reading& reading) {
  const JointKeys& keys = read_kind(table, "compliance", reading.source);
  const std::string owner = fmt::format("a {} compliance", keys.name);
  std::vector<std::string_view> forms = stiffness_keys(keys);
  forms.push_back(keys.compliance);
  std::vector<std::string_view> allowed = {"compliance", "axis", "preload", "mass", "name"};
  allowed.insert(allowed.end(), forms.begin(), forms.end());
  allowed.push_back(keys.knee);
  for (const std::string_view key : stiffness_above_keys(keys)) allowed.push_back(key);
  check_keys(table, allowed, owner, reading.source);
  Compliance compliance;
  compliance.joint = read_joint(table, keys, owner, reading);
  const std::string_view form = one_of(table, forms, owner, reading.source);
  if (form.empty())
    reading.source.fail(table,
                        fmt::format("{} has neither {} nor {}", owner, keys.stiffness, keys.compliance));
  const double value = as_positive(*table.get(form), {form}, reading);
  compliance.stiffness = form == keys.compliance ? 1 / value : stiffness_in_si(value, form, keys);
  refuse_too_stiff(compliance.stiffness, owner, unit_of(keys), *table.get(form), reading.source);
  read_second_slope(table, keys, owner, reading, compliance);
  if (const toml::node* name = table.get("name"))
    compliance.name = as_identifier(*name, "name", reading.source);
  // In the nominal configuration its coordinate is 0, so that "home" is the default.
  if (const toml::node* preload = table.get("preload")) check_preload_home(*preload, "", reading.source);
  return compliance;
}

}  // namespace counterflex::toml_file
