/// The kernels themselves: one answer whatever the instructions, and lanes that never meet.
#include <cmath>
#include <cstring>
#include <limits>

#include "lane_zone.hpp"
#include "lanes_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// One zone of a machine, and batches solved in it.
struct KernelBench {
  Model model;
  LaneModel lane_model{model, false};
  StaticsWork work{model.mechanism};
  std::shared_ptr<const LaneZone> zone;

  KernelBench(const Machine& machine, const Vector3& from_home) : model(prepare(machine)) {
    const Vector3 centre = tip(model.mechanism, model.home).p + from_home;
    zone = LaneZone::make(model, lane_model, centre, 0.02, work);
    REQUIRE(zone != nullptr);
  }
  KernelBench(const KernelBench&) = delete;

  Vector3 centre() const { return Vector3::Map(zone->flat().centre); }

  // In as many calls as there are batches; the last one's results.
  LaneMemory solve(const std::vector<std::vector<LaneRequest>>& batches, bool target,
                   lanes::Kernel kernel = lanes::best_kernel()) const {
    LaneMemory memory(lane_model, kernel);
    bool go_on = false;
    for (const auto& batch : batches) {
      for (std::size_t lane = 0; lane < lanes::width; ++lane) {
        for (int i = 0; i < 3; ++i) memory.batch.p[i][lane] = batch[lane].p[i];
        for (int i = 0; i < 6; ++i) memory.batch.F[i][lane] = batch[lane].F[i];
      }
      memory.solve(zone->flat(), {.target = target, .kinematics = false, .acting = lanes::everything, .go_on = go_on});
      go_on = true;
    }
    return memory;
  }
};

// What a lane has answered, all of it.
std::vector<double> said(const LaneMemory& memory, int lane) {
  std::vector<double> list{memory.batch.iterations[lane], static_cast<double>(memory.batch.converged[lane])};
  for (const auto& entry : memory.batch.tip) list.push_back(entry[lane]);
  for (const auto& entry : memory.batch.p) list.push_back(entry[lane]);
  for (const double entry : memory.state(lane)) list.push_back(entry);
  return list;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

std::vector<LaneRequest> lane_batch(const KernelBench& bench, Random& random, const Trial& trial) {
  std::vector<LaneRequest> batch;
  for (int lane = 0; lane < lanes::width; ++lane)
    batch.push_back({bench.centre() + random.vector(0.005), random.six(trial.force / 2, trial.moment / 2)});
  return batch;
}

template <class Check>
void for_kernel_benches(const Check& check) {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const KernelBench bench(machine_of(trial.name), trial.centre);
    Random random(21);
    for (const bool target : {false, true}) {
      CAPTURE(target);
      check(bench, target, std::vector{lane_batch(bench, random, trial), lane_batch(bench, random, trial)});
    }
  }
}

}  // namespace

TEST_CASE("all kernels that the computer has answer alike, those with fused multiply-adds to the last bit") {
  const lanes::Kernels kernels = lanes::all_kernels();
  CHECK(std::string(kernels.list[kernels.count - 1].name) == lanes::best_kernel().name);
  for_kernel_benches([&](const KernelBench& bench, bool target, const auto& batches) {
    const LaneMemory best = bench.solve(batches, target);
    for (int k = 0; k < kernels.count; ++k) {
      CAPTURE(std::string(kernels.list[k].name));
      const LaneMemory other = bench.solve(batches, target, kernels.list[k]);
      for (int lane = 0; lane < lanes::width; ++lane) {
        CHECK(other.batch.converged[lane]);
        if (k > 0) CHECK(same_bits(said(other, lane), said(best, lane)));
        for (std::size_t i = 0; i < 12; ++i) CHECK(std::abs(other.batch.tip[i][lane] - best.batch.tip[i][lane]) < 1e-11);
        for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(other.batch.p[i][lane] - best.batch.p[i][lane]) < 1e-11);
      }
    }
  });
}

TEST_CASE("lanes do not meet: an impossible neighbour changes no bit of the others") {
  for_kernel_benches([](const KernelBench& bench, bool target, const auto& batches) {
    const LaneMemory good = bench.solve(batches, target);
    const LaneRequest absurd_load{bench.centre(), Vector6::Constant(1e12)};
    const LaneRequest far_away{bench.centre() + Vector3(40, -3, 7), Vector6::Zero()};
    const LaneRequest no_place{Vector3(0, not_a_number, 0), Vector6::Zero()};
    const LaneRequest no_load{bench.centre(), Vector6::Constant(not_a_number)};
    const LaneRequest infinite{bench.centre(), Vector6::Constant(std::numeric_limits<double>::infinity())};
    int bad_lane = 1;
    for (const LaneRequest& bad : {absurd_load, far_away, no_place, no_load, infinite}) {
      auto spoilt = batches;
      spoilt[0][bad_lane] = bad;
      spoilt[1][bad_lane] = bad;
      const LaneMemory memory = bench.solve(spoilt, target);
      CAPTURE(bad_lane);
      CHECK(!memory.batch.converged[bad_lane]);
      for (int lane = 0; lane < lanes::width; ++lane)
        if (lane != bad_lane) CHECK(same_bits(said(memory, lane), said(good, lane)));
      ++bad_lane;
    }
  });
}

TEST_CASE("a lane that failed leaves nothing to its next waypoint") {
  for_kernel_benches([](const KernelBench& bench, bool target, const auto& batches) {
    auto spoilt = batches;
    for (LaneRequest& request : spoilt[0]) request.F = Vector6::Constant(1e12);
    const LaneMemory after = bench.solve(spoilt, target), fresh = bench.solve({batches[1]}, target);
    for (int lane = 0; lane < lanes::width; ++lane) CHECK(same_bits(said(after, lane), said(fresh, lane)));
  });
}

TEST_CASE("requests in another order within a batch are answered in that order, to the bit") {
  for_kernel_benches([](const KernelBench& bench, bool target, const auto& batches) {
    auto permuted = batches;
    const auto moved_to = [](int lane) { return (3 * lane + 5) % lanes::width; };
    for (std::size_t b = 0; b < batches.size(); ++b)
      for (int lane = 0; lane < lanes::width; ++lane) permuted[b][moved_to(lane)] = batches[b][lane];
    const LaneMemory before = bench.solve(batches, target), after = bench.solve(permuted, target);
    for (int lane = 0; lane < lanes::width; ++lane)
      CHECK(same_bits(said(after, moved_to(lane)), said(before, lane)));
  });
}

TEST_CASE("a state goes from the solver of single waypoints to lanes and back unchanged") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const KernelBench bench(machine_of(trial.name), trial.centre);
    const std::vector<double> state = bench.lane_model.state_of(bench.zone->reference());
    std::vector<double> other = state;
    const int standing = bench.lane_model.program().standing;  // what follows is no part of a configuration
    for (int i = 0; i < standing; ++i) other[static_cast<std::size_t>(i)] += 0.125;
    const Configuration back = bench.lane_model.configuration_of(other.data(), bench.zone->reference());
    CHECK(same_bits(bench.lane_model.state_of(back), other));
    CHECK(!same_bits(state, other));
  }
}
