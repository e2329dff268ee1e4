/// Which measurement makes the deviations of a program more certain: cases that are computed by hand.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/next_measurements.hpp"
#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

const char* const x_compliance = "X.compliance_m_per_N";
const char* const y_compliance = "Y.compliance_m_per_N";

Machine mill_for_program() {
  return read_machine(machine_file(MachineFacts{}), "mill.toml");
}

CommandedState state_at(double X, double Y, double Z, const Vector3& F = Vector3::Zero()) {
  CommandedState state{Vector3(X, Y, Z)};
  state.F.head<3>() = F;
  return state;
}

NextMeasurement push_along(int axis, double force, double sigma) {
  NextMeasurement push;
  push.what = std::string("push ") + "xyz"[axis];
  push.row.states = {state_at(0.3, 0.2, -0.2, force * Vector3::Unit(axis)), state_at(0.3, 0.2, -0.2)};
  push.row.direction = Vector3::Unit(axis);
  push.row.sigma = sigma;
  return push;
}

}  // namespace

TEST_CASE("pushes shrink the deviation of a program under force by what they show of its compliances") {
  // The deviation is (c_x 200 N, c_y 500 N). A push of 300 N with a gauge of 5 um has the weight (300 N / 5
  // um)^2.
  const double s_x = 2e-8, s_y = 1e-8, gauge = 5e-6;
  const KnownParameters known{{x_compliance, y_compliance},
                              Vector3(s_x * s_x, s_y * s_y, 0).head<2>().asDiagonal()};
  const std::vector<ProgramPlace> program{{state_at(0.3, 0.2, -0.2, Vector3(200, 500, 0)), 3}};
  const ProgramUncertainty found = next_measurements(
      mill_for_program(), known, program,
      {push_along(2, 300, gauge), push_along(0, 300, gauge), push_along(1, 300, gauge)}, 3, 1);
  const auto after = [&](int pushes_x, int pushes_y) {
    const double weight = 300 / gauge * 300 / gauge;
    const double v_x = 1 / (1 / (s_x * s_x) + pushes_x * weight),
                 v_y = 1 / (1 / (s_y * s_y) + pushes_y * weight);
    return std::sqrt(200.0 * 200 * v_x + 500.0 * 500 * v_y);
  };
  CHECK(found.sigma == doctest::Approx(after(0, 0)).epsilon(1e-6));
  REQUIRE(found.next.size() == 3);
  CHECK(found.next[0].what == "push x");  // 9.4e-12 of 1.6e-11 m2, push y 6.6e-12 of 2.5e-11 m2
  CHECK(found.next[0].sigma_after == doctest::Approx(after(1, 0)).epsilon(1e-6));
  CHECK(found.next[1].what == "push y");
  CHECK(found.next[1].sigma_after == doctest::Approx(after(1, 1)).epsilon(1e-6));
  CHECK(found.next[2].what == "push y");
  CHECK(found.next[2].sigma_after == doctest::Approx(after(1, 2)).epsilon(1e-6));
}

TEST_CASE("a tracker point where a squareness error is large shrinks it where the program is") {
  const double s = 50e-6, tracker = 20e-6;
  const KnownParameters known{{"XY.rz_deg"}, Eigen::MatrixXd::Constant(1, 1, s * s)};
  const std::vector<ProgramPlace> program{{state_at(0.3, 0.1, -0.2), 1}, {state_at(0.2, 0.3, -0.2), 1}};
  NextMeasurement near, far;
  for (NextMeasurement* point : {&near, &far}) {
    point->kind = MeasurementKind::tracker_point;
    point->row.sigma = tracker;
  }
  near.row.states = {state_at(0.3, 0.1, -0.2)};
  far.row.states = {state_at(0.1, 0.4, -0.1)};
  far.what = "far";
  const ProgramUncertainty found = next_measurements(mill_for_program(), known, program, {near, far}, 1, 1);
  // The tip moves in x by the angle times Y: 0.1 and 0.3 m in the program, 0.1 m about their mean.
  const double arms = 0.1;
  CHECK(found.sigma == doctest::Approx(arms * s).epsilon(1e-6));
  REQUIRE(found.next.size() == 1);
  CHECK(found.next[0].what == "far");
  const double angle = s / std::sqrt(1 + 0.4 * 0.4 * s * s / (tracker * tracker));
  CHECK(found.next[0].sigma_after == doctest::Approx(arms * angle).epsilon(1e-6));
}

TEST_CASE("a chosen measurement leaves what a fit with its row leaves") {
  const Machine machine = mill_for_program();
  Random random(4);
  Measurements given;
  add_pushes(machine, 6, 0.1, 0, 300, 3e-6, random, given);
  IdentifyOptions options;
  options.ladder = false;
  options.sets = {ParameterSet::compliance};
  const auto known_of = [](const Identification& found) {
    KnownParameters known{{}, found.covariance};
    for (const IdentifiedParameter& parameter : found.parameters) known.names.push_back(parameter.name);
    return known;
  };
  const Identification found = identify(machine, given, options);
  const std::vector<ProgramPlace> program{{state_at(0.3, 0.2, -0.2, Vector3(200, -300, 100)), 1}};
  const std::vector<NextMeasurement> candidates = candidate_measurements(machine, given, program);
  CHECK(candidates.size() == 4 * (1 + 27));
  const ProgramUncertainty next =
      next_measurements(found.machine, known_of(found), program, candidates, 1, 1);
  REQUIRE(next.next.size() == 1);
  REQUIRE(next.next[0].kind == MeasurementKind::static_push);
  Measurements more = given;
  Tips tips(machine);
  Measurement row = next.next[0].row;
  row.value = row.direction.dot(tips(row.states[0]).p - tips(row.states[1]).p);
  more.rows.push_back(row);
  const Identification better = identify(machine, more, options);
  const double then = next_measurements(better.machine, known_of(better), program, {}, 0, 1).sigma;
  CHECK(then == doctest::Approx(next.next[0].sigma_after).epsilon(0.1));
  CHECK(then < 0.95 * next.sigma);
}

TEST_CASE("parameters that a fit does not vary are as uncertain as the machine file states") {
  const Machine machine = mill_for_program();
  Random random(4);
  Measurements given;
  add_pushes(machine, 6, 0.1, 0, 300, 3e-6, random, given);
  IdentifyOptions options;
  options.ladder = false;
  options.sets = {ParameterSet::compliance};
  const KnownParameters known = known_parameters(identify(machine, given, options));
  const auto at = std::find(known.names.begin(), known.names.end(), "XY.rz_deg");
  REQUIRE(at != known.names.end());
  const auto k = at - known.names.begin();
  CHECK(std::sqrt(known.covariance(k, k)) == doctest::Approx(50e-6).epsilon(0.01));
  CHECK(known.names.size() == parameters(machine).size());
}
