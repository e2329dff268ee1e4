// The three methods: two that agree, and one that is an approximation and states it.
#include "compensation/support/judge.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Order line_by(Method method, const std::string& machine) {
  return {.machine = load_machine(machine),
          .text = "G21 G90\nG0 X-73.65 Y-73.65 Z-73.65\nG1 Y126.35 F600\nM30\n",
          .force = constant_force(milling()),
          .method = method};
}

}  // namespace

TEST_CASE("direct and nested write the same text") {
  for (const std::string& machine : {orthoglide_a, orthoglide_b, orthoglide_perfect}) {
    CAPTURE(machine);
    const std::string direct = compensated(Shop(line_by(Method::direct, machine))).text;
    CHECK(direct == compensated(Shop(line_by(Method::nested, machine))).text);
  }
}

TEST_CASE("the linear method is refused where its residual exceeds the tolerance") {
  Order order = line_by(Method::linear, orthoglide_b);
  const Compensation refused = Shop(order).run();
  REQUIRE(refused.failure);
  CHECK(refused.failure->kind == ErrorKind::not_compensated);
  CHECK(refused.failure->line == 3);
  CHECK(refused.failure->what.find("verification failed") != std::string::npos);
  order.tolerance = 10e-6;
  const Shop coarser(order);
  const Miss miss = dense_miss(coarser, compensated(coarser), 100);
  CHECK(miss.size <= 10e-6);
  CHECK(miss.size > 5e-6);
}
