// What waypoints state: deviations and where they come from, datums, orientations, threads.
#include <fmt/format.h>

#include "compensation/support/judge.hpp"
#include "counterflex/compensation/loads_along.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const part = "G21 G90\nG0 X-60. Y-60. Z-60.\nG1 Y60. F600\nX40. Z-40.\nG0 Z20.\nM30\n";

std::string many_cuts(int count) {
  std::string program = "G21 G90\nG0 X10. Y10. Z0.\nG1 F500\n";
  for (int i = 0; i < count; ++i)
    program += fmt::format("G1 X{:.3f} Y{:.3f} Z{:.2f}\n", 40 * std::cos(0.37 * i), 30 * std::sin(0.53 * i),
                           0.1 * i);
  return program + "M30\n";
}

Vector6 cold_deviation(const Shop& shop, const Vector3& target, const Vector3& wanted, const Vector6& F,
                       const Stage& stage) {
  Vector6 d = Vector6::Zero();
  d.head<3>() = cold_tip(shop, target, F, stage) - wanted;
  return d;
}

std::vector<LoadPlace> places_of(const Shop& shop, const std::vector<Waypoint>& waypoints) {
  LoadPlaces places;
  places.add(shop.job(), waypoints);
  return places.places();
}

bool same(const Waypoint& a, const Waypoint& b) {
  return a.segment == b.segment && a.fraction == b.fraction && a.after == b.after && a.before == b.before &&
         a.correction == b.correction && a.causes.has_value() == b.causes.has_value() &&
         (!a.causes || a.causes->air == b.causes->air) && (!knows_before(a) || a.causes) &&
         a.iterations == b.iterations && a.weight == b.weight;
}

}  // namespace

TEST_CASE("geometry, load, superposition and air are those of independent solves") {
  for (const std::string& file : {orthoglide_b, mill}) {
    CAPTURE(file);
    Order order{.machine = load_machine(file), .text = part, .force = constant_force(milling())};
    if (file == mill) order.X_MW.p = Vector3(150, 100, -240) * mm;
    const Shop shop(order);
    double largest = 0;
    for (const Waypoint& w : compensated(shop, true).waypoints) {
      if (w.between) continue;
      const Vector3 emitted = w.p_MT + w.correction.head<3>();
      const auto near = [&](const Vector6& said, const Vector3& target, const Vector6& F,
                            const Stage& stage) {
        return (said - cold_deviation(shop, target, w.p_MT, F, stage)).head<3>().norm() < 1e-9;
      };
      CHECK(near(w.before, w.p_MT, w.wrench, {}));
      CHECK(near(w.after, emitted, w.wrench, {}));
      CHECK(near(w.causes->geometry, w.p_MT, Vector6::Zero(), {1, 0, 1, 0}));
      CHECK(near(w.causes->load, w.p_MT, w.wrench, {0, 1, 1, 0}));
      CHECK(near(w.causes->air, emitted, Vector6::Zero(), {1, 0, 1, 1}));
      CHECK(w.causes->gravity == Vector6(Vector6::Zero()));
      CHECK((w.causes->superposition - w.causes->geometry - w.causes->load).norm() < 1e-12);
      largest = std::max(largest, (w.causes->superposition - w.before).head<3>().norm());
    }
    // Errors and loads add up but for a little, and not exactly.
    CHECK(largest > 1e-9);
    CHECK(largest < 0.1e-3);
  }
}

