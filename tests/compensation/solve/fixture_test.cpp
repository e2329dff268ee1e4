// A part that deflects with its fixture, and a machine that is warm.
#include "counterflex/statics/fixture.hpp"

#include "compensation/support/arm.hpp"
#include "compensation/support/judge.hpp"
#include "counterflex/machine/machine.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const cuts = "G21 G90\nG0 X-60. Y-60. Z-60.\nG1 Y60. F600\nX40. Z-40.\nG0 Z20.\nM30\n";

Fixture soft_fixture() {
  Fixture fixture;
  fixture.X_MF = {from_rpy(Vector3(0.1, -0.2, 0.4)), Vector3(0.02, -0.03, -0.15)};
  fixture.C.diagonal() << 1 / 8e6, 1 / 12e6, 1 / 30e6, 1 / 2e5, 1 / 3e5, 1 / 6e5;
  fixture.C(0, 4) = fixture.C(4, 0) = 3e-7;
  return fixture;
}

Order order_of(const std::string& file, bool with_fixture) {
  Order order{.machine = load_machine(file), .text = cuts, .force = constant_force(milling())};
  if (file == mill) order.X_MW.p = Vector3(150, 100, -240) * mm;
  if (with_fixture) order.machine.fixture = soft_fixture();
  return order;
}

/// Where a tip of M is on the part that deflects under `F` at it, by one fixed point from nothing.
Vector3 on_part(const Vector3& p_MT, const Vector6& F) {
  Vector3 place = p_MT;
  for (int i = 0; i < 5; ++i) place = inverse(deflected_part(soft_fixture(), F, place)) * p_MT;
  return place;
}

}  // namespace

TEST_CASE("a fixture deflects by its compliance and the wrench of the cut on it") {
  Fixture fixture;
  fixture.X_MF.p = Vector3(0, 0, -0.1);
  fixture.C(0, 0) = 1e-7;                                          // m/N
  fixture.C(4, 4) = 2e-6;                                          // rad/(N m)
  const Vector6 F = (Vector6() << 100, 0, 0, 0, 0, 0).finished();  // on the tool; the part gets -100 N
  const Vector3 cut(0, 0, 0.2);
  const Vector3 moved = deflected_part(fixture, F, cut) * cut - cut;
  // 30 N m about y turn the part by 60 urad, 0.3 m below the cut.
  CHECK(moved.x() / (-100 * 1e-7 - 0.3 * 0.3 * 100 * 2e-6) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("deviations with a fixture are those of cold solves against the deflected part") {
  for (const std::string& file : {orthoglide_b, mill, robot}) {
    for (const bool in_batches : {true, false}) {
      CAPTURE(file);
      CAPTURE(in_batches);
      Order order = order_of(file, true);
      if (file == robot) order.X_MW.p = Vector3(1.9, 0, 1.1);
      order.in_batches = in_batches;
      const Shop shop(order);
      double largest = 0;
      for (const Waypoint& w : compensated(shop, true).waypoints) {
        if (w.between) continue;
        const auto relative = [&](const Vector3& target) {
          return Vector3(on_part(cold_tip(shop, target, w.wrench), w.wrench) - w.p_MT);
        };
        CHECK((w.before.head<3>() - relative(w.p_MT)).norm() < 1e-9);
        CHECK((w.after.head<3>() - relative(w.p_MT + w.correction.head<3>())).norm() < 1e-9);
        CHECK(w.after.head<3>().norm() < 1e-6);  // the text has three decimals
        largest = std::max(largest, w.causes->fixture.head<3>().norm());
      }
      CHECK(largest > 30e-6);
    }
  }
}

TEST_CASE("the fixture is a cause of its own, and the others are those of the machine without it") {
  const Shop with(order_of(mill, true)), without(order_of(mill, false));
  const Compensation a = compensated(with, true), b = compensated(without, true);
  const auto places = [](const Compensation& of) {
    std::vector<Waypoint> list;
    for (const Waypoint& w : of.waypoints)
      if (w.place && !w.between) list.push_back(w);
    return list;
  };
  const std::vector<Waypoint> soft = places(a), stiff = places(b);
  REQUIRE(soft.size() == stiff.size());
  for (std::size_t i = 0; i < soft.size(); ++i) {
    const Causes &s = *soft[i].causes, &r = *stiff[i].causes;
    const auto near = [](const Vector6& x, const Vector6& y) { return (x - y).head<3>().norm() < 2e-8; };
    CHECK(near(s.geometry, r.geometry));
    CHECK(near(s.load, r.load));
    CHECK(near(s.superposition, s.geometry + s.load + s.fixture));
    CHECK(near(soft[i].before, stiff[i].before + s.fixture));
    CHECK(r.fixture.isZero(0));
  }
}

TEST_CASE("a program that turns the tool is corrected against a part that turns") {
  Order order{.machine = arm_machine(),
              .text =
                  "G21 G90 G94\nG0 X-20 Y-10 Z40 A0 B0 C0\nG1 Z0 F500\nX100 A12 B-8\nX140 Y60 A-10 B10 C40\n"
                  "G0 Z40\nM30\n"};
  order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  order.X_MW = translation(Vector3(1.75, 0.05, 0.6));
  order.read.dialect = "linuxcnc";
  order.read.tool_orientation = true;
  order.machine.fixture = soft_fixture();
  const Arm arm;
  for (const Waypoint& w : compensated(Shop(order)).waypoints) {
    REQUIRE(w.R_MT);
    const Matrix4 X =
        arm.tip(homogeneous(w.p_MT + w.correction.head<3>(), *commanded_orientation(w)), w.wrench);
    const Pose X_MT{X.topLeftCorner<3, 3>(), X.topRightCorner<3, 1>()};
    const Vector3 place = on_part(X_MT.p, w.wrench);
    const Pose relative = inverse(deflected_part(soft_fixture(), w.wrench, place)) * X_MT;
    CHECK((relative.p - w.p_MT - w.after.head<3>()).norm() < 1e-9);
    CHECK((rotation_between(relative.R, *w.R_MT) - w.after.tail<3>()).norm() < 1e-8);
    CHECK(w.after.head<3>().norm() < 5e-6);
  }
}

TEST_CASE(
    "a warm machine is off by its shift and by its spindle, on serial and parallel machines, and is "
    "corrected") {
  for (const std::string& file : {orthoglide_perfect, hexapod, mill}) {
    CAPTURE(file);
    Order order{.machine = perfect(load_machine(file)),
                .text = "G21 G90\nG0 X-10. Y-10. Z0.\nG1 Y10. F600\nX5. Z5.\nM30\n"};
    if (file == mill) order.X_MW.p = Vector3(150, 100, -240) * mm;
    if (file == hexapod) order.X_MW.p = prepare(order.machine).home.X_MP.p;
    ThermalTable table;
    table.temperatures = {20, 30};
    table.shift = {Vector3::Zero(), Vector3(20e-6, -10e-6, 30e-6)};
    table.growth = {0, 40e-6};
    order.machine.thermal = table;
    order.machine = at_temperature(order.machine, 25);
    const Shop shop(order);
    const Vector3 axis = tip(shop.model.mechanism, shop.model.home).R.col(2),
                  expected = Vector3(10e-6, -5e-6, 15e-6) - 20e-6 * axis;
    for (const Waypoint& w : compensated(shop, true).waypoints) {
      if (w.between) continue;
      CHECK((w.before.head<3>() - expected).norm() < 1e-9);
      CHECK((w.causes->geometry - w.before).norm() < 1e-9);
      CHECK(w.after.head<3>().norm() < 1e-6);
    }
  }
}
