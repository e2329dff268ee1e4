#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

/// A robot whose joints have errors and compliances with stated deviations.
Machine six_axis_robot() {
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml");
  machine.gravity.true_at_home = false;
  std::vector<double> values = values_of(machine);
  const std::vector<Parameter> all = parameters(machine);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].kind == ParameterKind::position || all[i].kind == ParameterKind::orientation) values[i] = 0;
  return with_parameters(machine, values);
}

/// The machine with errors and compliances drawn from their default priors.
Machine drawn(const Machine& machine, double position, double orientation, double share, Random& random) {
  std::vector<double> values = values_of(machine);
  const std::vector<Parameter> all = parameters(machine);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].kind == ParameterKind::position) values[i] += position * normal(random);
    if (all[i].kind == ParameterKind::orientation) values[i] += orientation * normal(random);
    if (all[i].kind == ParameterKind::compliance)
      values[i] *= std::clamp(1 + share * normal(random), 0.3, 3.0);
  }
  return with_parameters(machine, values);
}

const Pose tracker_frame{from_rpy(Vector3(0.3, -0.2, 2.0)), Vector3(1.2, -3.1, 0.4)};
const Pose probe{from_rpy(Vector3(0.1, 0.4, -1.0)), Vector3(0.02, 0.05, 0.08)};

/// Largest distance between the tips of two machines at states that no measurement has; frames of the session
/// are taken out by comparing motions from a first state.
double largest_difference(const Machine& a, const Machine& b, Random& random) {
  Tips tips_a(a), tips_b(b);
  std::vector<Vector3> pa, pb;
  double largest = 0;
  for (int i = 0; i < 30; ++i) {
    const CommandedState state = random_state(a, 0.15, 0.6, random);
    pa.push_back(tips_a(state).p);
    pb.push_back(tips_b(state).p);
    for (int k = 0; k < i; ++k)
      largest = std::max(largest, std::abs((pa[static_cast<std::size_t>(k)] - pa.back()).norm() -
                                           (pb[static_cast<std::size_t>(k)] - pb.back()).norm()));
  }
  return largest;
}

IdentifyOptions without_ladder() {
  IdentifyOptions options;
  options.ladder = false;
  options.threads = 2;
  return options;
}

}  // namespace

TEST_CASE("a robot measured without noise is found again") {
  Random random(7);
  const Machine nominal = six_axis_robot(), truth = drawn(nominal, 0.3e-3, 3e-4, 0.3, random);
  Measurements all;
  add_tracker(truth, tracker_frame, probe, true, 150, 0, 0.8, 0, random, all, "tracker");
  add_pushes(truth, 20, 0, 0.5, 300, 0, random, all);
  const Identification found = identify(nominal, all, without_ladder());
  // The state of the machine is what counts; single parameters can be exchanged for others.
  CHECK(largest_difference(nominal, truth, random) > 5e-4);
  CHECK(largest_difference(found.machine, truth, random) < 2e-7);
  CHECK(found.outlier_count == 0);
}

TEST_CASE("gross errors are named and do not change the result") {
  Random random(11);
  const Machine nominal = six_axis_robot(), truth = drawn(nominal, 0.3e-3, 3e-4, 0.3, random);
  Measurements all;
  add_tracker(truth, tracker_frame, probe, true, 200, 0, 0.8, 2e-5, random, all, "tracker");
  const Identification clean = identify(nominal, all, without_ladder());
  std::vector<int> spoilt;
  for (std::size_t i = 5; i < 200; i += 10) {
    all.rows[i].X.p += Vector3(normal(random), normal(random), normal(random)) * 0.02;
    spoilt.push_back(all.rows[i].at.line);
  }
  const Identification found = identify(nominal, all, without_ladder());
  REQUIRE(found.outlier_count == spoilt.size());
  std::vector<int> named;
  for (const Outlier& outlier : found.outliers) named.push_back(outlier.at.line);
  std::sort(named.begin(), named.end());
  CHECK(named == spoilt);
  for (std::size_t k = 0; k < found.parameters.size(); ++k) {
    CAPTURE(found.parameters[k].name);
    CHECK(std::abs(found.parameters[k].value - clean.parameters[k].value) < 1.5 * clean.parameters[k].sigma);
  }
}

