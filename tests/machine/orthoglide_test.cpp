/// The paper's Orthoglide as the machine file describes it.
#include <doctest/doctest.h>

#include <Eigen/LU>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

const Machine& orthoglide() {
  static const Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/tests/machine/data/orthoglide.toml");
  return machine;
}

}  // namespace

TEST_CASE("the Orthoglide has three chains, each of base, leg and platform transform") {
  const Machine& machine = orthoglide();
  CHECK(machine.name == "Orthoglide");
  REQUIRE(machine.chains.size() == 3);
  CHECK(machine.chains[0].name == "x");
  CHECK(machine.chains[0].elements.size() == 9);
  CHECK(machine.chains[1].elements.size() == 11);
  CHECK(machine.chains[2].name == "z");
  CHECK(machine.controlled == std::vector{Component::x, Component::y, Component::z});
  REQUIRE(machine.home_X_MP.has_value());
  CHECK(machine.home_X_MP->p.isZero(0));
  CHECK(machine.max_correction == doctest::Approx(5e-3));
}

TEST_CASE("the Orthoglide's chains have the order of the template, in metres") {
  const Chain& x = orthoglide().chains[0];
  CHECK((part<Rigid>(x, 0).X.p - Vector3(-0.35545, -0.1104, 0)).norm() < 1e-16);
  CHECK(part<AssemblyError>(x, 1).name == "mount");
  CHECK(part<Actuator>(x, 2).joint.kind == JointKind::prismatic);
  CHECK(part<Actuator>(x, 2).min == doctest::Approx(-0.12));
  CHECK(part<Actuator>(x, 2).max == doctest::Approx(0.26));
  CHECK(part<Spring>(x, 4).name == "foot");
  CHECK(part<Passive>(x, 5).joint.axis == Vector3::UnitZ());
  CHECK(part<Passive>(x, 5).stiffness == 0);
  const Group& group = part<Group>(x, 6);
  REQUIRE(group.branches.size() == 2);
  CHECK(group.branches[0].name == "upper_bar");
  CHECK(part<Rigid>(group.branches[1], 0).X.p[2] == doctest::Approx(-0.04));
  CHECK(part<Spring>(group.branches[1], 3).name == "bar");
}

TEST_CASE("the Orthoglide's base and platform transforms turn the axes in a cycle and back") {
  const Chain& y = orthoglide().chains[1];
  const Matrix3 base = part<Rigid>(y, 0).X.R;
  CHECK((base * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-15);
  CHECK((base * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-15);
  CHECK((part<Rigid>(y, 10).X.R * base - Matrix3::Identity()).norm() < 1e-15);
}

TEST_CASE("the Orthoglide has one actuator a chain, six passive joints and three springs") {
  CHECK(actuators(orthoglide()).size() == 3);
  for (const Chain& chain : orthoglide().chains) {
    const Freedoms count = freedoms(chain);
    CHECK(count.actuators == 1);
    CHECK(count.passives == 6);
    CHECK(count.elastic == 18);
  }
}

TEST_CASE("the foot's stiffness inverts its compliance and is exactly symmetric") {
  const Matrix6& K = part<Spring>(orthoglide().chains[0], 4).K;
  CHECK(K == K.transpose());
  const Matrix6 C = K.inverse();
  CHECK(C(0, 0) == doctest::Approx(0.2627e-6).epsilon(1e-9));
  CHECK(C(2, 4) == doctest::Approx(-22.2355e-6).epsilon(1e-9));
  CHECK(C(5, 5) == doctest::Approx(224.9360e-6).epsilon(1e-9));
}
