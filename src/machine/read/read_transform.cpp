#include "machine/read/read_transform.hpp"

#include <fmt/format.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"

namespace counterflex::toml_file {
namespace {

Matrix3 read_quaternion(const toml::node& node, const Reading& reading) {
  const Eigen::Vector4d wxyz = as_vector4(node, "quat_wxyz", reading);
  if (!(std::abs(wxyz.norm() - 1) <= 1e-6))
    reading.source.fail(node, fmt::format("quat_wxyz has the norm {:.9g}{}; it must be 1 within 1e-6",
                                          wxyz.norm(), filled_by(node, reading)));
  return from_quaternion(wxyz);
}

Matrix3 read_rotation(const toml::table& table, std::string_view name, const Reading& reading) {
  const std::string_view form = one_of(table, {"rpy_deg", "rotvec_deg", "quat_wxyz"}, name, reading.source);
  if (form.empty()) return Matrix3::Identity();
  const toml::node& node = *table.get(form);
  if (form == "rpy_deg") return from_rpy(as_vector3(node, form, reading) * deg);
  if (form == "rotvec_deg") return exp_so3(as_vector3(node, form, reading) * deg);
  return read_quaternion(node, reading);
}

}  // namespace

Pose read_transform(const toml::node& node, std::string_view name, const Reading& reading,
                    const std::vector<std::string_view>& more_keys) {
  const toml::table& table = as_table(node, name, reading.source);
  std::vector<std::string_view> allowed = {"xyz_mm", "xyz_after_mm", "rpy_deg", "rotvec_deg", "quat_wxyz"};
  allowed.insert(allowed.end(), more_keys.begin(), more_keys.end());
  check_keys(table, allowed, name, reading.source);
  const Matrix3 R = read_rotation(table, name, reading);
  const std::string_view form = one_of(table, {"xyz_mm", "xyz_after_mm"}, name, reading.source);
  if (form.empty()) return rotation(R);
  const Vector3 p = as_vector3(*table.get(form), form, reading) * mm;
  return form == "xyz_mm" ? Pose{R, p} : rotation(R) * translation(p);
}

}  // namespace counterflex::toml_file
