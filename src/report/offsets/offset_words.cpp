#include "counterflex/report/offset_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/turn.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex {
namespace {

constexpr std::array<const char*, 3> axes{"X", "Y", "Z"};
constexpr int angle_decimals = 5;       // degrees: 1e-5 deg at 1 m is 0.2 µm
constexpr int quaternion_decimals = 8;  // as much
constexpr int ur_angle_decimals = 7;    // rad

bool is_inch(const ControlWords& control) {
  return control.unit == LengthUnit::inches && !is_robot_dialect(control.dialect);
}

double unit_of(const ControlWords& control) {
  if (control.dialect == "ur") return 1;
  return is_inch(control) ? inch : mm;
}

int decimals_of(const ControlWords& control) {
  if (control.decimals >= 0) return control.decimals + (control.dialect == "ur" ? 3 : 0);
  if (control.dialect == "ur") return 6;
  constexpr std::array<std::string_view, 3> of_thousandths{"fanuc", "haas", "grbl"};
  const bool thousandths = is_robot_dialect(control.dialect) ||
                           std::ranges::find(of_thousandths, control.dialect) != of_thousandths.end();
  return (thousandths ? 3 : 4) + (is_inch(control) ? 1 : 0);
}

// With further digits where the value now has them.
std::string number(double value, int decimals) {
  constexpr int most = 7;
  int digits = decimals;
  while (digits < most && std::abs(rounded(value, digits) - value) > 1e-9) ++digits;
  return format_fixed(value, digits);
}

std::string with_sign(double value, int decimals) {
  const std::string text = format_fixed(value, decimals);
  return value < 0 || text.find_first_of("123456789") == std::string::npos ? text : "+" + text;
}

std::optional<int> number_behind(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  int value = 0;
  const std::string_view digits = name.substr(prefix.size());
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

// "L2 P1": the address of an offset under G10. Empty: it has none.
std::string g10_address(const std::string& name) {
  if (const auto p = number_behind(name, "G54.1 P")) return fmt::format("L20 P{}", *p);
  if (const auto third = number_behind(name, "G59."); third && *third >= 1 && *third <= 3)
    return fmt::format("L2 P{}", 6 + *third);
  const auto g = number_behind(name, "G");
  return g && *g >= 54 && *g <= 59 ? fmt::format("L2 P{}", *g - 53) : "";
}

// The index of a settable frame of a Sinumerik.
std::optional<int> settable_frame(const std::string& name) {
  const auto g = number_behind(name, "G");
  if (g && *g >= 54 && *g <= 57) return *g - 53;
  return g && *g >= 500 && *g <= 599 ? std::optional(*g - 500) : std::nullopt;
}

struct ChangedAxis {
  std::size_t axis = 0;
  double value = 0;  // in the unit of the control
};

std::vector<std::string> offset_words(const ControlWords& control, const std::string& name,
                                      const std::vector<ChangedAxis>& changed) {
  const int decimals = decimals_of(control);
  std::vector<std::string> lines;
  std::string all;
  for (const ChangedAxis& a : changed) all += fmt::format(" {}{}", axes[a.axis], number(a.value, decimals));
  if (control.dialect == "heidenhain") return {"preset table, active row:" + all};
  if (control.dialect == "siemens") {
    const auto frame = settable_frame(name);
    for (const ChangedAxis& a : changed)
      if (frame)
        lines.push_back(fmt::format("$P_UIFR[{},{},TR]={}", *frame, axes[a.axis], number(a.value, decimals)));
    return lines;
  }
  const std::string address = g10_address(name);
  if (address.empty()) return lines;
  const bool absolute = control.dialect == "fanuc" || control.dialect == "haas";
  return {fmt::format("{}G10 {}{}", absolute ? "G90 " : "", address, all)};
}

WrittenOffset shifted_offset(const ControlWords& control, const std::string& name, const Pose& X_MW,
                             const Vector3& shift) {
  WrittenOffset written{X_MW};
  const double unit = unit_of(control);
  std::vector<ChangedAxis> changed;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const double by = rounded_length(control, shift[k]);
    if (by == 0) continue;
    written.X_MW.p[k] += by;
    written.change += fmt::format("{}{} ", axes[axis], with_sign(by / unit, decimals_of(control)));
    changed.push_back({axis, written.X_MW.p[k] / unit});
  }
  if (changed.empty()) return {X_MW, "nothing", {}};
  written.change += is_inch(control) ? "inch" : "mm";
  written.words = offset_words(control, name, changed);
  return written;
}

// Robots: a whole pose in the numbers of its language.
OrientationForm form_of(const ControlWords& control) {
  if (control.dialect == "abb") return OrientationForm::quaternion;
  return control.dialect == "ur" ? OrientationForm::rotation_vector : OrientationForm::fixed_axes;
}

int decimals_of(OrientationForm form) {
  if (form == OrientationForm::quaternion) return quaternion_decimals;
  return form == OrientationForm::rotation_vector ? ur_angle_decimals : angle_decimals;
}

// Behind the name of the frame.
std::vector<std::string> pose_words(const ControlWords& control, const std::string& name,
                                    const Eigen::Vector3d& p, const OrientationNumbers& r) {
  const OrientationForm form = form_of(control);
  std::array<std::string, 7> n;
  for (std::size_t i = 0; i < 3; ++i) n[i] = number(p[static_cast<Eigen::Index>(i)], decimals_of(control));
  for (std::size_t i = 0; i < number_count(form); ++i) n[3 + i] = format_fixed(r[i], decimals_of(form));
  const std::string frame = name.empty() ? "" : name + " ";
  if (control.dialect == "kuka")
    return {fmt::format("{}= {{X {}, Y {}, Z {}, A {}, B {}, C {}}}", frame.empty() ? "$BASE " : frame, n[0],
                        n[1], n[2], n[5], n[4], n[3])};
  if (control.dialect == "abb") {
    const std::string wobj = name.empty() ? "wobj" : name;
    return {fmt::format("{}.uframe := [[{}, {}, {}], [{}, {}, {}, {}]];", wobj, n[0], n[1], n[2], n[3], n[4],
                        n[5], n[6]),
            fmt::format("{}.oframe := [[0, 0, 0], [1, 0, 0, 0]];", wobj)};
  }
  if (control.dialect == "ur")
    return {fmt::format("{}= p[{}, {}, {}, {}, {}, {}]", frame.empty() ? "plane " : frame, n[0], n[1], n[2],
                        n[3], n[4], n[5])};
  if (control.dialect == "tp") {
    const auto uf = number_behind(name, "UF ");
    return {fmt::format("UFRAME[{}]: X {} mm, Y {} mm, Z {} mm, W {} deg, P {} deg, R {} deg",
                        uf ? std::to_string(*uf) : "n", n[0], n[1], n[2], n[3], n[4], n[5])};
  }
  return {fmt::format("{}X {}, Y {}, Z {} mm, Rx {}, Ry {}, Rz {} deg", frame, n[0], n[1], n[2], n[3], n[4],
                      n[5])};
}

Pose pose_of(const ControlWords& control, const Eigen::Vector3d& p, const OrientationNumbers& r) {
  return {rotation_of(form_of(control), r), p * unit_of(control)};
}

WrittenOffset turned_offset(const ControlWords& control, const std::string& name, const Pose& X_MW,
                            const Pose& shift) {
  const OrientationForm form = form_of(control);
  const Pose moved = shift * X_MW;
  const double unit = unit_of(control);
  OrientationNumbers near =
      numbers_of(form, X_MW.R,
                 form == OrientationForm::quaternion ? OrientationNumbers{1, 0, 0, 0} : OrientationNumbers{});
  OrientationNumbers r = numbers_of(form, moved.R, near);
  for (std::size_t i = 0; i < number_count(form); ++i) r[i] = rounded(r[i], decimals_of(form));
  Eigen::Vector3d p = moved.p / unit;
  for (Eigen::Index k = 0; k < 3; ++k) p[k] = rounded(p[k], decimals_of(control));
  WrittenOffset written{pose_of(control, p, r)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    written.change += fmt::format("{}{} ", axes[axis], with_sign((written.X_MW.p - X_MW.p)[k] / mm, 3));
  }
  written.change += "mm";
  const Vector3 turn_deg = rotation_between(written.X_MW.R, X_MW.R) / deg;
  written.change += fmt::format(", turned by {} {} {} deg", format_fixed(turn_deg.x(), 4),
                                format_fixed(turn_deg.y(), 4), format_fixed(turn_deg.z(), 4));
  written.words = pose_words(control, name, p, r);
  return written;
}

}  // namespace

