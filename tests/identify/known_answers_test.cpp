/// Machines whose answer is known: a delta whose plate is touched, and the Orthoglide of the paper.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

/// The machine with prior deviations of these parameters; all others are held.
Machine with_free(Machine machine, const std::vector<std::string>& names, double sigma) {
  machine.parameters.clear();
  for (const Parameter& parameter : parameters(machine)) {
    const bool is_free = std::find(names.begin(), names.end(), parameter.name) != names.end();
    machine.parameters.push_back({parameter.name, NumberSource::prior, is_free ? sigma : 0, ""});
  }
  return machine;
}

/// A delta with arms of 333 mm. Its file has a radius of 174 mm, the machine 174.75 mm.
constexpr double arm = 333 * mm, file_radius = 174 * mm, true_radius = 174.75 * mm;

Machine delta_file() {
  MachineFacts facts;
  facts.kind = MachineKind::delta;
  facts.arm_mm = arm / mm;
  facts.radius_mm = file_radius / mm;
  return read_machine(machine_file(facts), "delta.toml");
}

/// Heights of the carriages with the tip at a place of the plate, `radius` the rails': Pythagoras.
Vector3 carriages(double x, double y, double radius) {
  Vector3 q;
  for (int i = 0; i < 3; ++i) {
    const double angle = (90 + 120 * i) * deg;
    const double across = std::hypot(radius * std::cos(angle) - x, radius * std::sin(angle) - y);
    q[i] = std::sqrt(arm * arm - across * across) - std::sqrt(arm * arm - radius * radius);
  }
  return q;
}

/// A plate that is touched in its centre and at six places around.
Measurements touched_plate(double sigma, Random& random) {
  Measurements all;
  all.sessions.push_back({"plate", MeasurementKind::plane_contact, true, Pose{}});
  for (int i = 0; i < 7; ++i) {
    const double r = i == 0 ? 0 : 90 * mm, angle = 60 * i * deg;
    Measurement row;
    row.at = {"plate.csv", i + 2, 1};
    row.sigma = std::max(sigma, 1e-8);
    // A touch is late or early: all carriages are, as they move together.
    const double late = sigma * normal(random);
    row.states.push_back({carriages(r * std::cos(angle), r * std::sin(angle), true_radius).array() + late});
    all.rows.push_back(row);
  }
  return all;
}

const std::vector<std::string> radii = {"rail1.rail.x_mm", "rail2.rail.x_mm", "rail3.rail.x_mm"};

IdentifyOptions of_all_sets() {
  IdentifyOptions options;
  options.ladder = false;
  return options;
}

}  // namespace

TEST_CASE("a delta is found from seven touches of its plate") {
  const Machine file = with_free(delta_file(), radii, 1 * mm);
  Random random(1);
  for (const bool has_known_frame : {false, true}) {
    CAPTURE(has_known_frame);
    Measurements touched = touched_plate(0, random);
    touched.sessions[0].has_known_frame = has_known_frame;
    if (has_known_frame) {
      // The plate is z = 0. With the carriages of the file at zero the tip is 60 mm below.
      const double height =
          std::sqrt(arm * arm - true_radius * true_radius) - std::sqrt(arm * arm - file_radius * file_radius);
      for (Measurement& row : touched.rows) row.states[0].shown.array() += height + 60 * mm;
    }
    const Identification found = identify(file, touched, of_all_sets());
    REQUIRE(found.parameters.size() == 3);
    for (const IdentifiedParameter& parameter : found.parameters) {
      CAPTURE(parameter.name);
      CHECK(std::abs(parameter.value - (true_radius - file_radius)) < 1e-4 * mm);
      CHECK(parameter.is_identified);
    }
    CHECK(found.outlier_count == 0);
  }
}

namespace {

Machine new_mill() {
  return read_machine(machine_file(MachineFacts{}), "mill.toml");
}

/// The value that is found for a parameter.
double found_value(const Identification& found, const std::string& name) {
  for (const IdentifiedParameter& parameter : found.parameters)
    if (parameter.name == name) return parameter.value;
  return std::nan("");
}

/// Three pushes at each of four places on a mill with these compliances (m/N).
std::string pushes_on_mill(const Vector3& compliance) {
  std::string text = "kind,X_mm,Y_mm,Z_mm,fx_N,fy_N,fz_N,gx,gy,gz,reading_um,sigma_um\n";
  for (const char* place : {"100,100,-100", "500,100,-300", "100,300,-300", "500,300,-100"})
    for (int k = 0; k < 3; ++k) {
      const Vector3 g = Vector3::Unit(k), F = 400 * g;
      text += fmt::format("static_push,{},{},{},{},{},{},{},{:.3f},2\n", place, F.x(), F.y(), F.z(), g.x(),
                          g.y(), g.z(), 400 * compliance[k] / um);
    }
  return text;
}

}  // namespace

