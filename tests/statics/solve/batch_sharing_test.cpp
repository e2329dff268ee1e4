/// An answer depends on its request alone. Requests without a meaning do not change others.
#include <cstring>
#include <limits>
#include <thread>

#include "statics/support/batch_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

bool same_answers(const std::vector<BatchAnswer>& a, const std::vector<BatchAnswer>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const BatchAnswer& x, const BatchAnswer& y) {
    return x.solved == y.solved && x.iterations == y.iterations && x.command.p == y.command.p &&
           x.command.R == y.command.R && x.X_MT.p == y.X_MT.p && x.X_MT.R == y.X_MT.R;
  });
}

const Trial& orthoglide_trial() {
  static const Trial trial = controlled_machines()[1];
  return trial;
}

// Waypoints beside each other, then a jump, then more.
std::vector<BatchRequest> some_path(const BatchBench& bench, unsigned seed) {
  Random random(seed);
  std::vector<BatchRequest> path;
  for (int part = 0; part < 2; ++part)
    for (const BatchRequest& request : cluster(bench, orthoglide_trial(), random, 20, 0.004, 0.5))
      path.push_back(request);
  return path;
}

bool all_solved(const std::vector<BatchAnswer>& answers) {
  return std::all_of(answers.begin(), answers.end(), [](const BatchAnswer& answer) { return answer.solved; });
}

}  // namespace

TEST_CASE("batches: an answer has the same bits in any batch, in any order, and alone") {
  const Machine machine = machine_of("orthoglide_case_b");
  BatchBench fresh(machine), used(machine);
  const auto path = some_path(fresh, 43);
  const auto expected = fresh.solve(BatchQuestion::target, whole, path);
  CHECK(all_solved(expected));
  used.solve(BatchQuestion::forward, without_errors, some_path(used, 44));
  used.solve(BatchQuestion::target, whole, {path.rbegin(), path.rend()});
  CHECK(same_answers(used.solve(BatchQuestion::target, whole, path), expected));
  CHECK(same_answers(used.solve(BatchQuestion::target, whole, path), expected));
  for (const BatchQuestion question : {BatchQuestion::target, BatchQuestion::forward}) {
    const auto together = fresh.solve(question, whole, path);
    auto backwards = fresh.solve(question, whole, {path.rbegin(), path.rend()});
    std::reverse(backwards.begin(), backwards.end());
    CHECK(same_answers(backwards, together));
    for (std::size_t i = 0; i < path.size(); i += 7)
      CHECK(same_answers(fresh.solve(question, whole, {path[i]}), {together[i]}));
  }
}

TEST_CASE("batches: a cell that was forgotten is made again with the same bits") {
  BatchBench bench(machine_of("orthoglide_case_b"));
  const auto path = some_path(bench, 53);
  const auto expected = bench.solve(BatchQuestion::target, whole, path);
  CHECK(all_solved(expected));
  const double cell = bench.model.mechanism.length / 24;  // one place in each
  int known = 0;
  for (int i = 0; i < 1728; ++i)  // more cells than are kept
    known += bench.solver.nominal_near(bench.home().p +
                                       cell * Vector3(i % 12 - 4, i / 12 % 12 - 4, i / 144 - 4)) != nullptr;
  CHECK(known > 1500);
  CHECK(same_answers(bench.solve(BatchQuestion::target, whole, path), expected));
}

TEST_CASE("batches: threads that share a table get the answers of one thread") {
  const Machine machine = machine_of("orthoglide_case_b");
  BatchBench alone(machine), shared(machine);
  const auto path = some_path(alone, 47);
  const auto expected = alone.solve(BatchQuestion::forward, whole, path);
  std::vector<std::vector<BatchAnswer>> got(2, std::vector<BatchAnswer>(path.size()));
  std::vector<std::thread> threads;
  for (auto& answers : got)
    threads.emplace_back([&] {
      BatchSolver solver(shared.table);
      solver.solve(BatchQuestion::forward, whole, path, answers);
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& answers : got) CHECK(same_answers(answers, expected));
}

TEST_CASE("batches: one table serves a model and a place of loads, for the whole run") {
  const Model model = model_of("orthoglide_case_b"), other = model_of("orthoglide_case_a");
  const StartTables machines;
  const StartTable* first = &machines.of(model, false);
  CHECK(&machines.of(other, false) != first);
  CHECK(&machines.of(model, true) != first);
  CHECK(&machines.of(model, false) == first);
}

TEST_CASE(
    "batches: a request that is not a number, too far or too heavily loaded is not solved; its neighbours "
    "are") {
  BatchBench bench(machine_of("orthoglide_case_b"));
  constexpr double infinity = std::numeric_limits<double>::infinity(),
                   nan = std::numeric_limits<double>::quiet_NaN();
  const Vector3 p = bench.home().p;
  const Vector6 none = Vector6::Zero();
  const std::vector<BatchRequest> bad{{Vector3(nan, 0, 0), none},       {Vector3(0, 1e300, 0), none},
                                      {Vector3(0, 0, -infinity), none}, {p, Vector6::Constant(nan)},
                                      {p, Vector6::Constant(infinity)}, {p, Vector6::Constant(1e300)},
                                      {p, Vector6::Constant(1e9)}};
  for (const BatchQuestion question : {BatchQuestion::forward, BatchQuestion::target})
    for (const BatchRequest& request : bad) {
      CAPTURE(request.at.p);
      CAPTURE(request.F);
      const auto answers = bench.solve(question, whole, {{p, none}, request, {p, 10 * unit(1)}});
      CHECK(answers[0].solved);
      CHECK(!answers[1].solved);
      CHECK(answers[2].solved);
      CHECK(!bench.solver.joins(p, Vector3(nan, 0, 0)));
    }
}

TEST_CASE("batches: a short straight way joins its ends, a long one is left to be followed") {
  BatchBench bench(machine_of("orthoglide_case_b"));
  const Vector3 home = bench.home().p, near = home + Vector3(0.002, 0, 0), far = home + Vector3(0.9, 0, 0);
  CHECK(bench.solver.joins(home, near));
  CHECK(bench.solver.joins(near, home));
  CHECK(!bench.solver.joins(home, home + Vector3(0.1, 0.1, 0.1)));
  CHECK(!bench.solver.joins(home, far));
  CHECK(!bench.solver.joins(far, home));
}
