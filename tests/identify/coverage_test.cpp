/// Synthetic campaigns on machines that `counterflex new` makes: errors and compliances are drawn from the
/// priors of the machine file, measured with noise, and identified.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/tip_stiffness.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

Machine made(MachineKind kind) {
  MachineFacts facts;
  facts.kind = kind;
  if (kind == MachineKind::robot6r) facts.robot = "kuka-kr270-r2700-ultra";
  return read_machine(machine_file(facts), "made.toml");
}

/// The same with compliances known to 20 %: a normal distribution must not reach zero.
Machine with_narrow_priors(Machine machine) {
  const std::vector<Parameter> all = parameters(machine);
  for (const Parameter& parameter : all) {
    if (parameter.kind != ParameterKind::compliance) continue;
    for (ParameterStatement& stated : machine.parameters)
      if (stated.name == parameter.name) stated.sigma = 0.2 * parameter.value;
  }
  return machine;
}

/// The machine with parameters drawn from its priors.
Machine drawn_from_priors(const Machine& machine, Random& random) {
  std::vector<double> values = values_of(machine);
  const std::vector<Parameter> all = parameters(machine);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const ParameterStatement& stated : machine.parameters)
      if (stated.name == all[i].name && stated.sigma) {
        values[i] += *stated.sigma * normal(random);
        if (all[i].kind == ParameterKind::compliance) values[i] = std::max(values[i], 0.2 * all[i].value);
      }
  return with_parameters(machine, values);
}

struct Share {
  double inside = 0, count = 0;
  void add(double share, double weight) {
    inside += share * weight;
    count += weight;
  }
  double value() const { return inside / count; }
};

/// Of true values in the 95 % intervals of the fit, and of measured numbers in those of a fit without them.
struct Coverage {
  Share parameters, predictions;
  unsigned converged = 0;  ///< campaigns
};

/// A machine, and the states of its campaigns: within `length` (m) and `turn` (rad) of home, pushed by
/// `force`.
struct Campaign {
  MachineKind kind;
  double length, turn, force;
};

Coverage coverage_of(const Campaign& campaign, unsigned from, unsigned to) {
  Coverage coverage;
  const Machine nominal = with_narrow_priors(made(campaign.kind));
  const bool has_orientation = campaign.kind == MachineKind::robot6r || campaign.kind == MachineKind::hexapod;
  for (unsigned seed = from; seed < to; ++seed) {
    Random random(1000 + seed);
    const Machine truth = drawn_from_priors(nominal, random);
    Measurements all;
    add_tracker(truth, Pose{from_rpy(Vector3(0.3, -0.2, 2)), Vector3(1, -3, 0.4)},
                translation(Vector3(0.02, 0.05, 0.08)), has_orientation, 40, campaign.length, campaign.turn,
                2e-5, random, all, "tracker");
    add_pushes(truth, 12, campaign.length, campaign.turn, campaign.force, 3e-6, random, all);
    IdentifyOptions options;
    options.ladder = false;
    const Identification found = identify(nominal, all, options);
    coverage.converged += found.is_converged;
    const std::vector<Parameter> real = parameters(truth);
    for (const IdentifiedParameter& parameter : found.parameters) {
      if (parameter.is_default_prior) continue;
      const auto at = std::find_if(real.begin(), real.end(),
                                   [&](const Parameter& p) { return p.name == parameter.name; });
      coverage.parameters.add(std::abs(parameter.value - at->value) < 1.96 * parameter.sigma, 1);
    }
    for (const HeldOutGroup& group : found.held_out) {
      const int numbers = group.kind == MeasurementKind::tracker_pose    ? 6
                          : group.kind == MeasurementKind::tracker_point ? 3
                                                                         : 1;
      coverage.predictions.add(group.in_interval, static_cast<double>(group.after.count) * numbers);
    }
  }
  return coverage;
}

const std::vector<Campaign> serial_and_hexapod = {{MachineKind::mill3, 0.15, 0, 400},
                                                  {MachineKind::robot6r, 0, 0.5, 600},
                                                  {MachineKind::hexapod, 0.04, 0, 400}};
/// Its tip hardly turns, so that the probe's lever times a tilt makes the fit nonlinear.
const Campaign orthoglide{MachineKind::orthoglide, 0.06, 0, 200};

void check_coverage(const Campaign& campaign, unsigned campaigns, double least, double most) {
  const Coverage coverage = coverage_of(campaign, 0, campaigns);
  CAPTURE(static_cast<int>(campaign.kind));
  CHECK(coverage.converged == campaigns);
  CAPTURE(coverage.parameters.count);
  CHECK(coverage.parameters.value() > least);
  CHECK(coverage.parameters.value() < most);
  CAPTURE(coverage.predictions.count);
  CHECK(coverage.predictions.value() > least);
  CHECK(coverage.predictions.value() < most);
}

}  // namespace

TEST_CASE("made machines: true values and held-out rows lie in their 95 % intervals") {
  for (const Campaign& campaign : serial_and_hexapod) check_coverage(campaign, 4, 0.88, 1.0);
  check_coverage(orthoglide, 1, 0.88, 1.0);
}

TEST_SUITE("long") {
  TEST_CASE("made machines: true values and held-out rows lie in their 95 % intervals, 40 campaigns each") {
    for (const Campaign& campaign : serial_and_hexapod) check_coverage(campaign, 40, 0.93, 0.97);
    check_coverage(orthoglide, 40, 0.93, 0.97);
  }
}

TEST_CASE("twelve pushes give the tip stiffness of a KR 270 within 12 %") {
  const Machine nominal = made(MachineKind::robot6r);
  for (unsigned seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    Random random(50 + seed);
    std::vector<double> values = values_of(nominal);
    const std::vector<Parameter> all_parameters = parameters(nominal);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (all_parameters[i].kind == ParameterKind::compliance) values[i] *= uniform(random, 0.6, 1.7);
    const Machine truth = with_parameters(nominal, values);

    // Three directions at four places of a cell of 0.5 m: a load cell of 1 %, a gauge of 5 um.
    Measurements all;
    add_pushes(truth, 12, 0, 0.12, 500, 5e-6, random, all);
    for (Measurement& row : all.rows) row.states[0].F *= 1 + 0.01 * normal(random);
    IdentifyOptions options;
    options.sets = {ParameterSet::compliance};
    options.ladder = false;
    const Identification found = identify(nominal, all, options);

    const auto stiffness = [&](const Machine& machine, const CommandedState& state) {
      const Model model = prepare(machine);
      StaticsWork work(model.mechanism);
      const NominalResult at =
          nominal_forward(model, model.home, joint_values(model.mechanism.shown, state.shown));
      return *compliance_at_tip(model, at.configuration, Load{}, Stage{0, 0, 0, 0}, work);
    };
    for (int place = 0; place < 5; ++place) {
      const CommandedState state = random_state(truth, 0, 0.12, random);
      const Matrix6 real = stiffness(truth, state), by_fit = stiffness(found.machine, state);
      for (const Vector3& direction :
           {Vector3(Vector3::UnitX()), Vector3(Vector3::UnitY()), Vector3(Vector3::UnitZ())})
        CHECK(stiffness_along(by_fit, direction) ==
              doctest::Approx(stiffness_along(real, direction)).epsilon(0.12));
    }
  }
}