TEST_CASE("a squareness far from what is known before is the mean of both, by their deviations") {
  const Machine mill = new_mill();
  for (const double measured : {10.0, 80.0, 150.0, 1000.0}) {
    CAPTURE(measured);
    Measurements all;
    read_measurements(fmt::format("kind,axes,squareness_um_per_m,sigma_squareness_um_per_m\n"
                                  "squareness,XY,{},3\n",
                                  measured),
                      "s.csv", mill, all);
    const Identification found = identify(mill, all, of_all_sets());
    const double expected = measured * 50 * 50 / (50 * 50 + 3 * 3);
    CHECK(found_value(found, "XY.rz_deg") == doctest::Approx(expected * 1e-6).epsilon(1e-3));
    CHECK(found.outlier_count == 0);
  }
}

TEST_CASE("pushes that agree with each other are believed, however soft the machine is") {
  const Machine mill = new_mill();
  for (const double softer : {1.0, 4.0, 10.0, 100.0}) {
    CAPTURE(softer);
    const Vector3 compliance = softer * Vector3(1, 1.2, 0.7) / 30e6;
    Measurements all;
    read_measurements(pushes_on_mill(compliance), "p.csv", mill, all);
    const Identification found = identify(mill, all, of_all_sets());
    for (int k = 0; k < 3; ++k)
      CHECK(found_value(found, fmt::format("{}.compliance_m_per_N", "XYZ"[k])) ==
            doctest::Approx(compliance[k]).epsilon(0.02));
    CHECK(found.outlier_count == 0);
  }
}

namespace {

void check_delta_with_noise(unsigned campaigns, double least, double most) {
  const Machine file = with_free(delta_file(), radii, 1 * mm);
  int inside = 0, count = 0;
  for (unsigned seed = 0; seed < campaigns; ++seed) {
    Random random(seed);
    for (const IdentifiedParameter& parameter :
         identify(file, touched_plate(10 * um, random), of_all_sets()).parameters) {
      inside += std::abs(parameter.value - (true_radius - file_radius)) < 1.96 * parameter.sigma;
      ++count;
    }
  }
  CAPTURE(inside);
  CHECK(inside > least * count);
  CHECK(inside < most * count);
}

}  // namespace

TEST_CASE("with noise of 10 um the radii of a delta lie in their 95 % intervals") {
  check_delta_with_noise(10, 0.85, 1.01);
}

TEST_SUITE("long") {
  TEST_CASE("with noise of 10 um the radii of a delta lie in their 95 % intervals, 200 campaigns") {
    check_delta_with_noise(200, 0.93, 0.97);
  }
}

namespace {

/// Table 2 of the paper (case B): displacement (mm) and rotation (deg) of the platform for 1 deg about the
/// axis of each actuator.
struct Row {
  std::array<double, 3> place, displacement, rotation;
};
constexpr std::array<Row, 5> table = {{
    {{0, 0, 0}, {0, 0, 0}, {0.03, 0.03, 0.03}},
    {{126.35, 126.35, 126.35}, {0.41, 0.41, 0.41}, {-0.62, -0.62, -0.62}},
    {{-73.65, -73.65, -73.65}, {-0.96, -0.96, -0.96}, {0.21, 0.21, 0.21}},
    {{126.35, 126.35, -73.65}, {-0.91, 1.31, 0.58}, {-0.19, -0.49, 0.44}},
    {{-73.65, -73.65, 126.35}, {0.93, -0.10, -0.25}, {0.33, 0.22, -0.31}},
}};

Vector3 as_vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// The print is of the linear theory. One hundredth of the error has one hundredth of the displacement.
constexpr double small = 0.01;

/// The Orthoglide with `small` of the errors of case B, and springs whose compliances are off.
Machine orthoglide_off() {
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/orthoglide-assembly/case_b.toml");
  std::vector<double> values = values_of(machine);
  const std::vector<Parameter> all = parameters(machine);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_foot = all[i].name.find("foot") != std::string::npos;
    values[i] = all[i].kind == ParameterKind::compliance ? values[i] * (is_foot ? 1.4 : 0.7)
                : all[i].name.ends_with("mount.rx_deg")  ? small * 1 * deg
                                                         : 0;
  }
  machine = with_parameters(machine, values);
  machine.parameters.clear();
  for (const Parameter& parameter : parameters(machine))
    if (parameter.kind != ParameterKind::compliance)
      machine.parameters.push_back({parameter.name, NumberSource::measured, 0, ""});
  return machine;
}

}  // namespace

