/// Errors that depend on the place of an axis: harmonics of joints, tables of linear axes, and when they are
/// kept.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

/// A robot with places for harmonics, `size` (rad) of them in joints 2 and 3.
Machine arm_with_harmonics(double size) {
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml");
  machine.gravity.true_at_home = false;
  int joint = 0;
  for (Element& element : machine.chains[0].elements)
    if (auto* actuator = std::get_if<Actuator>(&element)) {
      ++joint;
      actuator->harmonics = {0, 0};
      if (joint == 2) actuator->harmonics = {size, -0.5 * size};
      if (joint == 3) actuator->harmonics = {-0.3 * size, 0.8 * size};
    }
  return machine;
}

/// Rows of a tracker with 10 um noise; joint 2 is `shift` (rad) away from home in the second session.
Measurements two_sessions(const Machine& truth, double shift, Random& random) {
  const Pose X_SM{from_rpy(Vector3(0.3, -0.2, 2.0)), Vector3(1.2, -3.1, 0.4)},
      X_TB{from_rpy(Vector3(0.1, 0.4, -1.0)), Vector3(0.02, 0.05, 0.08)};
  Measurements all;
  for (const char* name : {"A", "B"})
    add_tracker(truth, X_SM, X_TB, true, 80, 0, 1.2, 1e-5, random, all, name);
  Tips tips(truth);
  for (Measurement& row : all.rows) {
    if (row.session == 0) continue;
    row.states[0].shown[1] += shift;
    row.X = X_SM * tips(row.states[0]) * X_TB;
    for (int k = 0; k < 3; ++k) row.X.p[k] += 1e-5 * normal(random);
    row.X.R = exp_so3(4e-5 * Vector3(normal(random), normal(random), normal(random))) * row.X.R;
  }
  return all;
}

const LadderStep& step_of(const Identification& found, ParameterSet set) {
  for (const LadderStep& step : found.ladder)
    if (step.set == set) return step;
  FAIL("the set was not tried");
  return found.ladder[0];
}

/// Checks parameters of one kind against the true machine, and that all of them are there.
void check_against(const Machine& truth, ParameterKind kind, double largest_sigma,
                   const Identification& found) {
  std::size_t count = 0;
  for (const Parameter& real : parameters(truth)) {
    if (real.kind != kind) continue;
    const auto at = std::find_if(found.parameters.begin(), found.parameters.end(),
                                 [&](const IdentifiedParameter& p) { return p.name == real.name; });
    if (at == found.parameters.end()) continue;
    CAPTURE(real.name);
    CHECK(std::abs(at->value - real.value) < 3 * at->sigma);
    CHECK(at->sigma < largest_sigma);
    ++count;
  }
  CHECK(count > 0);
}

IdentifyOptions two_threads() {
  IdentifyOptions options;
  options.threads = 2;
  return options;
}

/// A table with errors (um) at -500, -250, 0, 250 and 500 mm of X; the first one is the reference.
Machine mill_with_table(const std::string& errors) {
  return read_machine(fmt::format(R"(
format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[error_tables.pitch]
positions_mm = [-500, -250, 0, 250, 500]
EXX_um = [{}]
sigma_um = 30
[parameters]
"X.error[-500]_um" = {{ sigma = 0, source = "measured" }}
[springs.head]
stiffness_diag_si = [2.0e7, 2.0e7, 6.0e7, 1.0e6, 1.0e6, 2.0e6]
[[chain]]
name = "axes"
elements = [
  {{ actuator = "prismatic", axis = "x", error_table = "pitch" }},
  {{ error = "XY" }},
  {{ actuator = "prismatic", axis = "y" }},
  {{ actuator = "prismatic", axis = "z" }},
  {{ spring = "head" }},
]
)",
                                  errors),
                      "mill.toml");
}

}  // namespace

TEST_CASE("harmonics of two joints are found in their intervals, and the ladder keeps them") {
  Random random(5);
  const Machine truth = arm_with_harmonics(3e-4), nominal = arm_with_harmonics(0);
  const Identification found = identify(nominal, two_sessions(truth, 0, random), two_threads());
  CHECK(step_of(found, ParameterSet::harmonics).is_kept);
  CHECK_FALSE(step_of(found, ParameterSet::harmonics).left);
  check_against(truth, ParameterKind::harmonic, 1e-4, found);
  CHECK(found.is_converged);
}

TEST_CASE("harmonics that a robot does not have are rejected") {
  Random random(6);
  const Machine truth = arm_with_harmonics(0);
  const Identification found = identify(truth, two_sessions(truth, 0, random), two_threads());
  CHECK_FALSE(step_of(found, ParameterSet::harmonics).is_kept);
  for (const IdentifiedParameter& parameter : found.parameters)
    CHECK(parameter.kind != ParameterKind::harmonic);
}