TEST_CASE("the result does not depend on the order of rows, on the tracker's frame, or on threads") {
  Random random(3);
  const Machine nominal = six_axis_robot(), truth = drawn(nominal, 0.3e-3, 3e-4, 0.3, random);
  Measurements all;
  add_tracker(truth, tracker_frame, probe, true, 100, 0, 0.8, 2e-5, random, all, "tracker");
  const Identification found = identify(nominal, all, without_ladder());
  const auto check_same = [&](const Identification& other, double tolerance) {
    REQUIRE(other.parameters.size() == found.parameters.size());
    for (std::size_t k = 0; k < found.parameters.size(); ++k) {
      CAPTURE(found.parameters[k].name);
      CHECK(std::abs(other.parameters[k].value - found.parameters[k].value) <=
            tolerance * found.parameters[k].prior);
    }
  };
  SUBCASE("threads") {
    // More rows than one thread takes at a time, with everything that is computed from them.
    Measurements many;
    add_tracker(truth, tracker_frame, probe, true, 600, 0, 0.8, 2e-5, random, many, "tracker");
    IdentifyOptions options;
    const Identification one = identify(nominal, many, options);
    options.threads = 3;
    const Identification three = identify(nominal, many, options);
    REQUIRE(one.parameters.size() == three.parameters.size());
    for (std::size_t k = 0; k < one.parameters.size(); ++k)
      CHECK(one.parameters[k].value == three.parameters[k].value);
    CHECK(one.covariance == three.covariance);
    for (std::size_t g = 0; g < one.held_out.size(); ++g)
      CHECK(one.held_out[g].after.mean == three.held_out[g].after.mean);
  }
  SUBCASE("order") {
    std::reverse(all.rows.begin(), all.rows.end());
    check_same(identify(nominal, all, without_ladder()), 1e-6);
  }
  SUBCASE("frame") {
    const Pose X{from_rpy(Vector3(1, 0.5, -2)), Vector3(-4, 2, 1)};
    for (Measurement& row : all.rows) row.X = X * row.X;
    check_same(identify(nominal, all, without_ladder()), 1e-6);
  }
}

TEST_CASE("values that are measured lie in their 95 % intervals as often as stated") {
  int inside = 0, count = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    Random random(100 + seed);
    Machine nominal = six_axis_robot();
    for (const Parameter& parameter : parameters(nominal)) {
      const double sigma = parameter.kind == ParameterKind::position      ? 0.3e-3
                           : parameter.kind == ParameterKind::orientation ? 3e-4
                           : parameter.kind == ParameterKind::compliance  ? 0.2 * parameter.value
                                                                          : 0;
      nominal.parameters.push_back({parameter.name, NumberSource::prior, sigma, ""});
    }
    const Machine truth = drawn(nominal, 0.3e-3, 3e-4, 0.2, random);
    Measurements all;
    add_tracker(truth, tracker_frame, probe, true, 60, 0, 0.8, 3e-5, random, all, "tracker");
    const Identification found = identify(nominal, all, without_ladder());
    const std::vector<Parameter> real = parameters(truth);
    for (const IdentifiedParameter& parameter : found.parameters) {
      const auto at = std::find_if(real.begin(), real.end(),
                                   [&](const Parameter& p) { return p.name == parameter.name; });
      inside += std::abs(parameter.value - at->value) < 1.96 * parameter.sigma;
      ++count;
    }
  }
  const double share = static_cast<double>(inside) / count;
  CAPTURE(share);
  CHECK(share > 0.92);
  CHECK(share < 0.98);
}

TEST_CASE("what the measurements do not determine keeps its prior and is named") {
  Random random(5);
  const Machine nominal = six_axis_robot(), truth = drawn(nominal, 0.3e-3, 3e-4, 0.2, random);
  Measurements all;  // the last axis does not move, and no force acts
  add_tracker(truth, tracker_frame, probe, true, 60, 0, 0.8, 3e-5, random, all, "tracker");
  Tips tips(truth);
  for (Measurement& row : all.rows) {
    row.states[0].shown[5] = 0;
    row.X = tracker_frame * tips(row.states[0]) * probe;
  }
  const Identification found = identify(nominal, all, without_ladder());
  for (const IdentifiedParameter& parameter : found.parameters)
    if (parameter.kind == ParameterKind::compliance && parameter.name.starts_with("compliance6"))
      CHECK_FALSE(parameter.is_identified);
}

TEST_CASE("too few measurements, and states that are all alike, are refused") {
  Random random(5);
  const Machine nominal = six_axis_robot();
  Measurements all;
  add_tracker(nominal, tracker_frame, probe, true, 2, 0, 0.8, 0, random, all, "tracker");
  CHECK_THROWS_WITH_AS(
      identify(nominal, all, {}),
      "tracker.csv:2:1: error: session \"tracker\" has 12 measured numbers; its frames alone have 12 "
      "freedoms: measure more states",
      InputError);
  Measurements alike;
  add_tracker(nominal, tracker_frame, probe, true, 5, 0, 0, 0, random, alike, "tracker");
  CHECK_THROWS_WITH_AS(
      identify(nominal, alike, {}),
      "tracker.csv:2:1: error: all rows of session \"tracker\" have the same actuator values; no fit can "
      "separate its frames from the machine's parameters: measure other states",
      InputError);
}

TEST_CASE("rows that were copied are refused, a few equal ones are not") {
  Random random(8);
  const Machine nominal = six_axis_robot();
  Measurements all;
  add_tracker(nominal, Pose{}, Pose{}, false, 30, 0, 0.5, 20e-6, random, all, "one");
  IdentifyOptions options;
  options.ladder = false;
  options.sets = {ParameterSet::compliance};
  Measurements few = all, twice = all;
  for (int i = 0; i < 3; ++i) few.rows.push_back(all.rows[static_cast<std::size_t>(i)]);
  CHECK_NOTHROW(identify(nominal, few, options));
  twice.rows.insert(twice.rows.end(), all.rows.begin(), all.rows.end());
  CHECK_THROWS_WITH_AS(
      identify(nominal, twice, options),
      "one.csv:2:1: error: session \"one\": 30 of 60 rows are copies, the first of one.csv:2; "
      "a copy shows no noise: give each row once",
      InputError);
}