TEST_CASE("weights are a source of their own, and the three add up to all acting together, to second order") {
  Order order{.machine = load_machine(orthoglide_b), .text = part, .force = constant_force(milling())};
  order.machine.gravity.g = Vector3(1, -2, -9);
  for (Chain& chain : order.machine.chains) chain.elements.push_back(PointMass{3, Vector3(0, 0, 0.05)});
  const Shop shop(order);
  double largest = 0;
  for (const Waypoint& w : compensated(shop, true).waypoints) {
    if (w.between) continue;
    const auto cold = [&](const Vector3& target, const Vector6& F, const Stage& stage) {
      return cold_deviation(shop, target, w.p_MT, F, stage);
    };
    const Vector6 none = Vector6::Zero(), preloads = cold(w.p_MT, none, {0, 0, 1, 0});
    const auto near = [](const Vector6& a, const Vector6& b) { return (a - b).head<3>().norm() < 1e-9; };
    CHECK(near(w.causes->geometry, cold(w.p_MT, none, {1, 0, 1, 0})));
    CHECK(near(w.causes->load, cold(w.p_MT, w.wrench, {0, 1, 1, 0})));
    CHECK(near(w.causes->gravity, cold(w.p_MT, none, {0, 0, 1, 1})));
    CHECK(near(w.causes->superposition,
               w.causes->geometry + w.causes->load + w.causes->gravity - 2 * preloads));
    CHECK(near(w.causes->air, cold(w.p_MT + w.correction.head<3>(), none, {})));
    CHECK(w.causes->gravity.head<3>().norm() > 10e-6);
    const double miss = (w.causes->superposition - w.before).head<3>().norm();
    CHECK(miss < 0.2 * w.causes->gravity.head<3>().norm());
    largest = std::max(largest, miss);
  }
  CHECK(largest > 1e-9);
}

TEST_CASE("with preloads each source is what it adds to them, and the superposition is the sum of all") {
  Order order{.machine = load_machine(orthoglide_b), .text = part, .force = constant_force(milling())};
  for (Chain& chain : order.machine.chains)
    for (Element& element : chain.elements)
      if (auto* spring = std::get_if<Spring>(&element)) spring->theta_0.head<3>() = Vector3(2e-3, 0, 1e-3);
  const Shop shop(order);
  for (const Waypoint& w : compensated(shop, true).waypoints) {
    if (w.between) continue;
    const auto cold = [&](const Vector6& F, const Stage& stage) {
      return cold_deviation(shop, w.p_MT, w.p_MT, F, stage);
    };
    const auto near = [](const Vector6& a, const Vector6& b) { return (a - b).head<3>().norm() < 1e-9; };
    const Vector6 none = Vector6::Zero();
    const Causes& causes = *w.causes;
    const Vector6 preloads = cold(none, {0, 0, 1, 0});
    CHECK(near(causes.geometry + preloads, cold(none, {1, 0, 1, 0})));
    CHECK(near(causes.load + preloads, cold(w.wrench, {0, 1, 1, 0})));
    CHECK(near(causes.superposition, causes.geometry + causes.load + preloads));
    CHECK(preloads.head<3>().norm() > 0.5e-3);
    if (w.wrench.isZero(0)) CHECK(causes.load.norm() < 1e-9);  // the preloads are not the cutting force's
  }
}

TEST_CASE("gravity without masses, and masses without gravity, are not a source") {
  Machine machine = load_machine(mill);
  machine.gravity.g = Vector3(0, 0, -9.81);
  CHECK_FALSE(has_weight(compile(machine)));
  machine.chains[0].elements.push_back(PointMass{20, Vector3::Zero()});
  CHECK(has_weight(compile(machine)));
  machine.gravity.g.setZero();
  CHECK_FALSE(has_weight(compile(machine)));
}

TEST_CASE("a force 30 % higher or lower leaves 30 % of what the force does, to first order") {
  Order order{.machine = load_machine(mill), .text = part, .force = constant_force(milling())};
  order.X_MW.p = Vector3(150, 100, -240) * mm;
  const Shop shop(order);
  const std::vector<LoadPlace> places = places_of(shop, compensated(shop, true).waypoints);
  const std::vector<OtherForce> higher = solve_other_force(places, 1.3, 1),
                                lower = solve_other_force(places, 0.7, 1);
  int under_force = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Waypoint& w = places[i].at;
    if (!w.causes) continue;
    const Vector6 share = 0.3 * w.causes->load;
    CHECK((higher[i].deviation - w.after - share).head<3>().norm() <= 0.01 * share.head<3>().norm() + 1e-12);
    CHECK((lower[i].deviation - w.after + share).head<3>().norm() <= 0.01 * share.head<3>().norm() + 1e-12);
    CHECK((w.wrench.isZero(0) ? higher[i].deviation == w.after : w.causes->load.head<3>().norm() > 0.1e-6));
    under_force += !w.wrench.isZero(0);
  }
  CHECK(under_force > 2);
}