namespace {

CommandedState state_at(const Vector3& Q_mm) {
  constexpr double bar_mm = 310.25;
  Vector3 rails;
  for (int i = 0; i < 3; ++i)
    rails[i] = Q_mm[i] + bar_mm - std::sqrt(bar_mm * bar_mm - Q_mm.squaredNorm() + Q_mm[i] * Q_mm[i]);
  return {rails * mm};
}

/// The table as rows in the machine frame; their deviation is that of rounding.
Measurements printed_rows() {
  Measurements all;
  all.sessions.push_back({"table 2", MeasurementKind::tracker_pose, true, Pose{}});
  all.sessions[0].has_known_frame = true;
  all.sessions[0].probe_sigma = 0;
  for (const Row& printed : table) {
    Measurement row;
    row.at = {"table2.csv", static_cast<int>(all.rows.size()) + 2, 1};
    const Vector3 Q = as_vector(printed.place);
    row.states.push_back(state_at(Q));
    row.X = {exp_so3(small * as_vector(printed.rotation) * deg),
             (Q + small * as_vector(printed.displacement)) * mm};
    row.sigma = small * 0.01 / std::sqrt(12) * mm;
    row.sigma_angle = small * 0.01 / std::sqrt(12) * deg;
    all.rows.push_back(row);
  }
  return all;
}

/// Displacements (mm) and rotations (deg) of the table as the machine has them, five rows of six numbers.
Eigen::MatrixXd table_of(const Machine& machine) {
  Tips tips(machine);
  Eigen::MatrixXd result(static_cast<Eigen::Index>(table.size()), 6);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Vector3 Q = as_vector(table[i].place);
    const Pose X = tips(state_at(Q));
    result.row(static_cast<Eigen::Index>(i)) << (X.p / mm - Q).transpose() / small,
        log_so3(X.R).transpose() / deg / small;
  }
  return result;
}

/// The machine with parameters moved by `share` of a combination.
Machine along(const Machine& machine, const FreeCombination& free, double share) {
  std::vector<double> values = values_of(machine);
  const std::vector<Parameter> all = parameters(machine);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const FreeCombination::Term& term : free.terms)
      if (term.name == all[i].name) values[i] += share * term.change;
  return with_parameters(machine, values);
}

}  // namespace

TEST_CASE("compliances from Table 2 alone reproduce it to print, and their free combinations are named") {
  const Machine machine = orthoglide_off();
  IdentifyOptions options = of_all_sets();
  options.sets = {ParameterSet::compliance};
  const Identification found = identify(machine, printed_rows(), options);
  CHECK(found.is_converged);
  const Eigen::MatrixXd before = table_of(machine), fitted = table_of(found.machine);
  double off = 0;
  for (std::size_t i = 0; i < table.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      CAPTURE(i);
      CAPTURE(k);
      const auto row = static_cast<Eigen::Index>(i);
      CHECK(std::abs(fitted(row, k) - table[i].displacement[k]) < 0.0055);
      CHECK(std::abs(fitted(row, 3 + k) - table[i].rotation[k]) < 0.0115);
      off = std::max(off, std::abs(before(row, 3 + k) - table[i].rotation[k]));
    }
  CHECK(off > 0.05);
  // No load acts: a common factor of all compliances changes no displacement.
  std::vector<double> values = values_of(found.machine);
  const std::vector<Parameter> all = parameters(found.machine);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (all[i].kind == ParameterKind::compliance) values[i] *= 1.2;
  CHECK((table_of(with_parameters(found.machine, values)) - fitted).cwiseAbs().maxCoeff() < 1e-5);
  // That, and three differences between bars of parallelograms, which change less than the print shows.
  CHECK(found.free.size() == 4);
  for (const FreeCombination& free : found.free) {
    CAPTURE(free.terms[0].name);
    CHECK((table_of(along(found.machine, free, 0.3)) - fitted).cwiseAbs().maxCoeff() < 0.01);
  }
  // The three feet are alike, and stiff against the bars, as the table asks for.
  for (const IdentifiedParameter& parameter : found.parameters)
    if (parameter.name.find("foot") != std::string::npos) CHECK(parameter.is_identified);
}
