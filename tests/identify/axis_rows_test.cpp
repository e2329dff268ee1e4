/// Rows of single axes: ISO 230-2 tables, numbers of a ball bar, torques with the flange clamped; and lost
/// motion from rows with directions.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

/// A mill whose axes have places for lost motion; X grows by 30 um in a metre.
Machine reversing_mill(double reversal_x_um, double reversal_y_um) {
  return read_machine(fmt::format(R"(
format = "counterflex-machine 1"
name = "mill"
controlled = ["x", "y", "z"]
[error_tables.scale]
positions_mm = [-500, 500]
EXX_um = [-15, 15]
[springs.head]
stiffness_diag_si = [2.0e7, 2.0e7, 6.0e7, 1.0e6, 1.0e6, 2.0e6]
[[chain]]
name = "axes"
elements = [
  {{ actuator = "prismatic", axis = "x", reversal_um = {}, error_table = "scale" }},
  {{ error = "XY" }},
  {{ actuator = "prismatic", axis = "y", reversal_um = {} }},
  {{ actuator = "prismatic", axis = "z" }},
  {{ spring = "head" }},
]
)",
                                  reversal_x_um, reversal_y_um),
                      "mill.toml");
}

Measurements read(const Machine& machine, const std::string& csv) {
  Measurements all;
  read_measurements(csv, "rows.csv", machine, all);
  return all;
}

