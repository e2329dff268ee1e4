// A KUKA program for an arm on a rail, judged by the forward model of `RailArm`: the written targets lead it
// to the programmed ones.
#include "compensation/robot/rail_arm.hpp"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "counterflex/machine/program_axes.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const RailErrors errors{.rail_deg = {0.01, -0.015, 0.03},
                        .base_deg = {0.01, 0.02, 0},
                        .shoulder_deg = {0, 0.05, 0.01},
                        .zeros_deg = {0.01, -0.02, 0.03, -0.04, 0.03, 0.05}};
const Vector6 cutting = (Vector6() << 120, -300, -80, 2, 5, -3).finished();

/// Lines, an arc and Cartesian PTP. The rail is at `rail_mm`, and the base at the same distance before it.
std::string krl_program(double rail_mm) {
  std::string text = fmt::format(
      "DEF part( )\n$BASE={{X {:.3f},Y -45.0,Z 640.0,A 10.0,B 0.0,C 2.0}}\n$VEL.CP=0.025\n", 1450 + rail_mm);
  const auto target = [&](double x, double y, double z, double a, double b, double c) {
    return fmt::format("{{X {:.9f},Y {:.9f},Z {:.9f},A {:.9f},B {:.9f},C {:.9f},S 2,E1 {:.1f}}}", x, y, z, a,
                       b, c, rail_mm);
  };
  text += "PTP " + target(0, 0, 40, 0, 0, 0) + "\nLIN " + target(0, 0, 0, 0, 0, 0) + " C_DIS\nLIN " +
          target(80, 0, 0, 12, 5, -8) + " C_DIS\nCIRC " + target(100, 20, 0, 12, 5, -8) + "," +
          target(80, 40, 0, 12, 5, -8) + " C_DIS\nLIN " + target(20, 60, 10, -30, -10, 4) + " C_DIS\nPTP " +
          target(20, 60, 60, -30, -10, 4) + "\nPTP " + target(200, -90, 80, 40, 20, 10) + "\nEND\n";
  return text;
}

/// What the statement of a target has.
struct KrlTarget {
  std::string head;
  Matrix4 pose;      ///< in the machine frame
  std::string rest;  ///< behind C: S and external axes
  std::size_t place = 0;
};

/// X, Y, Z, A, B, C in mm and degrees.
Matrix4 pose_of(const std::smatch& match, std::size_t from) {
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = std::stod(match[from + i]);
  return homogeneous(Vector3(n[0], n[1], n[2]) * mm, rotation_of_words({n[5], n[4], n[3]}));
}

/// The ends of LIN, CIRC and Cartesian PTP, in their order, in the base of the program.
std::vector<KrlTarget> targets_of(const std::string& text) {
  const std::string n = " ([-0-9.]+)",
                    numbers = "X" + n + ",Y" + n + ",Z" + n + ",A" + n + ",B" + n + ",C" + n;
  const std::regex base_pattern("\\$BASE=\\{" + numbers),
      pattern("\\n(LIN|PTP|CIRC) (?:\\{[^\\n}]*\\},)?\\{" + numbers + "([^}]*)\\}");
  std::smatch base;
  REQUIRE(std::regex_search(text, base, base_pattern));
  const Matrix4 X_MB = pose_of(base, 1);
  std::vector<KrlTarget> targets;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    targets.push_back({(*at)[1], X_MB * pose_of(*at, 2), (*at)[8], static_cast<std::size_t>(at->position())});
  return targets;
}

Order rail_order(const std::string& text, const Machine& machine) {
  Order order{machine, text, constant_force(cutting)};
  order.max_correction = 20e-3;
  order.decimals = 9;
  order.read.dialect = "kuka";
  return order;
}

double shift_between(const Matrix4& a, const Matrix4& b) {
  return (a - b).topRightCorner<3, 1>().norm();
}

/// The written target of each programmed one: of the next ones that which is shifted most nearly as the one
/// before, or the nearest one.
std::vector<KrlTarget> written_for(const std::vector<KrlTarget>& programmed,
                                   const std::vector<KrlTarget>& written) {
  REQUIRE(written.size() >= programmed.size());
  std::vector<KrlTarget> own;
  std::size_t next = 0;
  std::array<Vector3, 2> shifts{Vector3::Zero(), Vector3::Zero()};  // of feeds and rapids
  for (const KrlTarget& target : programmed) {
    Vector3& shift = shifts[target.head == "PTP" ? 1 : 0];
    const auto shift_of = [&](const KrlTarget& other) {
      return Vector3((other.pose - target.pose).topRightCorner<3, 1>());
    };
    const auto off = [&](const KrlTarget& other) {
      if ((other.head == "PTP") != (target.head == "PTP")) return HUGE_VAL;
      return (shift_of(other) - shift).norm() +
             0.1 * angle_between(Matrix3(other.pose.topLeftCorner<3, 3>()),
                                 Matrix3(target.pose.topLeftCorner<3, 3>()));
    };
    const std::size_t inserted = written.size() - next - (programmed.size() - own.size());  // not yet passed
    std::size_t best = next;
    for (std::size_t k = next; k <= next + inserted; ++k)
      if (off(written[k]) < off(written[best])) best = k;
    own.push_back(written[best]);
    shift = shift_of(written[best]);
    next = best + 1;
  }
  return own;
}

