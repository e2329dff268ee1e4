/// Targets of the kernel in a batch, each from the cell of its place, with the pivots that judge its
/// stability.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "bench_cases.hpp"
#include "statics/kernel/batch.hpp"
#include "statics/kernel/start_cell.hpp"

namespace counterflex::bench {
namespace {

constexpr std::size_t batch_size = 256;
constexpr double between_waypoints = 0.5e-3;  // m
constexpr double cells_of_a_length = 24;      // edge of a cell: l / 24

/// Waypoints along the line of a case, and the cells that hold them.
struct KernelCase {
  kernel::Flat flat;
  std::vector<kernel::Transform> real;
  kernel::Question question;
  std::map<std::array<long, 3>, kernel::StartCell> cells;
  std::vector<double> p, R, F;
  std::vector<const kernel::StartCell*> cell_of;
  std::string failure;

  KernelCase(const KernelCase&) = delete;
  explicit KernelCase(const Case& c) : flat(kernel::flatten(c.model, false)), failure(c.failure) {
    real = kernel::transforms_at(flat, 1);
    question.transforms = &real;
    question.target = true;
    const Vector3 begin = c.wanted.front().p, along = (c.wanted.back().p - begin).normalized();
    for (std::size_t i = 0; i < batch_size && failure.empty(); ++i)
      add(c, begin + between_waypoints * static_cast<double>(i) * along, i);
  }

  void add(const Case& c, const Vector3& place, std::size_t i) {
    const double edge = flat.machine.length / cells_of_a_length, t = static_cast<double>(i);
    std::array<long, 3> index{};
    for (std::size_t k = 0; k < 3; ++k) index[k] = std::lround(place[static_cast<Eigen::Index>(k)] / edge);
    if (!cells.contains(index)) {
      const Vector3 centre = edge * Vector3(static_cast<double>(index[0]), static_cast<double>(index[1]),
                                            static_cast<double>(index[2]));
      auto cell = kernel::make_start_cell(c.model, flat, question, centre, edge / 2);
      if (!cell) {
        failure = "a cell is not solved";
        return;
      }
      cells.emplace(index, std::move(*cell));
    }
    cell_of.push_back(&cells.at(index));
    const Matrix3 home = tip(c.model.mechanism, c.model.home).R;
    Vector6 load = milling_load().F;
    load[0] += 5 * std::sin(1.7 * t);
    load[1] += 4 * std::cos(2.3 * t);
    p.insert(p.end(), place.begin(), place.end());
    for (int k = 0; k < 9; ++k) R.push_back(home(k / 3, k % 3));
    F.insert(F.end(), load.begin(), load.end());
  }
};

void targets(benchmark::State& state, CaseOf case_of, const kernel::Instance& instance) {
  const KernelCase c(case_of());
  if (!c.failure.empty()) return state.SkipWithError(c.failure.c_str());
  std::vector<unsigned char> accepted(batch_size);
  std::vector<int> iterations(batch_size);
  std::vector<double> rho(batch_size * c.flat.machine.actuator_joint.size()), tips(12 * batch_size),
      pivots(batch_size);
  kernel::Batch batch;
  batch.count = static_cast<int>(batch_size);
  batch.p = c.p.data(), batch.R = c.R.data(), batch.F = c.F.data(), batch.cells = c.cell_of.data();
  batch.accepted = accepted.data(), batch.iterations = iterations.data();
  batch.actuators = rho.data(), batch.tip = tips.data(), batch.negative_pivots = pivots.data();
  // The first step has a tangent of its own, with the stress of the cell, and late ones.
  const kernel::Schedule schedule{.tangents = 1U | ~0U << 6, .first = kernel::FirstStress::of_cells};
  double steps = 0;
  for (auto _ : state) {
    instance.solve(c.flat.machine, c.question, schedule, batch);
    for (std::size_t i = 0; i < batch_size; ++i) {
      steps += iterations[i];
      if (accepted[i] != 0 && pivots[i] == 0) continue;
      state.SkipWithError("a waypoint is not accepted");
      return;
    }
  }
  const auto items = static_cast<double>(batch_size);
  state.counters["items"] = items;
  state.counters["steps"] = benchmark::Counter(steps / items, benchmark::Counter::kAvgIterations);
  state.SetLabel(std::to_string(instance.lanes) + " lanes");
}

int register_machine(const std::string& name, CaseOf case_of) {
  for (const kernel::Instance& instance : kernel::all_instances())
    benchmark::RegisterBenchmark((name + "/kernel_" + std::to_string(instance.lanes)).c_str(), targets,
                                 case_of, instance)
        ->Unit(benchmark::kMicrosecond);
  return 0;
}

const int registered_kernels = register_machine("orthoglide", orthoglide) +
                               register_machine("hexapod", hexapod) + register_machine("robot_6r", robot_6r) +
                               register_machine("mill", mill);

}  // namespace
}  // namespace counterflex::bench