double rounded_length(const ControlWords& control, double length) {
  const double unit = unit_of(control);
  return rounded(length / unit, decimals_of(control)) * unit;
}

WrittenOffset written_offset(const ControlWords& control, const std::string& name, const Pose& X_MW,
                             const Pose& shift, bool turns) {
  return turns ? turned_offset(control, name, X_MW, shift) : shifted_offset(control, name, X_MW, shift.p);
}

std::vector<std::string> tool_words(const ControlWords& control, const ChangedTool& tool) {
  const double unit = unit_of(control);
  const int decimals = decimals_of(control);
  const auto value = [&](double length) { return number(length / unit, decimals); };
  std::vector<std::string> lines;
  const auto add = [&](const std::optional<double>& change, std::string_view before) {
    if (change) lines.push_back(fmt::format("{}{}", before, value(*change)));
  };
  if (tool.number == 0) return lines;
  if (control.dialect == "linuxcnc") {
    std::string words;
    if (tool.length && tool.length_now) words += " Z" + value(*tool.length_now + *tool.length);
    if (tool.radius && tool.radius_now) words += " R" + value(*tool.radius_now + *tool.radius);
    if (!words.empty()) lines.push_back(fmt::format("G10 L1 P{}{}", tool.number, words));
  } else if (control.dialect == "fanuc" || control.dialect == "haas") {
    add(tool.length, fmt::format("G90 G10 L11 P{} R", tool.number));
    if (control.dialect == "fanuc") add(tool.radius, fmt::format("G90 G10 L13 P{} R", tool.number));
  } else if (control.dialect == "siemens") {
    add(tool.length, fmt::format("$TC_DP12[{},1]=", tool.number));
    add(tool.radius, fmt::format("$TC_DP15[{},1]=", tool.number));
  } else if (control.dialect == "heidenhain") {
    add(tool.length, fmt::format("tool table T{}: DL ", tool.number));
    add(tool.radius, fmt::format("tool table T{}: DR ", tool.number));
  }
  return lines;
}

}  // namespace counterflex
