// A robot on a rail: the program commands the rail, which stays along the program.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Geometry>

#include "compensation/support/shop.hpp"
#include "counterflex/machine/program_axes.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string path =
    "DEF part( )\n$VEL.CP=0.025\n"
    "PTP {X 0,Y 0,Z 40,A 0,B 0,C 0}\n"
    "LIN {X 0,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n"
    "LIN {X 120,Y 10,Z 1,A 10,B -8,C 12} C_DIS\n"
    "LIN {X 160,Y 70,Z 0,A 40,B 10,C -10} C_DIS\n"
    "PTP {X 160,Y 70,Z 40,A 40,B 10,C -10}\nEND\n";

const std::string rail =
    "{ error = \"way\" }, { actuator = \"prismatic\", axis = \"x\", program_axis = \"E1\" },";

/// The arm of the other tests behind `first`, with the errors `way` of a rail.
Machine arm_behind(const std::string& first, const std::string& way) {
  std::string text =
      replaced(read_file(robot), "xyz_mm = [250, 0, 120]", "xyz_mm = [250, 0, 120]\nrpy_deg = [0, -90, 0]");
  text = replaced(text, "elements = [\n", "elements = [\n" + first + "\n");
  return read_machine(replaced(text, "errors.base", way + "errors.base"), "rail.toml");
}

/// The result of the path, whose program zero is at `zero_of_part` in the machine frame.
Compensation corrected(const Machine& machine, const Vector3& zero_of_part) {
  Order order{machine, path, constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished())};
  order.max_correction = 0.01;
  order.read.dialect = "kuka";
  order.X_MW = translation(zero_of_part);
  return compensated(Shop(order));
}

const Vector3 zero_of_part(1.73, 0.04, 0.6), travel(0.85, 0, 0);

double largest_difference(const Compensation& a, const Compensation& b) {
  REQUIRE(a.waypoints.size() == b.waypoints.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.waypoints.size(); ++i)
    largest = std::max(largest, (a.waypoints[i].correction - b.waypoints[i].correction).norm());
  return largest;
}

}  // namespace

TEST_CASE("a straight rail that moves together with the work leaves the correction as it is") {
  const Machine machine = arm_behind(rail, "");
  const Compensation at_0 = corrected(machine, zero_of_part),
                     at_850 = corrected(at_program_axes(machine, {850.0}), zero_of_part + travel);
  CHECK(at_0.waypoints.size() > 20);
  CHECK(largest_difference(at_0, at_850) < 1e-12);
  CHECK(at_850.text == at_0.text);
}

TEST_CASE("a rail that is not square acts as an arm whose base is displaced by the rail's error there") {
  const std::string skew = "errors.way = { rpy_deg = [0, 0, 0.03] }\n";
  const Machine machine = arm_behind(rail, skew);
  const Compensation at_0 = corrected(machine, zero_of_part),
                     at_850 = corrected(at_program_axes(machine, {850.0}), zero_of_part + travel);
  // The base is at R (850, 0, 0) instead of (850, 0, 0), and turned by R.
  const Vector3 off = Eigen::AngleAxisd(0.03 * deg, Vector3::UnitZ()) * travel - travel;
  const Compensation displaced = corrected(
      arm_behind("{ error = \"way\" },",
                 fmt::format("errors.way = {{ xyz_mm = [{:.12f}, {:.12f}, 0], rpy_deg = [0, 0, 0.03] }}\n",
                             off.x() / mm, off.y() / mm)),
      zero_of_part);
  CHECK(largest_difference(at_850, displaced) < 1e-11);
  // The rail adds its error of straightness there, 0.445 mm, which the correction takes away.
  const Vector3 added = (at_850.waypoints[0].correction - at_0.waypoints[0].correction).head<3>();
  CHECK(off.norm() == doctest::Approx(0.445e-3).epsilon(1e-3));
  CHECK((added + off).norm() < 0.01 * off.norm());
}

TEST_CASE("a run that leaves a travel of shown, coupled values fails with the shown value") {
  const auto limited = [](const std::string& min) {
    const std::string joint_3 = "{ actuator = \"revolute\", axis = \"y\", home_deg = 108 }";
    std::string text =
        replaced(read_file(robot), "xyz_mm = [250, 0, 120]", "xyz_mm = [250, 0, 120]\nrpy_deg = [0, -90, 0]");
    // q2 = -78 and q3 = 108 at home: J2 = -78, J3 = -108 + 78 = -30.
    text = replaced(text, joint_3,
                    "{ actuator = \"revolute\", axis = \"y\", shown_sign = -1, shown_with = { J2 = -1 }, "
                    "home_deg = -30, max_deg = 90, min_deg = " +
                        min + " }");
    Order order{read_machine(text, "arm.toml"), path};
    order.max_correction = 0.01;
    order.read.dialect = "kuka";
    order.X_MW = translation(zero_of_part);
    return Shop(order).run();
  };
  const Compensation free = limited("-180");
  REQUIRE(!free.failure);
  double least = HUGE_VAL;
  for (const Waypoint& w : free.waypoints) least = std::min(least, (-w.rho[2] - w.rho[1]) / deg);
  CHECK(!limited(fmt::format("{:.6f}", least - 0.1)).failure);
  const Compensation outside = limited(fmt::format("{:.6f}", least + 0.5));
  REQUIRE(outside.failure);
  CHECK(outside.failure->status == Status::outside_travel);
  CAPTURE(outside.failure->what);
  CHECK(outside.failure->what.starts_with("axis A3: "));
}
