/// Machines of `machine/create.hpp`, solved.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/machine/shown.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/statics/tip_stiffness.hpp"

using namespace counterflex;

namespace {

using Matrix4 = Eigen::Matrix4d;

/// Standard Denavit-Hartenberg: Rot_z(theta) Trans_z(d) Trans_x(a) Rot_x(alpha), lengths in m.
Matrix4 link(double theta, double d, double a, double alpha) {
  const double c = std::cos(theta), s = std::sin(theta), ca = std::cos(alpha), sa = std::sin(alpha);
  Matrix4 T;
  T << c, -s * ca, s * sa, a * c, s, c * ca, -c * sa, a * s, 0, sa, ca, d, 0, 0, 0, 1;
  return T;
}

/// The published parameters of a robot: shown values in degrees to the flange. Arms of the usual build, with
/// the shoulder `a1` in front of axis 1, an upper arm `a2`, an elbow offset `a3`, a forearm `d4` and a flange
/// at `d6`: axis 1 up, axes 2, 3 and 5 lean forward and down. x of the flange is up with the forearm in
/// front.
struct Arm {
  double d1, a1, a2, a3, d4, d6;
};

/// `lean`: of the upper arm from the vertical, `pitch`: of the forearm from the horizontal, down (rad).
Matrix4 flange_of(const Arm& arm, double turn, double lean, double pitch, double roll, double wrist,
                  double last) {
  const double h = pi / 2;
  return link(turn, arm.d1, arm.a1, -h) * link(lean - h, 0, arm.a2, 0) * link(pitch - lean, 0, -arm.a3, -h) *
         link(roll, arm.d4, 0, h) * link(wrist, 0, 0, -h) * link(last, arm.d6, 0, 0);
}

/// The flange frame of KUKA and ABB has x down.
const Matrix4 x_down = Eigen::Vector4d(-1, -1, 1, 1).asDiagonal();

using Shown = std::array<double, 6>;  // rad
using Forward = Matrix4 (*)(const Shown&);

Matrix4 ur10(const Shown& j) {
  const double h = pi / 2;
  return link(j[0], 0.1273, 0, h) * link(j[1], 0, -0.612, 0) * link(j[2], 0, -0.5723, 0) *
         link(j[3], 0.163941, 0, h) * link(j[4], 0.1157, 0, -h) * link(j[5], 0.0922, 0, 0);
}

// KUKA: A1, A4 and A6 turn the other way; A2 is zero with the arm in front, A3 with the forearm in line.
Matrix4 kuka(const Shown& j, double d6) {
  return flange_of({0.675, 0.35, 1.15, 0.041, 1.2, d6}, -j[0], j[1] + pi / 2, j[1] + j[2], -j[3], j[4],
                   -j[5]) *
         x_down;
}
Matrix4 kr270(const Shown& j) {
  return kuka(j, 0.24);
}
Matrix4 kr210(const Shown& j) {
  return kuka(j, 0.215);
}
Matrix4 irb6700(const Shown& j) {
  return flange_of({0.78, 0.32, 1.125, -0.2, 1.1425, 0.2}, j[0], j[1], j[1] + j[2], j[3], j[4], j[5]) *
         x_down;
}
// Axis 3 of the IRB 2400 is that of its parallelogram: the pitch of the forearm.
Matrix4 irb2400(const Shown& j) {
  return flange_of({0.615, 0.1, 0.705, -0.135, 0.755, 0.085}, j[0], j[1], j[2], j[3], j[4], j[5]) * x_down;
}
// FANUC: J3 raises the forearm against the horizontal, J4 to J6 turn the other way.
Matrix4 m20ia(const Shown& j) {
  return flange_of({0, 0.15, 0.79, -0.25, 0.835, 0.1}, j[0], j[1], -j[2], -j[3], -j[4], -j[5]);
}

Machine robot(const std::string& name) {
  MachineFacts facts;
  facts.kind = MachineKind::robot6r;
  facts.robot = name;
  return read_machine(machine_file(facts), name + ".toml");
}

/// The largest difference of the flange's matrix at random shown values.
double largest_difference(const std::string& name, Forward forward) {
  const Machine machine = robot(name);
  const Model model = prepare(machine);
  REQUIRE(model.home_status == Status::converged);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-pi, pi);
  double largest = 0;
  for (int k = 0; k < 200; ++k) {
    Shown j;
    for (double& value : j) value = angle(random);
    const Eigen::VectorXd shown = Eigen::Map<const Eigen::VectorXd>(j.data(), 6);
    const ShownActuators& conversion = model.mechanism.shown;
    const NominalResult there =
        nominal_forward(model, model.home, conversion.differ() ? joint_values(conversion, shown) : shown);
    REQUIRE(there.status != Status::unreachable);
    Matrix4 T = Matrix4::Identity();
    T.topLeftCorner<3, 3>() = there.configuration.X_MP.R;
    T.topRightCorner<3, 1>() = there.configuration.X_MP.p;
    largest = std::max(largest, (T - forward(j)).cwiseAbs().maxCoeff());
  }
  return largest;
}

MachineFacts facts_of(MachineKind kind) {
  MachineFacts facts;
  facts.kind = kind;
  facts.robot = "ur10";
  return facts;
}

}  // namespace

