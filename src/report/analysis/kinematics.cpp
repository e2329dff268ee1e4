#include "counterflex/report/kinematics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/turn.hpp"
#include "counterflex/geometry/types.hpp"
#include "report/analysis/analysis_parts.hpp"
#include "report/names.hpp"

namespace counterflex {
namespace {

double margin_of(const Travel& travel, double shown) {
  return std::min(shown - travel.min, travel.max - shown);
}

/// `near`: values of the actuators.
KinematicPlace place_of_result(const Model& model, const NominalResult& nominal,
                               const Eigen::VectorXd& near) {
  if (nominal.status == Status::converged) return place_of(model, nominal.configuration, near);
  KinematicPlace place;
  place.status = nominal.status;
  place.why = nominal.status == Status::singular
                  ? "the perfect machine is singular here or on the way from home"
                  : "the perfect machine cannot reach the pose from home";
  return place;
}

/// An orientation in the numbers of a control.
struct ControlForm {
  const char* control;
  const char* key;    ///< in JSON
  const char* names;  ///< of the numbers
  const char* unit;
  OrientationForm form;
  bool z_first;  ///< the angles are about Z, Y, X
  int decimals;
};

constexpr ControlForm control_forms[] = {
    {"KUKA", "kuka_abc_deg", "A B C", " deg", OrientationForm::fixed_axes, true, 4},
    {"FANUC, Yaskawa", "fanuc_wpr_deg", "W P R", " deg", OrientationForm::fixed_axes, false, 4},
    {"ABB", "abb_quaternion", "q1 to q4", "", OrientationForm::quaternion, false, 7},
    {"UR", "ur_rotation_vector_rad", "rx ry rz", " rad", OrientationForm::rotation_vector, false, 6},
};

/// Of the two triples of angles about X, Y and Z that give one rotation: the one that controls show. Its
/// angle about Y is within 90 degrees.
OrientationNumbers shown_angles(const OrientationNumbers& angles) {
  constexpr double rounding = 1e-9;
  if (std::abs(angles[1]) <= 90 + rounding) return angles;
  const auto whole_turns_off = [](double angle) { return std::remainder(angle, 360.0); };
  return {whole_turns_off(angles[0] + 180), whole_turns_off(180 - angles[1]),
          whole_turns_off(angles[2] + 180), 0};
}

std::vector<double> numbers_in(const ControlForm& control, const Matrix3& R) {
  const OrientationNumbers near = {control.form == OrientationForm::quaternion ? 1.0 : 0.0, 0, 0, 0};
  OrientationNumbers numbers = numbers_of(control.form, R, near);
  if (control.form == OrientationForm::fixed_axes) numbers = shown_angles(numbers);
  std::vector<double> list(numbers.begin(),
                           numbers.begin() + static_cast<std::ptrdiff_t>(number_count(control.form)));
  if (control.z_first) std::reverse(list.begin(), list.end());
  return list;
}

/// Of the control's tool frame.
Matrix3 written_orientation(const KinematicPlace& place, const KinematicsReport& report) {
  return place.X_MT.R * tool_axes(report.spindle_axis).transpose();
}

std::string row(std::string_view label, const std::string& text) {
  return fmt::format("  {:<16} {}\n", label, text);
}

std::string list_text(const std::vector<double>& values, int decimals) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + format_fixed(value, decimals);
  return text;
}

std::string actuator_text(const Travel& travel, double shown) {
  const JointUnit unit = unit_of(travel.kind);
  const std::string value = fmt::format("{:>11} {}", format_fixed(shown / unit.si, 4), unit.name);
  const double margin = margin_of(travel, shown);
  if (!std::isfinite(margin)) return value;
  return fmt::format("{:<15} margin {:>9} {}, travel {}", value, format_fixed(margin / unit.si, 1), unit.name,
                     travel_range(travel));
}

std::string place_text(const KinematicPlace& place, const KinematicsReport& report) {
  const std::vector<Travel>& travel = report.travel;
  std::string text;
  if (place.status != Status::converged)
    text += row("status", fmt::format("{}: {}", to_string(place.status), place.why));
  if (!place.is_known()) return text;
  const Vector3 p = place.X_MT.p / mm;
  text += row("tip x y z", list_text({p.x(), p.y(), p.z()}, 4) + " mm");
  for (const ControlForm& control : control_forms)
    text +=
        row(control.control,
            fmt::format("{}: {}{}", control.names,
                        list_text(numbers_in(control, written_orientation(place, report)), control.decimals),
                        control.unit));
  for (std::size_t i = 0; i < travel.size(); ++i)
    text += row(travel[i].name, actuator_text(travel[i], place.shown[static_cast<Eigen::Index>(i)]));
  if (place.margins)
    for (const ArmMargin& margin : *place.margins)
      text +=
          row("singular", fmt::format("{:>11} deg to {}", format_fixed(margin.angle / deg, 2), margin.what));
  return text;
}

Json actuators_json(const KinematicPlace& place, const std::vector<Travel>& travel) {
  Json list = Json::array();
  for (std::size_t i = 0; i < travel.size(); ++i) {
    const double shown = place.shown[static_cast<Eigen::Index>(i)], margin = margin_of(travel[i], shown);
    const JointUnit unit = unit_of(travel[i].kind);
    list.push_back(
        {{"name", travel[i].name},
         {"unit", unit.name},
         {"value", number(shown / unit.si, analysis_digits)},
         {"margin", std::isfinite(margin) ? number(margin / unit.si, analysis_digits) : Json(nullptr)}});
  }
  return list;
}

Json place_json(const KinematicPlace& place, const KinematicsReport& report) {
  Json json = {{"status", std::string(to_string(place.status))},
               {"why", place.why.empty() ? Json(nullptr) : Json(place.why)}};
  if (!place.is_known()) return json;
  json["tip_mm"] = numbers(Vector3(place.X_MT.p / mm), analysis_digits);
  for (const ControlForm& control : control_forms) {
    const std::vector<double> values = numbers_in(control, written_orientation(place, report));
    json[control.key] = Json::array();
    for (const double value : values) json[control.key].push_back(number(value, analysis_digits));
  }
  json["actuators"] = actuators_json(place, report.travel);
  json["singular"] = Json::array();
  if (place.margins)
    for (const ArmMargin& margin : *place.margins)
      json["singular"].push_back(
          {{"what", margin.what}, {"margin_deg", number(margin.angle / deg, analysis_digits)}});
  return json;
}

}  // namespace