std::string error_of(const Machine& machine, const std::string& csv) {
  try {
    read(machine, csv);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

double value_of(const Identification& found, const std::string& name) {
  for (const IdentifiedParameter& parameter : found.parameters)
    if (parameter.name == name) return parameter.value / parameter.unit;
  FAIL("no parameter " << name);
  return 0;
}

IdentifyOptions all_sets() {
  IdentifyOptions options;
  options.ladder = false;
  return options;
}

}  // namespace

TEST_CASE("an ISO 230-2 table gives the reversal of its axis, and the table of errors explains the rest") {
  std::string csv = "kind,axis,position_mm,deviation_um,direction,sigma_um\n";
  for (int x = -400; x <= 400; x += 100)
    for (const int sign : {1, -1})
      csv +=
          fmt::format("axis_table,X,{},{},{},0.1\n", x, 7 + 0.03 * x - sign * 6.0, sign > 0 ? "up" : "down");
  const Machine machine = reversing_mill(0, 0);
  const Identification found = identify(machine, read(machine, csv), all_sets());
  CHECK(value_of(found, "X.reversal_um") == doctest::Approx(12).epsilon(1e-4));
  CHECK(value_of(found, "Y.reversal_um") < 1e-3);
  CHECK(found.lack_of_fit.value_or(0) < 1e-8);
}

TEST_CASE("tables of several axes do not test each other, and reversals that they show are kept") {
  std::string csv = "kind,axis,position_mm,deviation_um,direction\n";
  Random random(8);
  for (const auto& [axis, lost] : {std::pair{"X", 12.0}, std::pair{"Y", 5.0}})
    for (int run = 0; run < 3; ++run)
      for (int at = -400; at <= 400; at += 80)
        for (const int sign : {1, -1})
          csv += fmt::format("axis_table,{},{},{},{}\n", axis, at,
                             (*axis == 'X' ? 0.03 * at : 0) - sign * lost / 2 + 0.5 * normal(random),
                             sign > 0 ? "+" : "-");
  const Machine machine = reversing_mill(0, 0);
  const Identification found = identify(machine, read(machine, csv), {});
  REQUIRE(!found.ladder.empty());
  CHECK(found.ladder.back().set == ParameterSet::reversal);
  CHECK(found.ladder.back().is_kept);
  CHECK(value_of(found, "X.reversal_um") == doctest::Approx(12).epsilon(0.05));
  CHECK(value_of(found, "Y.reversal_um") == doctest::Approx(5).epsilon(0.1));
}

TEST_CASE("lost motion is found from positions of a tracker whose rows follow each other") {
  const Machine nominal = reversing_mill(0, 0), truth = reversing_mill(12, 5);
  const Model model = prepare(truth);
  StaticsWork work(model.mechanism);
  std::string csv = "kind,X_mm,Y_mm,Z_mm,x_mm,y_mm,z_mm,direction,sigma_um\n";
  Random random(4);
  Vector3 last = Vector3::Zero();
  for (int i = 0; i < 60; ++i) {
    const Vector3 at(uniform(random, -400, 400), uniform(random, -400, 400), uniform(random, -400, 400));
    Directions directions;
    for (int a = 0; a < 3; ++a) directions.set(static_cast<std::size_t>(a), at[a] > last[a] ? 1 : -1);
    const Eigen::VectorXd joints = at * mm + lag_of(model.mechanism, i == 0 ? Directions{} : directions);
    const Equilibrium found =
        solve_forward(model, nominal_forward(model, model.home, joints).configuration, Load{}, Stage{}, work);
    const Vector3 p = tip(model.mechanism, found.configuration).p / mm;
    csv += fmt::format("tracker_point,{},{},{},{:.9f},{:.9f},{:.9f},previous,0.1\n", at[0], at[1], at[2],
                       p[0], p[1], p[2]);
    last = at;
  }
  const Identification found = identify(nominal, read(nominal, csv), all_sets());
  CHECK(value_of(found, "X.reversal_um") == doctest::Approx(12).epsilon(1e-3));
  CHECK(value_of(found, "Y.reversal_um") == doctest::Approx(5).epsilon(1e-3));
  CHECK(found.lack_of_fit.value_or(0) < 1e-8);
}

TEST_CASE("the numbers of a ball bar's report are squareness, reversal and scale") {
  const Machine machine = reversing_mill(0, 0);
  const Measurements rows =
      read(machine,
           "kind,axes,squareness_um_per_m,reversal_um,scale_um_per_m,radius_mm,sigma_um,"
           "sigma_squareness_um_per_m,sigma_scale_um_per_m\n"
           "ballbar,XY,-18,,,150,,0.1,\n"
           "ballbar,X,,9,30,150,0.1,,0.1\n"
           "ballbar,Y,,4,,150,0.1,,\n");
  REQUIRE(rows.rows.size() == 4);
  CHECK(rows.rows[0].states[1].shown[0] == doctest::Approx(0.15));
  const Identification found = identify(machine, rows, all_sets());
  CHECK(value_of(found, "X.reversal_um") == doctest::Approx(9).epsilon(1e-4));
  CHECK(value_of(found, "Y.reversal_um") == doctest::Approx(4).epsilon(1e-4));
  Tips tips(found.machine);
  std::vector<Vector3> p;
  for (const CommandedState& state : rows.rows[0].states) p.push_back(tips(state).p);
  CHECK(-(p[1] - p[0]).normalized().dot((p[3] - p[2]).normalized()) * 1e6 ==
        doctest::Approx(-18).epsilon(1e-3));
  // The scale is that of the table of errors: nothing else has to explain it.
  CHECK(found.outlier_count == 0);
  CHECK((tips(rows.rows[2].states[1]).p - tips(rows.rows[2].states[0]).p).norm() / 0.3 - 1 ==
        doctest::Approx(30e-6).epsilon(1e-3));
}

TEST_CASE("with the flange clamped a torque turns a joint of an arm by its own compliance") {
  // The six twists of an arm are independent: if the flange stays, no other joint can yield.
  const Machine nominal = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml");
  std::vector<double> truth(6);
  std::string csv =
      "kind,session,axis,A1_deg,A2_deg,A3_deg,A4_deg,A5_deg,A6_deg,torque_Nm,sigma_angle_mdeg\n";
  const std::vector<Parameter> all = parameters(nominal);
  std::size_t axis = 0;
  std::vector<std::string> names;
  for (const Parameter& parameter : all) {
    if (parameter.kind != ParameterKind::compliance) continue;
    truth[axis] = parameter.value * (1.2 + 0.1 * static_cast<double>(axis));
    names.push_back(parameter.name);
    for (const double torque : {-40.0, 0.0, 40.0}) {
      std::array<double, 6> q = {10, -75, 80, -20, 55, 30};
      q[axis] += 0.013 + truth[axis] * torque / deg;
      csv += fmt::format("clamped_torque,one,A{},{:.12f},{:.12f},{:.12f},{:.12f},{:.12f},{:.12f},{},0.1\n",
                         axis + 1, q[0], q[1], q[2], q[3], q[4], q[5], torque);
    }
    ++axis;
  }
  REQUIRE(axis == 6);
  IdentifyOptions options = all_sets();
  options.sets = {ParameterSet::compliance};
  const Identification found = identify(nominal, read(nominal, csv), options);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(value_of(found, names[i]) / truth[i] == doctest::Approx(1).epsilon(2e-3));
}

TEST_CASE("rows of axes that cannot be are refused at their place") {
  const Machine machine = reversing_mill(0, 0);
  const std::string table = "kind,axis,position_mm,deviation_um,direction\n";
  CHECK(error_of(machine, table + "axis_table,A,0,1,up\n") ==
        "rows.csv:2:12: error: axis is \"A\"; it must be one of X, Y, Z");
  CHECK(
      error_of(machine, table + "axis_table,X,0,1,left\n") ==
      "rows.csv:2:18: error: direction is \"left\"; it must be +, -, up, down, previous, or 3 signs of +, - "
      "and 0, one for each actuator");
  CHECK(error_of(machine, "kind,axis,position_deg,deviation_um,direction\naxis_table,X,0,1,up\n") ==
        "rows.csv:2:14: error: position has a unit of angles; axis X is linear");
  CHECK(error_of(machine, "kind,axis,torque_Nm,X_mm,Y_mm,Z_mm\nclamped_torque,X,1,0,0,0\n") ==
        "rows.csv:2:16: error: axis X is linear; rows of kind clamped_torque need a rotary axis");
  CHECK(error_of(machine, "kind,axes,reversal_um\nballbar,XY,3\n") ==
        "rows.csv:2:9: error: axes is \"XY\"; the reversal is that of one axis");
  CHECK(error_of(machine, "kind,axes,squareness_um_per_m\nballbar,X,3\n") ==
        "rows.csv:2:9: error: axes is \"X\"; a squareness is that of two axes");
  CHECK(error_of(machine, "kind,axes,squareness_um_per_m\nballbar,XY,\n") ==
        "rows.csv:2:1: error: the row has no squareness, no reversal and no scale");
  const Machine legs = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/hexapod/machine.toml");
  CHECK(error_of(legs, "kind,axis,reversal_um\nreversal,q1,3\n")
            .starts_with("rows.csv:2:10: error: the tip does not move as far as "));
}

TEST_CASE("rows of slopes that contradict each other do not fit, and say nothing of lengths") {
  const Machine machine = reversing_mill(0, 0);
  const Identification found = identify(machine,
                                        read(machine,
                                             "kind,axes,squareness_um_per_m,sigma_squareness_um_per_"
                                             "m\nsquareness,XY,100,1\nsquareness,XY,-100,1\n"),
                                        all_sets());
  CHECK_FALSE(found.lack_of_fit.has_value());
  CHECK(found.misfit.value_or(0) > 3);
}
