/// Rows of each kind, made by a machine whose parameters are known, and the machine file that is written.
#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

std::string mill_text() {
  MachineFacts facts;
  return machine_file(facts);
}

/// A mill out of square and softer than its file.
Machine true_mill(const Machine& nominal) {
  std::vector<double> values = values_of(nominal);
  const std::vector<Parameter> all = parameters(nominal);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == "XY.rz_deg") values[i] = 40e-6;
    if (all[i].name == "YZ.rx_deg") values[i] = -25e-6;
    if (all[i].kind == ParameterKind::compliance) values[i] *= 1.3;
  }
  return with_parameters(nominal, values);
}

/// Rows of one kind without noise.
Measurements rows_of(MeasurementKind kind, const Machine& truth, Random& random) {
  Measurements all;
  all.sessions.push_back({"one", kind, true, Pose{}});
  Tips tips(truth);
  const Model nominal = prepare(truth);
  for (int i = 0; i < 12; ++i) {
    Measurement row;
    row.at = {"rows.csv", i + 2, 1};
    row.sigma = 1e-7;
    row.states.push_back(random_state(truth, 0.1, 0, random));
    if (kind == MeasurementKind::hung_weight) {
      row.states.push_back(row.states[0]);
      row.states[0].F.head<3>() = Vector3(0, 0, -300);
      row.direction = -Vector3::UnitZ();
      row.value = row.direction.dot(tips(row.states[0]).p - tips(row.states[1]).p);
    } else if (kind == MeasurementKind::plane_contact) {
      // z is moved until the tip touches a plane that leans.
      const Vector3 normal = Vector3(0.02, -0.01, 1).normalized();
      for (int step = 0; step < 4; ++step)
        row.states[0].shown[2] -= normal.dot(tips(row.states[0]).p - Vector3(0, 0, -0.1)) / normal.z();
    } else if (kind == MeasurementKind::length_bar) {
      row.states.push_back(random_state(truth, 0.1, 0, random));
      row.value = (tips(row.states[0]).p - tips(row.states[1]).p).norm();
    } else if (kind == MeasurementKind::axis_position) {
      const NominalResult at =
          nominal_forward(nominal, nominal.home, joint_values(nominal.mechanism.shown, row.states[0].shown));
      row.direction = Vector3::UnitX();
      row.value =
          row.direction.dot(tips(row.states[0]).p - tip(nominal.mechanism, at.configuration).p) + 3e-5;
    }
    all.rows.push_back(row);
  }
  return all;
}

double value_named(const Machine& machine, const std::string& name) {
  for (const Parameter& parameter : parameters(machine))
    if (parameter.name == name) return parameter.value;
  FAIL("no parameter " << name);
  return 0;
}

}  // namespace

TEST_CASE("rows of each kind without noise are fitted without misfit") {
  const Machine nominal = read_machine(mill_text(), "mill.toml"), truth = true_mill(nominal);
  IdentifyOptions options;
  options.ladder = false;
  for (const MeasurementKind kind : {MeasurementKind::hung_weight, MeasurementKind::plane_contact,
                                     MeasurementKind::length_bar, MeasurementKind::axis_position}) {
    CAPTURE(static_cast<int>(kind));
    Random random(9);
    const Identification found = identify(nominal, rows_of(kind, truth, random), options);
    CHECK(found.outlier_count == 0);
    CHECK(found.lack_of_fit.value_or(0) < 2e-8);
  }
}

TEST_CASE("a squareness that is measured becomes that of the machine") {
  const Machine nominal = read_machine(mill_text(), "mill.toml");
  IdentifyOptions options;
  options.ladder = false;
  Measurements all;
  read_measurements("kind,axes,squareness_um_per_m,sigma_squareness_um_per_m\nsquareness,XY,40,0.01\n",
                    "s.csv", nominal, all);
  const Identification found = identify(nominal, all, options);
  Tips tips(found.machine);
  std::vector<Vector3> p;
  for (const CommandedState& state : all.rows[0].states) p.push_back(tips(state).p);
  const Vector3 u = (p[1] - p[0]).normalized(), v = (p[3] - p[2]).normalized();
  CHECK(std::abs(std::asin(-u.dot(v)) - 40e-6) < 1e-8);
}