KinematicPlace place_of(const Model& model, const Configuration& nominal, const Eigen::VectorXd& near) {
  const Mechanism& mechanism = model.mechanism;
  Eigen::VectorXd rho = actuator_values(mechanism, nominal);
  rho += full_turns(mechanism, rho, near);
  KinematicPlace place;
  place.status = Status::converged;
  place.X_MT = tip(mechanism, nominal);
  place.shown = shown_values(mechanism.shown, rho);
  place.margins = arm_margins(model, nominal);
  if (within_travel(mechanism, rho)) return place;
  place.status = Status::outside_travel;
  if (const auto axis = tightest_axis(mechanism, rho))
    place.why = outside_travel_words(mechanism.travel[axis->actuator], axis->value);
  return place;
}

KinematicPlace place_at_values(const Model& model, const Eigen::VectorXd& shown) {
  const Eigen::VectorXd rho = joint_values(model.mechanism.shown, shown);
  return place_of_result(model, nominal_forward(model, model.home, rho), rho);
}

KinematicPlace place_at_tip(const Model& model, const Pose& X_MT) {
  return place_of_result(model, follow(model, model.home, X_MT),
                         actuator_values(model.mechanism, model.home));
}

std::string to_text(const KinematicsReport& report) {
  std::string text = report.machine.empty() ? "Machine without a name" : report.machine;
  text += report.tool.empty() ? "\n" : "\nwith " + report.tool + "\n";
  for (std::size_t i = 0; i < report.places.size(); ++i)
    text += fmt::format("\nPose {}\n", i + 1) + place_text(report.places[i], report);
  return text;
}

std::string to_json(const KinematicsReport& report) {
  Json places = Json::array();
  for (const KinematicPlace& place : report.places) places.push_back(place_json(place, report));
  Json document = {{"schema", "counterflex-kinematics 1"},
                   {"tool", fmt::format("counterflex {}", report.version)},
                   {"machine", report.machine},
                   {"places", std::move(places)}};
  if (!report.tool.empty()) document["machine_tool"] = report.tool;
  return dump(document);
}

}  // namespace counterflex