TEST_CASE("harmonics are rejected where a session leaves the range of a joint, whose name is given") {
  Random random(7);
  const Machine truth = arm_with_harmonics(3e-4), nominal = arm_with_harmonics(0);
  const Identification found = identify(nominal, two_sessions(truth, 1.5, random), two_threads());
  const LadderStep& step = step_of(found, ParameterSet::harmonics);
  CHECK_FALSE(step.is_kept);
  REQUIRE(step.left);
  CHECK(step.left->actuator == "axis A2");
  CHECK(step.left->turns);
  CHECK(std::max(std::abs(step.left->tested_max - step.left->trained_max),
                 std::abs(step.left->tested_min - step.left->trained_min)) > 1.0);
}

TEST_CASE("harmonics that were written to a machine file and a covariance are where a second fit begins") {
  MachineFacts facts;
  facts.kind = MachineKind::robot6r;
  facts.robot = "ur10";
  const std::string text = machine_file(facts);
  const Machine nominal = read_machine(text, "ur10.toml");
  std::vector<double> values = values_of(nominal);
  const std::vector<Parameter> all = parameters(nominal);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].kind == ParameterKind::harmonic) values[i] = 2e-4 * std::sin(static_cast<double>(i));
  const Machine truth = with_parameters(nominal, values);
  Random random(3);
  IdentifyOptions options;
  options.sets = {ParameterSet::harmonics};
  options.ladder = false;
  const auto rows = [&] {
    Measurements measured;
    add_tracker(truth, Pose{}, Pose{}, true, 60, 0, 2.0, 1e-5, random, measured, "A");
    return measured;
  };
  const Identification first = identify(nominal, rows(), options);
  REQUIRE(first.parameters.size() == 24);
  const Machine machine = read_machine(with_identified(text, "ur10.toml", first, "A.csv"), "measured.toml");
  options.prior = known_parameters(first);
  const Identification second = identify(machine, rows(), options);
  REQUIRE(second.parameters.size() == 24);
  for (std::size_t k = 0; k < 24; ++k) {
    CAPTURE(first.parameters[k].name);
    CHECK(std::abs(second.parameters[k].before - first.parameters[k].value) <
          0.01 * first.parameters[k].sigma);
    CHECK(second.parameters[k].prior == doctest::Approx(first.parameters[k].sigma));
    CHECK(second.parameters[k].sigma < 0.9 * first.parameters[k].sigma);
  }
  check_against(truth, ParameterKind::harmonic, 1e-4, second);
}

TEST_CASE("without rows to test them harmonics are left out, unless all sets are kept") {
  Random random(8);
  const Machine nominal = arm_with_harmonics(0);
  Measurements few;
  add_tracker(nominal, Pose{}, Pose{}, true, 8, 0, 1.2, 1e-5, random, few, "A");
  const auto count = [&](bool ladder) {
    IdentifyOptions options;
    options.ladder = ladder;
    const Identification found = identify(nominal, few, options);
    REQUIRE(found.held_out.empty());
    return std::count_if(found.parameters.begin(), found.parameters.end(),
                         [](const IdentifiedParameter& p) { return p.kind == ParameterKind::harmonic; });
  };
  CHECK(count(true) == 0);
  CHECK(count(false) == 12);
}

TEST_CASE("the positioning errors of a linear axis are found from its table of ISO 230-2 and a tracker") {
  Random random(9);
  const Machine truth = mill_with_table("0, 12, -5, 20, 8"), nominal = mill_with_table("0, 0, 0, 0, 0");
  Tips tips(truth);
  std::string csv = "kind,axis,position_mm,deviation_um,direction,sigma_um\n";
  for (int run = 0; run < 3; ++run)
    for (int x = -500; x <= 500; x += 50) {
      const CommandedState state{Vector3(x * mm, 0, 0)};
      csv += fmt::format("axis_table,X,{},{:.3f},0,1\n", x,
                         (tips(state).p.x() - tips({Vector3(0, 0, 0)}).p.x() - x * mm) / um + normal(random));
    }
  Measurements all;
  read_measurements(csv, "laser.csv", nominal, all);
  add_tracker(truth, {from_rpy(Vector3(0.3, -0.2, 2.0)), Vector3(1.2, -3.1, 0.4)}, Pose{}, false, 60, 0.45, 0,
              1e-5, random, all, "tracker");
  const Identification found = identify(nominal, all, two_threads());
  CHECK(step_of(found, ParameterSet::tables).is_kept);
  check_against(truth, ParameterKind::table, 3e-6, found);
  CHECK(found.is_converged);
}