TEST_CASE("what more and less force do, between the ends of pieces too, is that of independent solves") {
  for (const std::string& file : {orthoglide_b, mill}) {
    CAPTURE(file);
    Order order{.machine = load_machine(file), .text = part, .force = constant_force(milling())};
    if (file == mill) order.X_MW.p = Vector3(150, 100, -240) * mm;
    const Shop shop(order);
    const std::vector<LoadPlace> places = places_of(shop, compensated(shop, true).waypoints);
    const bool between = std::ranges::any_of(places, [](const LoadPlace& place) { return place.at.between; });
    CHECK(between);
    for (const double factor : {1.3, 0.7}) {
      const std::vector<OtherForce> others = solve_other_force(places, factor, 1);
      REQUIRE(others.size() == places.size());
      for (std::size_t i = 0; i < places.size(); ++i) {
        const LoadPlace& place = places[i];
        REQUIRE(others[i].status == Status::converged);
        const Vector6 expected =
            cold_deviation(shop, place.target, place.at.p_MT, factor * place.at.wrench, {});
        CHECK((others[i].deviation - expected).head<3>().norm() < 1e-9);
      }
    }
  }
}

TEST_CASE("a force under which the machine would buckle is not a failure while it does not act") {
  // A strut that buckles at 5000 N.
  Order order{.machine = load_machine(strut), .text = "G21 G90\nG0 X400. Y0. Z0.\nG1 X410. F100\nM30\n"};
  order.max_correction = 1;
  order.tolerance = 1e-3;
  order.force = constant_force((Vector6() << -4500, 0, 0, 0, 0, 0).finished());
  const Shop shop(order);
  const std::vector<LoadPlace> places = places_of(shop, compensated(shop, true).waypoints);
  CHECK(solve_other_force(places, 1.3, 1).back().status == Status::unstable);
  CHECK(solve_other_force(places, 0.7, 1).back().status == Status::converged);
  order.force = constant_force((Vector6() << -5850, 0, 0, 0, 0, 0).finished());
  CHECK(Shop(order).run().failure);
}

TEST_CASE(
    "at the point where a datum was touched off the correction is zero, elsewhere it is relative to it") {
  const Machine machine = load_machine(orthoglide_b);
  const std::string text = "G21 G90\nG0 X20. Y-40. Z10.\nG0 X60.\nG1 Y40. F300\nM30\n";
  const Vector3 touched = Vector3(20, -40, 10) * mm;
  const Shop plain({.machine = machine, .text = text});
  const Vector3 shift = cold_tip(plain, touched, Vector6::Zero()) - touched;
  REQUIRE(shift.norm() > 0.1e-3);
  const Shop shop({.machine = machine, .text = text, .datum_shift = shift});
  const Compensation result = compensated(shop);
  CHECK(lines_of(result.text)[1] == "G0 X20. Y-40. Z10.");
  CHECK(result.waypoints.front().before.norm() > 0);
  CHECK(result.waypoints.front().before.head<3>().norm() < 1e-9);
  CHECK(dense_miss(shop, result, 50).size <= 5e-6);
  for (const Waypoint& w : result.waypoints)
    CHECK((cold_tip(shop, w.p_MT - shift + w.correction.head<3>(), Vector6::Zero()) - w.p_MT -
           w.after.head<3>())
              .norm() < 1e-9);
}

TEST_CASE("the shift of a datum that was touched off is in the geometry, not in load, gravity or preloads") {
  Order order{.machine = load_machine(orthoglide_b), .text = part, .force = constant_force(milling())};
  order.machine.gravity.g = Vector3(1, -2, -9);
  for (Chain& chain : order.machine.chains) chain.elements.push_back(PointMass{3, Vector3(0, 0, 0.05)});
  const Shop plain(order);
  order.datum_shift = Vector3(0.3, -0.2, 1.1) * mm;
  const Shop touched(order);
  const auto ends = [](const Shop& shop) {
    std::vector<Waypoint> list = compensated(shop, true).waypoints;
    std::erase_if(list, [](const Waypoint& w) { return w.between || w.fraction != 1; });
    return list;
  };
  const std::vector<Waypoint> without = ends(plain), with = ends(touched);
  REQUIRE(without.size() == with.size());
  REQUIRE(with.size() > 2);
  for (std::size_t i = 0; i < with.size(); ++i) {
    const Causes &a = *without[i].causes, &b = *with[i].causes;
    const auto same = [](const Vector6& x, const Vector6& y) { return (x - y).head<3>().norm() < 1e-11; };
    CHECK(same(a.load, b.load));
    CHECK(same(a.gravity, b.gravity));
    Vector6 shift = Vector6::Zero();
    shift.head<3>() = order.datum_shift;
    CHECK(same(a.geometry - shift, b.geometry));
    CHECK(same(a.superposition - shift, b.superposition));
    CHECK(same(without[i].before - shift, with[i].before));
    CHECK((b.superposition - b.geometry - b.load - b.gravity).norm() < 1e-9);  // without preloads
  }
}

