#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/sanity/checks.hpp"

namespace counterflex {
namespace {

// Implausible values, each a decade beyond the range of real machines.
constexpr double softest_spring = 1e5;    // N/m: parts of machines have 1e6 to 1e10
constexpr double softest_joint = 100;     // N m/rad: gears and bearings of arms have 1e4 to 1e7
constexpr double heaviest_part_kg = 1e4;  // a table or a beam has up to some tonnes
constexpr double shortest_travel = 5 * mm;
constexpr double narrowest_turn = 7 * deg;  // 2 pi typed into a key in degrees is 6.28
constexpr double shortest_tool = 10 * mm;   // from the gauge line of the spindle to the tip
constexpr double shortest_reach = 10 * mm;  // the largest length of the whole file
constexpr double largest_error_angle = 10 * deg, largest_error = 50 * mm;      // of assembly
constexpr double largest_axis_error = 2 * mm, largest_axis_angle = 0.3 * deg;  // of tables
constexpr double largest_harmonic_angle = 0.3 * deg;
constexpr double thinnest_tool = 0.05 * mm, thickest_tool = 500 * mm;
constexpr double same_angle_deg = 2e-3;  // 3.14 is as near to pi as this
constexpr double weakest_force_N = 1, strongest_force_N = 1e5;
constexpr double finest_tolerance_mm = 1e-4, coarsest_tolerance_mm = 0.5;

SanityCheck doubt(std::string text) {
  return {"magnitudes", SanityState::doubtful, std::move(text)};
}

std::string number(double value) {
  return fmt::format("{:.6g}", rounded(value, 9));
}

/// A rotation whose angle in degrees is the number of a right angle in radians.
std::optional<double> radians_as_degrees(const Matrix3& R) {
  const Vector3 rpy_deg = to_rpy(R) / deg;
  for (const double angle : rpy_deg)
    for (const double rad : {pi / 4, pi / 2, pi, 1.5 * pi, 2 * pi})
      if (std::abs(std::abs(angle) - rad) < same_angle_deg) return angle;
  return std::nullopt;
}

struct Seen {
  SanityChecks& doubts;
  std::string where;
  double& reach;

  void pose(const Pose& X, const std::string& key) {
    reach = std::max(reach, X.p.norm());
    if (const auto angle = radians_as_degrees(X.R))
      add(fmt::format("{} turns by {} deg: is that an angle in rad in a key in degrees?", key,
                      number(*angle)));
  }
  void limits(double min, double max, JointKind kind, const std::string& key) {
    const double span = max - min;
    if (!std::isfinite(span)) return;
    if (kind == JointKind::prismatic) {
      reach = std::max(reach, span);
      if (span < shortest_travel)
        add(fmt::format("{} has a travel of {} mm (min_mm, max_mm): is it in m or inch?", key,
                        number(span / mm)));
    } else if (span < 2 * narrowest_turn && std::max(std::abs(min), std::abs(max)) < narrowest_turn) {
      add(fmt::format("{} turns from {} to {} deg (min_deg, max_deg): is it in rad?", key, number(min / deg),
                      number(max / deg)));
    }
  }

