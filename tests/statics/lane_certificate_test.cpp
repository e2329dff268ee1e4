/// Stability proven for several waypoints at once: what lanes say is what the same proof says of each alone.
#include "lane_strength.hpp"
#include "lanes_support.hpp"
#include "newton.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// The zone about a place and a kernel's memory to try loads in.
struct Certified {
  const LaneModel lane_model;
  StaticsWork work;
  std::unique_ptr<LaneZone> zone;
  LaneMemory memory;

  Certified(const Model& model, bool at_platform, const Vector3& p,
            lanes::Kernel kernel = lanes::best_kernel())
      : lane_model(model, at_platform),
        work(model.mechanism),
        zone(LaneZone::make(model, lane_model, p, 0.01, work)),
        memory(lane_model, kernel) {}

  std::array<bool, lanes::width> solve(const std::vector<LaneRequest>& requests, bool errors) {
    for (int lane = 0; lane < lanes::width; ++lane)
      put_in_lane(requests[static_cast<std::size_t>(lane)].p, requests[static_cast<std::size_t>(lane)].F,
                  lane, memory.batch);
    const lanes::Question question{.target = false, .kinematics = false, .acting = {errors, true}, .go_on = false};
    memory.solve(zone->flat(), question);
    return memory.stable(zone->flat(), question);
  }
};

std::vector<LaneRequest> eight_about(const Vector3& p, Random& random, const Trial& trial, double strength) {
  std::vector<LaneRequest> requests;
  for (int i = 0; i < lanes::width; ++i)
    requests.push_back(
        {p + random.vector(0.005), random.six(strength * trial.force, strength * trial.moment)});
  return requests;
}

// The proof of a single waypoint at the state that a lane has found.
bool surely_stable_alone(const Model& model, Certified& in, int lane, const Load& load, bool errors) {
  const Configuration loaded =
      in.lane_model.configuration_of(in.memory.state(lane).data(), in.zone->reference());
  evaluate_all(model, loaded, {.errors = errors ? 1.0 : 0.0}, in.work.impl());
  const AppliedWrench applied = applied_wrench(model.mechanism, loaded.X_MP, load, 1);
  return surely_stable(model.mechanism, in.work.impl().chains, applied.tangent, {model.mechanism.length});
}

template <class Check>  // void(const LaneTrial&, const Model&, const Vector3& p)
void for_lane_trials(const Check& check) {
  for (const LaneTrial& lane_trial : lane_trials()) {
    CAPTURE(lane_trial.trial.name);
    const Model model = prepare(lane_trial.machine);
    check(lane_trial, model, tip(model.mechanism, model.home).p + lane_trial.trial.centre);
  }
}

}  // namespace

TEST_CASE("lanes prove stable what is proven so alone, and nothing else, up to loads that no machine bears") {
  Random random(61);
  for_lane_trials([&](const LaneTrial& lane_trial, const Model& model, const Vector3& p) {
    Certified in(model, lane_trial.at_platform, p);
    REQUIRE(in.zone != nullptr);
    int proven = 0;
    for (const double strength : {0.1, 1.0, 10.0, 30.0, 100.0, 300.0}) {
      const bool errors = strength != 1;
      const auto requests = eight_about(p, random, lane_trial.trial, strength);
      const auto stable = in.solve(requests, errors);
      for (int lane = 0; lane < lanes::width; ++lane) {
        if (!in.memory.batch.converged[lane]) {
          CHECK(!stable[static_cast<std::size_t>(lane)]);
          continue;
        }
        const Load load{requests[static_cast<std::size_t>(lane)].F, lane_trial.at_platform};
        CHECK(stable[static_cast<std::size_t>(lane)] == surely_stable_alone(model, in, lane, load, errors));
        proven += stable[static_cast<std::size_t>(lane)];
      }
    }
    CHECK(proven >= 8);
  });
}

TEST_CASE("all lane kernels prove the same") {
  Random random(67);
  for_lane_trials([&](const LaneTrial& lane_trial, const Model& model, const Vector3& p) {
    const auto requests = eight_about(p, random, lane_trial.trial, 10);
    const auto expected = Certified(model, lane_trial.at_platform, p).solve(requests, true);
    const lanes::Kernels kernels = lanes::all_kernels();
    for (int i = 0; i < kernels.count; ++i)
      CHECK(Certified(model, lane_trial.at_platform, p, kernels.list[i]).solve(requests, true) == expected);
  });
}

TEST_CASE("the corners of loads hold every force with every moment, a quarter further out") {
  Random random(71);
  for (const double moment : {0.0, 3.0}) {
    const auto corners = corners_of_loads(7, moment, false);
    CHECK(corners.size() == (moment > 0 ? 12 : 6));
    for (int i = 0; i < 100; ++i) {
      Vector6 F = random.six(1, 1);
      F.head<3>() *= 7 / F.head<3>().norm();
      F.tail<3>() *= moment / F.tail<3>().norm();
      double share = 0;  // of the corners that make up the load: at most 1 / 1.25
      for (int axis = 0; axis < (moment > 0 ? 6 : 3); ++axis)
        share += std::abs(F[axis]) / corners[static_cast<std::size_t>(2 * axis)].F[axis];
      CHECK(share <= 0.8 + 1e-12);
    }
  }
}