TEST_CASE("bytes and waypoints do not depend on the number of threads" * doctest::test_suite("long")) {
  const auto same_as_one = [](double blend, int threads, bool in_batches, int cuts) {
    Order order{.machine = load_machine(orthoglide_b),
                .text = many_cuts(cuts),
                .force = constant_force(milling(), blend),
                .in_batches = in_batches};
    const Compensation one = compensated(Shop(order), true);
    order.threads = threads;
    const Compensation other = compensated(Shop(order), true);
    CHECK(one.text == other.text);
    REQUIRE(one.waypoints.size() == other.waypoints.size());
    for (std::size_t i = 0; i < one.waypoints.size(); ++i) CHECK(same(one.waypoints[i], other.waypoints[i]));
  };
  same_as_one(2e-3, 2, true, 150);
  same_as_one(0, 3, true, 150);
  same_as_one(2e-3, 3, false, 40);
}

TEST_CASE("the failure that is named does not depend on the number of threads") {
  Order order{
      .machine = load_machine(orthoglide_b), .text = many_cuts(150), .force = constant_force(milling())};
  order.max_correction = 0.2e-3;
  const auto one = Shop(order).run().failure;
  REQUIRE(one);
  for (const int threads : {2, 3}) {
    order.threads = threads;
    const auto other = Shop(order).run().failure;
    REQUIRE(other);
    CHECK(other->line == one->line);
    CHECK(other->what == one->what);
  }
}

TEST_CASE(
    "a machine that controls six components is compensated in position by a program that states no more") {
  struct Where {
    std::string machine, text;
  };
  for (const Where& where :
       {Where{hexapod, "G21 G90\nG0 X0. Y0. Z870.\nG1 X60. F600\nG1 Y80. Z900.\nG0 X0.\nM30\n"},
        Where{robot, "G21 G90\nG0 X1800. Y-100. Z900.\nG1 Y150. F600\nG1 X1850. Z950.\nG0 Y0.\nM30\n"}}) {
    CAPTURE(where.machine);
    const Shop shop({.machine = load_machine(where.machine),
                     .text = where.text,
                     .force = constant_force((Vector6() << 300, -200, 100, 0, 0, 0).finished())});
    const Compensation result = compensated(shop);
    CHECK(dense_miss(shop, result, 20).size <= 5e-6);
    double before = 0, turned = 0;
    for (const Waypoint& w : result.waypoints) {
      before = std::max(before, w.before.head<3>().norm());
      turned = std::max(turned, w.after.tail<3>().norm());
      CHECK(w.correction.tail<3>().norm() == 0);
    }
    CHECK(before > 50e-6);
    CHECK(turned > 1e-6);
  }
}

TEST_CASE("the pieces of the original cover its feed moves once, cut where the force has corners") {
  const Shop shop({.machine = load_machine(orthoglide_b), .text = part, .force = constant_force(milling())});
  double length = 0, u = 1;
  bool corner = false;
  for (const Piece& piece : original_pieces(shop.job())) {
    if (piece.segment == no_segment) continue;  // the first position
    const Segment& segment = shop.path.segments[piece.segment];
    CHECK(piece.end_only == !segment.cutting);
    if (!segment.cutting) continue;
    CHECK(piece.u0 == (u == 1 ? 0 : u));
    u = piece.u1;
    const double size = (piece.commanded.end - piece.commanded.start).norm();
    CHECK(size <= 5e-3 + 1e-12);
    length += size;
    corner = corner || std::abs(piece.u1 - 2.0 / 120) < 1e-9;
  }
  CHECK(length == doctest::Approx(shop.path.segments.back().s_end));
  CHECK(corner);
}