TEST_CASE("a session in inches, or with radians as degrees, is refused by name") {
  Random random(5);
  const Machine nominal = six_axis_robot();
  Measurements all;
  add_tracker(nominal, tracker_frame, probe, true, 40, 0, 0.8, 1e-5, random, all, "A");
  add_tracker(nominal, tracker_frame, probe, true, 40, 0, 0.8, 1e-5, random, all, "B");
  Measurements inches = all, radians = all;
  for (Measurement& row : inches.rows)
    if (row.session == 1) row.X.p /= 25.4;
  for (Measurement& row : radians.rows)
    if (row.session == 1) row.states[0].shown *= deg;
  for (const Measurements& wrong : {inches, radians}) {
    try {
      identify(nominal, wrong, {});
      FAIL("it was accepted");
    } catch (const InputError& error) {
      const std::string what = error.what();
      CHECK(what.starts_with("B.csv:2:1: error: session \"B\": the measured positions spread "));
      CHECK(what.find("check the units of x, y, z and of the actuators") != std::string::npos);
    }
  }
}

TEST_CASE("readings against their forces are refused, a few of them are not") {
  Random random(5);
  const Machine nominal = six_axis_robot();
  Measurements all;
  add_pushes(nominal, 12, 0, 0.5, 300, 0, random, all);
  Measurements few = all;
  for (Measurement& row : all.rows) row.value *= -1;
  for (std::size_t i = 0; i < 4; ++i) few.rows[i].value *= -1;
  CHECK_NOTHROW(identify(nominal, few, {}));
  try {
    identify(nominal, all, {});
    FAIL("it was accepted");
  } catch (const InputError& error) {
    const std::string what = error.what();
    CHECK(what.starts_with(
        "pushes.csv:2:1: error: session \"pushes\": 12 of 12 readings are against their forces"));
    CHECK(what.find("a reading is positive in the direction of gx, gy, gz") != std::string::npos);
  }
}

TEST_CASE("measurements that fit the machine file as it is keep no set, and the result has no parameter") {
  Random random(5);
  const Machine nominal = six_axis_robot();
  Measurements all;
  add_pushes(nominal, 20, 0, 0.5, 300, 1e-5, random, all);
  IdentifyOptions options;
  options.sets = {ParameterSet::compliance};
  const Identification found = identify(nominal, all, options);
  REQUIRE(found.ladder.size() == 1);
  CHECK_FALSE(found.ladder[0].is_kept);
  CHECK(found.parameters.empty());
  CHECK(found.free.empty());
}

TEST_CASE("the misfit is the size of the residuals in the deviations that the rows state") {
  const Machine nominal = six_axis_robot();
  const auto misfit_of = [&](double share) {
    Random random(5);
    Measurements all;
    add_pushes(nominal, 40, 0, 0.5, 300, 1e-5, random, all);
    for (Measurement& row : all.rows) row.sigma *= share;
    return identify(nominal, all, without_ladder()).misfit.value_or(0);
  };
  CHECK(misfit_of(1) > 0.5);
  CHECK(misfit_of(1) < 1.2);
  CHECK(misfit_of(0.1) > 5);
}

TEST_CASE("two rows that were swapped are named") {
  Random random(6);
  const Machine nominal = six_axis_robot(), truth = drawn(nominal, 0.3e-3, 3e-4, 0.3, random);
  Measurements all;
  add_tracker(truth, tracker_frame, probe, true, 60, 0, 0.8, 2e-5, random, all, "tracker");
  std::swap(all.rows[10].X, all.rows[33].X);
  const Identification found = identify(nominal, all, without_ladder());
  REQUIRE(found.outlier_count == 2);
  CHECK(std::min(found.outliers[0].at.line, found.outliers[1].at.line) == 12);
  CHECK(std::max(found.outliers[0].at.line, found.outliers[1].at.line) == 35);
}

TEST_CASE("with two sessions each is predicted by a fit to the other, and sets that help are kept") {
  Random random(21);
  const Machine nominal = six_axis_robot(), truth = drawn(nominal, 0.5e-3, 5e-4, 0.3, random);
  Measurements all;
  for (const char* name : {"A", "B"})
    add_tracker(truth, tracker_frame, probe, true, 80, 0, 0.8, 2e-5, random, all, name);
  IdentifyOptions options;
  options.threads = 2;
  const Identification found = identify(nominal, all, options);
  REQUIRE(found.held_out.size() == 2);
  for (const HeldOutGroup& group : found.held_out) {
    CAPTURE(group.name);
    CHECK(group.after.count == 60);
    CHECK(group.before.mean > 3e-4);
    CHECK(group.after.mean < 6e-5);
  }
  REQUIRE(found.ladder.size() == 3);
  CHECK(found.ladder[1].set == ParameterSet::geometry);
  CHECK(found.ladder[1].is_kept);
}