/// Every `step`-th programmed target is where the written one leads `arm`, within `room` (m).
void check_targets(const RailArm& arm, const std::string& original, const std::string& text, std::size_t step,
                   double room) {
  const std::vector<KrlTarget> programmed = targets_of(original),
                               written = written_for(programmed, targets_of(text));
  REQUIRE(written.size() == programmed.size());
  double largest = 0;
  for (std::size_t i = 0; i < programmed.size(); i += step) {
    const bool rapid = programmed[i].head == "PTP";
    const Matrix4 tip = arm.tip(written[i].pose, rapid ? Vector6(Vector6::Zero()) : cutting);
    const double miss = shift_between(tip, programmed[i].pose),
                 turn = angle_between(Matrix3(tip.topLeftCorner<3, 3>()),
                                      Matrix3(programmed[i].pose.topLeftCorner<3, 3>()));
    CAPTURE(i);
    CAPTURE(programmed[i].head);
    CHECK(miss < room);
    CHECK(turn < 1e-6);
    CHECK(written[i].head == programmed[i].head);
    CHECK(written[i].rest == programmed[i].rest);
    CHECK(shift_between(written[i].pose, programmed[i].pose) > 1e-4);
    largest = std::max(largest, miss);
  }
  MESSAGE("largest miss at " << programmed.size() / step << " targets: " << largest / mm << " mm");
}

}  // namespace

TEST_CASE("written targets of a KUKA program lead an independent arm on a rail to the programmed ones") {
  for (const double rail_mm : {0.0, 850.0}) {
    CAPTURE(rail_mm);
    const std::string text = krl_program(rail_mm);
    const Machine machine = at_program_axes(rail_machine(errors, "E1"), {rail_mm});
    const Compensation result = compensated(Shop(rail_order(text, machine)));
    CHECK(result.counts.inserted_blocks > 0);
    check_targets(RailArm(errors, rail_mm * mm), text, result.text, 1, 1e-9);
  }
}

namespace {

/// Half a circle in a vertical plane that is turned by `turn_deg` about Z.
std::string vertical_circle(double turn_deg) {
  const auto place = [&](double angle_deg) {
    const double across = 20 * std::cos(angle_deg * deg);
    return fmt::format("{{X {:.3f},Y {:.3f},Z {:.3f}", 40 + across * std::cos(turn_deg * deg),
                       20 + across * std::sin(turn_deg * deg), -20 * std::sin(angle_deg * deg));
  };
  const std::string rest = ",A 0.0,B 0.0,C 10.0,E1 0.0}";
  return "DEF part( )\n$BASE={X 1450.0,Y -45.0,Z 640.0,A 10.0,B 0.0,C 2.0}\n$VEL.CP=0.025\nPTP " + place(0) +
         rest + "\nLIN " + place(0) + rest + " C_DIS\nCIRC " + place(45) + "}," + place(90) + rest +
         " C_DIS\nCIRC " + place(135) + "}," + place(180) + rest + " C_DIS\nEND\n";
}

}  // namespace

TEST_CASE("a circle through a point is corrected in any plane") {
  const Machine machine = at_program_axes(rail_machine(errors, "E1"), {0});
  for (const double turn_deg : {0.0, 45.0, 134.9, 135.0, 135.1, 225.0, 315.0}) {
    CAPTURE(turn_deg);
    const std::string text = vertical_circle(turn_deg);
    Order order = rail_order(text, machine);
    order.decimals = -1;
    const Shop shop(order);
    const std::string corrected = compensated(shop).text;
    const std::regex point("CIRC (\\{X [^}]*,Z )-([0-9.]+)\\}");
    REQUIRE(std::regex_search(corrected, point));
    const std::string above = std::regex_replace(corrected, point, "CIRC $1$2}");
    CHECK(verify(shop.job(), read_program(above, "above.src", shop.read), false).failure.has_value());
  }
}

TEST_CASE(
    "a perfect rail that moves 850 mm with the base leaves the correction as it is, one with an error not") {
  const auto corrections = [](const RailErrors& of_arm, double rail_mm) {
    const Machine machine = at_program_axes(rail_machine(of_arm, "E1"), {rail_mm});
    return compensated(Shop(rail_order(krl_program(rail_mm), machine))).waypoints;
  };
  const auto largest_difference = [&](const RailErrors& of_arm) {
    const std::vector<Waypoint> a = corrections(of_arm, 0), b = corrections(of_arm, 850);
    double largest = 0;
    for (const Waypoint& w : a)
      for (const Waypoint& v : b)
        if (w.segment == v.segment && w.fraction == v.fraction && w.between == v.between)
          largest = std::max(largest, (w.correction - v.correction).head<3>().norm());
    return largest;
  };
  RailErrors perfect = errors;
  perfect.rail_deg.setZero();
  CHECK(largest_difference(perfect) < 1e-12);
  CHECK(largest_difference(errors) > 0.3e-3);
}

TEST_CASE(
    "the targets of a real program for a robot on a rail lead the independent arm to the programmed ones") {
  const char* folder = std::getenv("COUNTERFLEX_PROGRAMS");
  if (folder == nullptr) {
    std::puts("skipped: the environment variable COUNTERFLEX_PROGRAMS does not name a folder of programs");
    return;
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().filename() != "kuka_nx_cavity_mill_rail.src") continue;
    // Angles get nine decimals: four turn the tool by up to 1e-6 rad.
    const std::string text = std::regex_replace(read_file(entry.path().string()),
                                                std::regex("[ABC] -?[0-9]+\\.[0-9]{3}"), "$&000000");
    const double rail_mm = 850;
    const Machine machine = at_program_axes(rail_machine(errors, "E2"), {std::nullopt, rail_mm});
    const Compensation result = compensated(Shop(rail_order(text, machine)));
    check_targets(RailArm(errors, rail_mm * mm), text, result.text, 40, 1e-9);
  }
}