TEST_CASE(
    "a plane that the tip touches does not give the height of the machine, and its lean gives no error") {
  const Machine nominal = read_machine(mill_text(), "mill.toml");
  Random random(9);
  IdentifyOptions options;
  options.ladder = false;
  const Identification found =
      identify(nominal, rows_of(MeasurementKind::plane_contact, nominal, random), options);
  for (const IdentifiedParameter& parameter : found.parameters) {
    CAPTURE(parameter.name);
    CHECK(std::abs(parameter.value - parameter.before) < 1e-3 * parameter.prior);
  }
}

TEST_CASE("two squarenesses that act alike are free together") {
  const Machine nominal = read_machine(mill_text(), "mill.toml");
  IdentifyOptions options;
  options.ladder = false;
  Measurements all;
  read_measurements("kind,axes,squareness_um_per_m,sigma_squareness_um_per_m\nsquareness,YZ,-15,2\n", "s.csv",
                    nominal, all);
  const Identification found = identify(nominal, all, options);
  // The angle between Y and Z is turned by the error of either axis; the one with the wide prior follows.
  REQUIRE(found.free.size() == 1);
  REQUIRE(found.free[0].terms.size() == 2);
  CHECK(found.free[0].terms[0].name == "YZ.rx_deg");
  CHECK(found.free[0].terms[1].name == "ZX.rx_deg");
  CHECK(found.free[0].terms[1].change / found.free[0].terms[0].change == doctest::Approx(-1).epsilon(0.02));
}

TEST_CASE("the written machine file has the identified values, and all its other lines") {
  const std::string text = mill_text();
  const Machine nominal = read_machine(text, "mill.toml"), truth = true_mill(nominal);
  Random random(9);
  IdentifyOptions options;
  options.ladder = false;
  options.sets = {ParameterSet::compliance};
  const Identification found =
      identify(nominal, rows_of(MeasurementKind::hung_weight, truth, random), options);
  const std::string written = with_identified(text, "mill.toml", found, "rows.csv");
  const Machine machine = read_machine(written, "written.toml");
  for (const IdentifiedParameter& parameter : found.parameters)
    CHECK(value_named(machine, parameter.name) / parameter.value == doctest::Approx(1).epsilon(1e-3));
  std::size_t changed = 0, at = 0, other = 0;
  while (at < text.size() && other < written.size()) {
    const std::string a = text.substr(at, text.find('\n', at) - at),
                      b = written.substr(other, written.find('\n', other) - other);
    if (a != b) {
      ++changed;
      CHECK(a.find("compliance") != std::string::npos);
    }
    at += a.size() + 1;
    other += b.size() + 1;
  }
  CHECK(changed == found.parameters.size());
  CHECK(at >= text.size());
  CHECK(other >= written.size());
}

TEST_CASE("a parameter that is not identified keeps its note, and gets no line if the file has none") {
  const std::string text = mill_text();
  const Machine nominal = read_machine(text, "mill.toml");
  Random random(9);
  IdentifyOptions options;
  options.ladder = false;
  const Identification found =
      identify(nominal, rows_of(MeasurementKind::hung_weight, true_mill(nominal), random), options);
  const std::string written = with_identified(text, "mill.toml", found, "rows.csv");
  CHECK(written.find("\"Z.compliance_m_per_N\" = { value = ") != std::string::npos);
  CHECK(written.find("identified from rows.csv") != std::string::npos);
  CHECK(written.find("50 µm/m, usual; tram the spindle") != std::string::npos);
  CHECK(written.find("\"XY.x_mm\"") == std::string::npos);
}