TEST_CASE("the flange of each built-in robot is where the published parameters put it") {
  const std::vector<std::pair<std::string, Forward>> robots = {{"ur10", ur10},
                                                               {"kuka-kr270-r2700-ultra", kr270},
                                                               {"kuka-kr210-r2700-extra", kr210},
                                                               {"abb-irb6700-200-260", irb6700},
                                                               {"abb-irb2400", irb2400},
                                                               {"fanuc-m20ia", m20ia}};
  CHECK(robots.size() == known_robots().size());
  for (const auto& entry : robots) {
    CAPTURE(entry.first);
    CHECK(largest_difference(entry.first, entry.second) < 1e-12);
  }
}

TEST_CASE("each made machine closes at home and is stable there") {
  for (const KindOfMachine& kind : kinds_of_machine) {
    CAPTURE(kind.name);
    const Model model = prepare(read_machine(machine_file(facts_of(kind.kind)), "made.toml"));
    CHECK(model.home_status == Status::converged);
    CHECK(model.home_gap < 1e-12);
    StaticsWork work(model.mechanism);
    CHECK(solve_forward(model, model.home, Load{}, Stage{}, work).status == Status::converged);
  }
}

TEST_CASE("the stiffness at the tip of a made mill is the given one in all places, out of square or not") {
  for (const MachineKind kind : {MachineKind::mill3, MachineKind::mill3_table, MachineKind::gantry,
                                 MachineKind::table_ac, MachineKind::table_bc}) {
    MachineFacts facts = facts_of(kind);
    facts.tip_stiffness = Vector3(28e6, 22e6, 45e6);
    facts.squareness_um_per_m = {-180, 120, 250};
    const Model model = prepare(read_machine(machine_file(facts), "made.toml"));
    StaticsWork work(model.mechanism);
    for (const Vector3& shift : {Vector3(0, 0, 0), Vector3(0.1, -0.05, 0.08)}) {
      Eigen::VectorXd rho = actuator_values(model.mechanism, model.home) + shift;
      const NominalResult there = nominal_forward(model, model.home, rho);
      const auto C = compliance_at_tip(model, there.configuration, Load{}, Stage{}, work);
      REQUIRE(C);
      for (int axis = 0; axis < 3; ++axis)
        CHECK(stiffness_along(*C, Vector3::Unit(axis)) ==
              doctest::Approx((*facts.tip_stiffness)[axis]).epsilon(1e-12));
    }
  }
}

TEST_CASE("the stiffness at the tip of a made mill is along its linear axes where the table is turned") {
  for (const MachineKind kind : {MachineKind::table_ac, MachineKind::table_bc}) {
    MachineFacts facts = facts_of(kind);
    facts.tip_stiffness = Vector3(28e6, 22e6, 45e6);
    std::string text = machine_file(facts);
    for (const char* angle : {"home_deg = 70", "home_deg = -35"})
      text.replace(text.find("home_deg = 0"), 12, angle);
    const Model model = prepare(read_machine(text, "made.toml"));
    REQUIRE(model.home_status == Status::converged);
    const Matrix3 R_MP = model.home.X_MP.R;
    CHECK(log_so3(R_MP).norm() > 60 * deg);
    StaticsWork work(model.mechanism);
    const auto C = compliance_at_tip(model, model.home, Load{}, Stage{}, work);
    REQUIRE(C);
    for (int axis = 0; axis < 3; ++axis)
      CHECK(stiffness_along(*C, R_MP.col(axis)) ==
            doctest::Approx((*facts.tip_stiffness)[axis]).epsilon(1e-9));
  }
}

TEST_CASE("the stiffness of a made leg or drive acts at the tip") {
  for (const MachineKind kind : {MachineKind::hexapod, MachineKind::delta, MachineKind::orthoglide}) {
    MachineFacts facts = facts_of(kind);
    const auto along_z = [&](double k) {
      facts.leg_stiffness = k;
      const Model model = prepare(read_machine(machine_file(facts), "made.toml"));
      StaticsWork work(model.mechanism);
      return 1 /
             stiffness_along(*compliance_at_tip(model, model.home, Load{}, Stage{}, work), Vector3::UnitZ());
    };
    // The compliance at the tip is that of the rest of the machine and a share of that of the drives.
    const double c1 = along_z(1e6), c2 = along_z(2e6), c4 = along_z(4e6);
    CHECK(c1 > c2);
    CHECK((c1 - c2) == doctest::Approx(2 * (c2 - c4)).epsilon(1e-6));
  }
}

TEST_CASE("a delta's bars have the given length and radius") {
  MachineFacts facts = facts_of(MachineKind::delta);
  facts.arm_mm = 333;
  facts.radius_mm = 174.75;
  const Model model = prepare(read_machine(machine_file(facts), "made.toml"));
  REQUIRE(model.home_status == Status::converged);
  // Off the centre by (x, y), carriage i rises by sqrt(L^2 - |d_i|^2) - sqrt(L^2 - R^2), d_i horizontal.
  const double x = 0.03, y = -0.02, z = 0.01, L = 0.333, R = 0.17475;
  Pose X_MT = tip(model.mechanism, model.home);
  X_MT.p += Vector3(x, y, z);
  const NominalResult there = follow(model, model.home, X_MT);
  REQUIRE(there.status == Status::converged);
  const Eigen::VectorXd rho = actuator_values(model.mechanism, there.configuration);
  for (int i = 0; i < 3; ++i) {
    const double a = (90 + 120 * i) * deg, dx = R * std::cos(a) - x, dy = R * std::sin(a) - y;
    CHECK(rho[i] ==
          doctest::Approx(z + std::sqrt(L * L - dx * dx - dy * dy) - std::sqrt(L * L - R * R)).epsilon(1e-9));
  }
}