  /// Reports a part of several branches once.
  void add(std::string text) {
    const auto same = [&](const SanityCheck& known) { return known.text == text; };
    if (std::none_of(doubts.begin(), doubts.end(), same)) doubts.push_back(doubt(std::move(text)));
  }
  void operator()(const Rigid& e) { pose(e.X, fmt::format("a rigid element of {}", where)); }
  void operator()(const AssemblyError& e) {
    const std::string key = fmt::format("errors.{} of {}", e.name, where);
    pose(e.X, key);
    if (const double angle = log_so3(e.X.R).norm(); angle > largest_error_angle)
      add(fmt::format(
          "{} turns by {} deg; errors of assembly have up to some degrees: is it the geometry itself?", key,
          number(angle / deg)));
    if (const double length = e.X.p.norm(); length > largest_error)
      add(fmt::format("{} is {} mm long; errors of assembly have up to some mm: is it the geometry itself?",
                      key, number(length / mm)));
  }
  void operator()(const Actuator& e) {
    limits(e.min, e.max, e.joint.kind, fmt::format("an actuator of {}", where));
    if (const double most = largest_harmonic(e); most > largest_harmonic_angle)
      add(
          fmt::format("an actuator of {} has a harmonic of {} deg; those of joints have up to some 0.05 deg: "
                      "harmonics_mdeg is in 0.001 deg",
                      where, number(most / deg)));
    if (!e.errors) return;
    for (const Vector6& error : e.errors->errors) {
      const double length = error.head<3>().cwiseAbs().maxCoeff(),
                   angle = error.tail<3>().cwiseAbs().maxCoeff();
      if (length > largest_axis_error || angle > largest_axis_angle)
        add(fmt::format(
            "error table \"{}\" has an error of {}; errors of an axis have up to some 0.1 mm and 100 "
            "arcsec: is it in another unit?",
            e.errors->name,
            length > largest_axis_error ? number(length / mm) + " mm" : number(angle / deg) + " deg"));
    }
  }
  void operator()(const Passive&) {}
  void operator()(const Spring& e) {
    const double stiffest = e.K.diagonal().head<3>().maxCoeff();  // a slender bar bends easily
    if (stiffest > 0 && stiffest < softest_spring)
      add(fmt::format(
          "spring \"{}\" of {} has at most {} N/m; parts of machines have 1e6 to 1e10: is it in N/mm "
          "or N/um?",
          e.name, where, number(stiffest)));
  }
  void operator()(const Compliance& e) {
    const bool linear = e.joint.kind == JointKind::prismatic;
    if (e.stiffness >= (linear ? softest_spring : softest_joint)) return;
    add(linear ? fmt::format("a compliance of {} has {} N/m; parts of machines have 1e6 to 1e10: is it in "
                             "N/mm or N/um?",
                             where, number(e.stiffness))
               : fmt::format("a compliance of {} has {} N m/rad; joints of arms have 1e4 to 1e7: is it in "
                             "another unit?",
                             where, number(e.stiffness)));
  }
  void operator()(const Group& e) {
    for (const Branch& branch : e.branches) elements(branch.elements);
  }
  void operator()(const PointMass& e) {
    if (e.kg > heaviest_part_kg) add(fmt::format("a mass of {} has {} kg: is it in g?", where, number(e.kg)));
  }
  void elements(const std::vector<Element>& all) {
    for (const Element& element : all) std::visit(*this, element);
  }
};

void see_tools(const Machine& machine, SanityChecks& doubts) {
  for (const auto& [number_of_tool, tool] : machine.tools) {
    const double least = machine.X_PS ? shortest_tool : mm;
    if (tool.length && *tool.length != 0 && std::abs(*tool.length) < least)
      doubts.push_back(doubt(fmt::format("tool T{} is {} mm long (length_mm): is it in m or inch?",
                                         number_of_tool, number(*tool.length / mm))));
    if (tool.diameter && (*tool.diameter < thinnest_tool || *tool.diameter > thickest_tool))
      doubts.push_back(doubt(fmt::format("tool T{} has a diameter of {} mm (diameter_mm): is it in m?",
                                         number_of_tool, number(*tool.diameter / mm))));
  }
}

}  // namespace

SanityChecks check_magnitudes(const Machine& machine) {
  SanityChecks doubts;
  double reach = 0;
  for (const Chain& chain : machine.chains)
    Seen{doubts, fmt::format("chain {}", chain.name), reach}.elements(chain.elements);
  Seen rest{doubts, "", reach};
  rest.pose(machine.X_PT, "[tool]");
  if (machine.X_PS) rest.pose(*machine.X_PS, "[spindle]");
  for (const auto& [name, offset] : machine.work) rest.pose(offset.X_MW, fmt::format("[work.{}]", name));
  see_tools(machine, doubts);
  if (reach > 0 && reach < shortest_reach)
    doubts.push_back(doubt(
        fmt::format("the largest length of the machine is {} mm: are lengths in m?", number(reach / mm))));
  if (doubts.empty())
    doubts.push_back(
        {"magnitudes", SanityState::ok, "springs, masses, angles and lengths are of usual size"});
  return doubts;
}

SanityChecks check_force_size(double largest_N) {
  SanityChecks doubts;
  if (largest_N > 0 && largest_N < weakest_force_N)
    doubts.push_back(doubt(fmt::format("the largest force is {} N; milling has 10 to 10000 N: is it in kN?",
                                       number(largest_N))));
  if (largest_N > strongest_force_N)
    doubts.push_back(
        doubt(fmt::format("the largest force is {} N; milling has 10 to 10000 N: is it in mN, or is the load "
                          "scale wrong?",
                          number(largest_N))));
  return doubts;
}

SanityChecks check_tolerance(double tolerance_mm) {
  if (tolerance_mm >= finest_tolerance_mm && tolerance_mm <= coarsest_tolerance_mm) return {};
  return {{"magnitudes", SanityState::doubtful,
           fmt::format("the tolerance is {} mm (--tolerance-mm, tolerance_mm); 0.002 to 0.1 mm is usual",
                       number(tolerance_mm))}};
}

}  // namespace counterflex
