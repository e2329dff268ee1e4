#include "machine/read/read_spring.hpp"

#include <fmt/format.h>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "machine/definiteness.hpp"
#include "machine/read/beam.hpp"

namespace counterflex::toml_file {
namespace {

// Found by experiment: parallel machines with bars, guides and struts of 1e14 N/m are solved correctly; from
// 1e18 on Newton's method does not converge. Three stiff parallel chains become singular above 1e12 N/m.
constexpr double most_stiffness = 1e14, sensible_stiffness = 1e12;

[[noreturn]] void fail_at_entry(const toml::node& matrix, std::string_view name, const BadEntry& bad,
                                const Source& source) {
  const auto row = static_cast<std::size_t>(bad.row), column = static_cast<std::size_t>(bad.column);
  const toml::node& entry = *matrix.as_array()->get(row)->as_array()->get(column);
  source.fail(entry, fmt::format("{} {}", Label{name, row + 1, column + 1}.text(), bad.why));
}

/// A symmetric matrix, positive definite or semidefinite.
Matrix6 read_symmetric(const toml::node& node, std::string_view name, bool semidefinite,
                       const Reading& reading) {
  const Matrix6 A = as_matrix6(node, name, reading);
  if (const auto bad = find_asymmetry(A)) fail_at_entry(node, name, *bad, reading.source);
  const Matrix6 symmetric = 0.5 * (A + A.transpose());
  if (const auto bad = find_indefiniteness(symmetric, semidefinite))
    fail_at_entry(node, name, *bad, reading.source);
  return symmetric;
}

Vector6 read_diagonal(const toml::node& node, std::string_view name, bool zero_allowed,
                      const Reading& reading) {
  const Vector6 diagonal = as_vector6(node, name, reading);
  for (std::size_t i = 0; i < 6; ++i) {
    const toml::node& entry = *node.as_array()->get(i);
    if (zero_allowed)
      as_not_negative(entry, {name, i + 1}, reading);
    else
      as_positive(entry, {name, i + 1}, reading);
  }
  return diagonal;
}

/// The shortest rotation of x to the named axis: about z for "y", about y for "z". EIz remains bending about
/// z in the first case, EIy bending about y in the second.
Matrix3 read_beam_axis(const toml::table& beam, const Source& source) {
  const toml::node* node = beam.get("axis");
  if (node == nullptr) return Matrix3::Identity();
  const std::string axis = as_text(*node, "axis", source);
  if (axis == "x") return Matrix3::Identity();
  if (axis == "y") return Matrix3{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  if (axis == "z") return Matrix3{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  source.fail(*node, fmt::format("axis of a beam is \"{}\"; it must be \"x\", \"y\" or \"z\"", axis));
}

Matrix6 read_beam(const toml::node& node, const Reading& reading) {
  const toml::table& table = as_table(node, "beam", reading.source);
  check_keys(table, {"length_mm", "EA_N", "GJ_Nm2", "EIy_Nm2", "EIz_Nm2", "axis"}, "a beam", reading.source);
  const auto positive = [&](std::string_view key) {
    return as_positive(required(table, key, "a beam", node, reading.source), {key}, reading);
  };
  const Beam beam = {positive("length_mm") * mm, positive("EA_N"), positive("GJ_Nm2"), positive("EIy_Nm2"),
                     positive("EIz_Nm2")};
  return turned(tip_compliance(beam), read_beam_axis(table, reading.source));
}

Matrix6 stiffness_of(const toml::node& node, std::string_view form, const Reading& reading) {
  if (form == "compliance_si") return symmetric_inverse(read_symmetric(node, form, false, reading));
  if (form == "stiffness_si") return read_symmetric(node, form, true, reading);
  if (form == "compliance_diag_si")
    return read_diagonal(node, form, false, reading).cwiseInverse().asDiagonal();
  if (form == "stiffness_diag_si") return read_diagonal(node, form, true, reading).asDiagonal();
  return symmetric_inverse(read_beam(node, reading));
}

Matrix6 read_stiffness(const toml::node& node, std::string_view form, std::string_view owner,
                       const Reading& reading) {
  const Matrix6 K = stiffness_of(node, form, reading);
  refuse_too_stiff(K.diagonal().head<3>().maxCoeff(), owner, "N/m", node, reading.source);
  refuse_too_stiff(K.diagonal().tail<3>().maxCoeff(), owner, "N m/rad", node, reading.source);
  return K;
}

Vector6 read_preload(const toml::table& table, std::string_view owner, const Reading& reading) {
  const std::string_view form = one_of(table, {"preload_si", "preload"}, owner, reading.source);
  if (form == "preload_si") return as_vector6(*table.get(form), form, reading);
  // In the nominal configuration a spring is at identity, so that relaxed at home means theta_0 = 0.
  if (form == "preload") check_preload_home(*table.get(form), ", or give preload_si", reading.source);
  return Vector6::Zero();
}

}  // namespace

void refuse_too_stiff(double stiffness, std::string_view owner, std::string_view unit, const toml::node& node,
                      const Source& source) {
  if (stiffness <= most_stiffness) return;
  source.fail(
      node,
      fmt::format("{}: {:.3g} {} is too stiff to solve in double precision; at most {:g} is allowed. Leave "
                  "it out where the part is rigid, or use at most {:g}",
                  owner, stiffness, unit, most_stiffness, sensible_stiffness));
}

Matrix6 read_definite_stiffness(const toml::node& node, std::string_view form, const Source& source) {
  const Matrix6 given = read_symmetric(node, form, false, {source});
  return form == "compliance_si" ? symmetric_inverse(given) : given;
}

Spring read_spring(const toml::node& node, const std::string& name, const Source& source) {
  static const std::vector<std::string_view> forms = {"compliance_si", "stiffness_si", "compliance_diag_si",
                                                      "stiffness_diag_si", "beam"};
  const std::string owner = fmt::format("spring \"{}\"", name);
  const toml::table& table = as_table(node, owner, source);
  std::vector<std::string_view> allowed = forms;
  allowed.insert(allowed.end(), {"preload_si", "preload"});
  check_keys(table, allowed, owner, source);
  const std::string_view form = one_of(table, forms, owner, source);
  if (form.empty())
    source.fail(node, fmt::format("{} has no stiffness; give one of {}", owner, fmt::join(forms, ", ")));
  const Reading reading{source};
  return {name, read_stiffness(*table.get(form), form, owner, reading), read_preload(table, owner, reading)};
}

}  // namespace counterflex::toml_file
