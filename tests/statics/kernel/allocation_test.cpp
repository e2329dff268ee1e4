/// What a solver takes from the heap once its workspace exists: nothing. The linker gives every call of
/// malloc from the project's and Eigen's code to the counter below; operator new goes through it too.
#include <cstdlib>
#include <memory>
#include <new>

#include "counterflex/statics/chain.hpp"
#include "statics/support/laws_weights.hpp"

namespace {
long allocations = 0;
}

extern "C" {
void* __real_malloc(std::size_t size);
void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

using namespace counterflex;
using namespace counterflex::laws;

TEST_CASE("the counter of allocations sees new, and matrices made inside the library") {
  const Model model = model_of("arm");
  StaticsWork work(model.mechanism);
  long before = allocations;
  const auto number = std::make_unique<std::vector<int>>(100);
  CHECK(allocations == before + 2);
  before = allocations;
  CHECK(chain_jacobian(model, 0, model.home.chains[0], {}, work).cols() == 2);
  CHECK(allocations > before);
}

TEST_CASE("solving a chain allocates nothing once its workspace exists") {
  std::vector<Trial> trials = controlled_machines();
  trials.push_back({"laws_mixed with weights", 0.03, 0.06, 150, 8});
  for (const Trial& trial : trials) {
    CAPTURE(trial.name);
    const Model model = trial.name.ends_with("weights") ? heavy_model_of("laws_mixed") : model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(41);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    for (const ChainMethod method : {ChainMethod::newton, ChainMethod::paper}) {
      for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
        CAPTURE(i);
        SeriesState state = nominal.chains[i];
        const Pose X = moved(chain_end(model, i, state, {}, work), random.six(1e-4, 1e-3));
        const long before = allocations;
        const auto result = solve_chain(model, i, X, {}, method, state, work);
        const long after = allocations;
        CHECK(result.status == Status::converged);
        CHECK(result.iterations > 1);
        CHECK(after == before);
      }
    }
  }
}
