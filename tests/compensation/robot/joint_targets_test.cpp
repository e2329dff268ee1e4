// Targets in joint values stay as they are. The move behind one begins where the control takes the tool to
// be, and is corrected from there on. Places are those of an arm that shares nothing with the statics.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compensation/support/arm.hpp"
#include "counterflex/program/read_program.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const Vector3 first(1.73, 0.04, 0.64), second(1.85, 0.05, 0.601);  // m

/// The same orientation in all targets: none.
Arm::Joints joints_at(const Vector3& p) {
  return Arm{}.inverse(homogeneous(p, Matrix3::Identity()));
}

Pose nominal_place(const JointPlace& place) {
  const Matrix4 T = Arm{.perfect = true}.frames(Arm::Joints(place.joints.data()))[6];
  return Pose{T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>() / mm};
}

std::string list(const Arm::Joints& q, double unit) {
  std::array<std::string, 6> numbers;
  for (std::size_t i = 0; i < 6; ++i)
    numbers[i] = fmt::format("{:.9f}", q[static_cast<Eigen::Index>(i)] / unit);
  return fmt::format("{}", fmt::join(numbers, ","));
}

struct Robot {
  std::string dialect, joint_target, line, tail;
  std::string head{};

  std::string text() const { return head + joint_target + line + tail; }
};

std::vector<Robot> robots() {
  const Arm::Joints q = joints_at(first);
  const auto of_kuka = [&] {
    std::string text;
    for (int i = 0; i < 6; ++i) text += fmt::format("{}A{} {:.9f}", i > 0 ? "," : "", i + 1, q[i] / deg);
    return text;
  };
  std::string tp;
  for (int i = 0; i < 6; ++i) tp += fmt::format("{} J{} = {:.9f} deg", i > 0 ? "," : "", i + 1, q[i] / deg);
  return {{.dialect = "kuka",
           .joint_target = "PTP {" + of_kuka() + "}\n",
           .line = "LIN {X 1850.0,Y 50.0,Z 601.0,A 0.0,B 0.0,C 0.0} C_DIS\n",
           .tail = "END\n",
           .head = "DEF part( )\n$VEL.CP=0.025\n"},
          {.dialect = "abb",
           .joint_target = " MoveAbsJ [[" + list(q, deg) + "],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n",
           .line = " MoveL [[1850,50,601],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;\n",
           .tail = "ENDPROC\nENDMODULE\n",
           .head = "MODULE part\nPROC main()\n"},
          {.dialect = "ur",
           .joint_target = "  movej([" + list(q, 1) + "], a=1, v=1)\n",
           .line = "  movel(p[1.85,0.05,0.601,0,0,0], a=1, v=0.025, r=0.005)\n",
           .tail = "end\n",
           .head = "def part():\n"},
          {.dialect = "fanuc_tp",
           .joint_target = "   1:J P[1] 100% FINE ;\n",
           .line = "   2:L P[2] 25mm/sec CNT100 ;\n",
           .tail = "/POS\nP[1]{\n   GP1:\n UF : 0, UT : 1,\n" + tp +
                   "\n};\nP[2]{\n   GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = 1850.000 mm, Y = "
                   "50.000 mm, Z = 601.000 mm,\n W = 0.000 deg, P = 0.000 deg, R = 0.000 deg\n};\n/END\n",
           .head = "/PROG PART\n/MN\n"}};
}

Order order_of(const std::string& dialect, const std::string& text, bool perfect = false) {
  Order order{.machine = perfect ? counterflex::perfect(arm_machine()) : arm_machine(), .text = text};
  if (!perfect) order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  order.read.dialect = dialect;
  order.read.kinematics = [](const JointPlace& place, std::int32_t, const ProgramFrame&) {
    return std::optional(nominal_place(place));  // all frames are the world frame
  };
  return order;
}

}  // namespace

TEST_CASE("the line behind a target in joint values begins at the place of the joints") {
  for (const Robot& robot : robots()) {
    CAPTURE(robot.dialect);
    const Program program = read_program(robot.text(), "part", order_of(robot.dialect, "").read);
    REQUIRE(program.moves.size() == 1);
    const Move& move = program.moves[0];
    CHECK(move.starts_uncorrected);
    CHECK(all_known(move.known_start));
    CHECK((move.start_mm * mm - first).norm() < 1e-9);
    CHECK(move.may_jump);
    REQUIRE(move.orientation);
    CHECK(rotation_between(turn_of(*move.orientation).start, turn_of(*move.orientation).end).norm() < 1e-9);
    CHECK(program.left_alone.size() == 1);
    const Program unknown = read_program(robot.text(), "part", {.dialect = robot.dialect});
    REQUIRE(unknown.moves.size() == 1);
    CHECK(!all_known(unknown.moves[0].known_start));
    CHECK(!unknown.moves[0].starts_uncorrected);
    REQUIRE(!unknown.remarks.empty());
    CHECK(unknown.remarks.back().what.ends_with("has [controller] joint_values = \"as_shown\""));
    CHECK(program.remarks.size() + 1 == unknown.remarks.size());
  }
}

TEST_CASE("an inserted point before a line that is not split is a correction of its start") {
  Robot robot = robots()[0];
  robot.line = "LIN {X 1850.0,Y 50.0,Z 601.0,A 0.0,B 0.0,C 0.0}\n";  // it stops at its end
  const Shop shop(order_of("kuka", robot.text()));
  const auto failure_with = [&](const Vector3& p_mm) {
    Robot changed = robot;
    changed.line =
        fmt::format("LIN {{X {},Y {},Z {},A 0.0,B 0.0,C 0.0}}\n", p_mm.x(), p_mm.y(), p_mm.z()) + robot.line;
    const Program program = read_program(changed.text(), "changed", order_of("kuka", "").read);
    const auto failure = verify(shop.job(), program, true).failure;
    return failure ? failure->what : std::string();
  };
  const std::string beyond =
      "X at the start is shifted by 21.0000 mm, the limit of a correction is 20.0000 mm";
  CHECK(failure_with(first / mm + Vector3(21, 0, 0)) == beyond);
  CHECK(failure_with(first / mm + Vector3(19, 0, 0)) != beyond);
}

TEST_CASE("the line behind a target in joint values is corrected from its start to its end") {
  constexpr double tolerance = 5e-6;
  const Vector6 F = (Vector6() << 120, -300, -80, 2, 5, -3).finished();
  for (const Robot& robot : robots()) {
    CAPTURE(robot.dialect);
    const Order order = order_of(robot.dialect, robot.text());
    const Shop shop(order);
    const std::string text = compensated(shop).text;
    CAPTURE(text);
    CHECK(text.find(robot.joint_target) != std::string::npos);
    const Program program = read_program(text, "corrected", order.read);
    CHECK(!verify(shop.job(), program, false).failure);
    REQUIRE(program.moves.size() > 1);
    CHECK((program.moves[0].start_mm * mm - first).norm() < 1e-9);
    CHECK((program.moves[0].end_mm * mm - first).norm() < order.max_correction);
    double largest = 0;
    for (std::size_t m = 1; m < program.moves.size(); ++m) {
      const Move& move = program.moves[m];
      const Turn turn = turn_of(*move.orientation);
      for (int i = 0; i <= 8; ++i) {
        const double u = i / 8.0;
        const Vector3 commanded = (move.start_mm + u * (move.end_mm - move.start_mm)) * mm;
        const Vector3 real =
            Arm{}.tip(homogeneous(commanded, orientation_at(turn, u)), F).topRightCorner<3, 1>();
        const Vector3 along = (second - first).normalized();
        if (along.dot(real - first) < 2.1e-3) continue;  // there the force begins
        largest = std::max(largest, (real - first - along * along.dot(real - first)).norm());
      }
    }
    CHECK(largest < tolerance);
  }
}

TEST_CASE("a point may be inserted at joint values also before a line that is not divided") {
  const Robot abb = robots()[1];
  const std::string text = replaced(abb.text(), "v20,z1", "v20,fine");
  const Program program = read_program(text, "part", order_of("abb", "").read);
  CHECK(!program.moves[0].may_split);
  CHECK(program.moves[0].may_jump);
}

TEST_CASE("a program with joint targets stays as it is on a perfect machine") {
  for (const Robot& robot : robots())
    CHECK(compensated(Shop(order_of(robot.dialect, robot.text(), true))).text == robot.text());
}

TEST_CASE("joint targets that are passed, in loops, with missing axes, and before a call have no place") {
  const std::string line = "LIN {X 1850.0,Y 50.0,Z 601.0,A 0.0,B 0.0,C 0.0} C_DIS\n";
  const std::string joints = "{A1 0,A2 -78,A3 108,A4 0,A5 60,A6 0}";
  const auto knows_start = [&](const std::string& before) {
    const std::string text = "DEF part( )\n$VEL.CP=0.025\n" + before + line + "END\n";
    return all_known(read_program(text, "part", order_of("kuka", "").read).moves.back().known_start);
  };
  CHECK(knows_start("PTP " + joints + "\n"));
  CHECK(!knows_start("PTP " + joints + " C_PTP\n"));
  CHECK(!knows_start("PTP {A1 0,A2 -78,A3 108,A4 0,A5 60}\n"));
  CHECK(!knows_start("PTP " + joints + "\nDRILL( )\n"));
  CHECK(!knows_start("IF $IN[1] THEN\nPTP " + joints + "\nENDIF\n"));
}

TEST_CASE("joint targets that are passed have no place in any language") {
  const std::pair<std::string, std::string> stops[] = {{"}\nLIN", "} C_PTP\nLIN"},
                                                       {"v100,fine", "v100,z10"},
                                                       {"a=1, v=1)", "a=1, v=1, r=0.05)"},
                                                       {"100% FINE", "100% CNT50"}};
  const std::vector<Robot> all = robots();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string text = replaced(all[i].text(), stops[i].first, stops[i].second);
    CAPTURE(text);
    CHECK(!all_known(read_program(text, "part", order_of(all[i].dialect, "").read).moves.back().known_start));
  }
}

TEST_CASE("movel to joint values is corrected as the pose that they are") {
  const std::string joints = "[" + list(joints_at(second), 1) + "]";
  const std::string head =
      "def part():\n  q2 = " + joints + "\n  movej([" + list(joints_at(first), 1) + "])\n";
  const std::string tail = "  movel(p[1.85,0.1,0.601,0,0,0], a=1, v=0.025)\nend\n";
  for (const std::string& target : {joints, std::string("q2")}) {
    const std::string text = head + "  movel(" + target + ", a=1, v=0.025, r=0.004) # cut\n" + tail;
    const Order order = order_of("ur", text);
    const Program original = read_program(text, "part", order.read);
    REQUIRE(original.moves.size() == 2);
    CHECK((original.moves[0].end_mm * mm - second).norm() < 1e-9);
    const Shop shop(order);
    const std::string corrected = compensated(shop).text;
    CAPTURE(corrected);
    CHECK(corrected.find("q2 = " + joints + "\n") != std::string::npos);
    CHECK(corrected.find("  movel(" + target) == std::string::npos);
    CHECK(corrected.find(", a=1, v=0.025, r=0.004) # cut\n") != std::string::npos);
    const Program program = read_program(corrected, "corrected", order.read);
    CHECK(!verify(shop.job(), program, false).failure);
    CHECK(compensated(Shop(order_of("ur", text, true))).text == text);
    const std::string other =
        replaced(corrected, "a=1, v=0.025, r=0.004) # cut", "a=2, v=0.025, r=0.004) # cut");
    CHECK(verify(shop.job(), read_program(other, "corrected", order.read), false).failure);
  }
  const std::string unknown =
      read_program(head + "  movel(q2)\n" + tail, "part", {.dialect = "ur"}).left_alone.back().why;
  CHECK(unknown == "movel moves to joint positions, and where these are is not known");
}

TEST_CASE(
    "a call, a relative line, other external axes, a very short line and a changed target leave no place") {
  const std::string joints = "A1 0,A2 -78,A3 108,A4 0,A5 60,A6 0",
                    line = "LIN {X 1850.0,Y 50.0,Z 601.0,A 0,B 0,C 0";
  const auto knows_start = [&](const std::string& statements) {
    const std::string text = "DEF part( )\n$VEL.CP=0.025\n" + statements + "END\n";
    const Program program = read_program(text, "part", order_of("kuka", "").read);
    return all_known(program.moves.back().known_start);
  };
  CHECK(knows_start("PTP {" + joints + ",E1 5}\n" + line + ",E1 5} C_DIS\n"));
  CHECK(!knows_start("PTP {" + joints + ",E1 5}\n" + line + ",E1 6} C_DIS\n"));
  CHECK(!knows_start("PTP {" + joints + "}\n" + line + ",E1 6} C_DIS\n"));
  CHECK(!knows_start("PTP {" + joints + "}\nIF GOSAFE(1) THEN\nENDIF\n" + line + "} C_DIS\n"));
  CHECK(!knows_start("PTP {" + joints + "}\ni=SUBI(3)\n" + line + "} C_DIS\n"));
  CHECK(!knows_start("PTP {" + joints + "}\nLIN_REL {Z 5} C_DIS\n"));
  CHECK(!knows_start("H={" + joints + "}\nH.A1=5\nPTP H\n" + line + "} C_DIS\n"));
  const Program original = read_program("DEF part( )\nPTP {" + joints + "}\n" + line + "} C_DIS\nEND\n",
                                        "part", order_of("kuka", "").read);
  const Vector3 p = original.moves[0].start_mm;
  CHECK(!knows_start("PTP {" + joints + "}\nLIN {X " +
                     fmt::format("{:.3f},Y {:.3f},Z {:.3f}", p.x(), p.y(), p.z()) + ",A 0,B 0,C 0} C_DIS\n"));
}

TEST_CASE("the kinematics get the tool of the program, for joint targets and for movel to joint values") {
  const std::string joints = "[" + list(joints_at(second), 1) + "]";
  const auto left = [&](const std::string& tools) {
    Order order = order_of("ur", "");
    order.read.kinematics = [](const JointPlace& place, std::int32_t, const ProgramFrame&) {
      const bool same = !place.other_tool && place.tcp_mm && place.tcp_mm->p.z() == 150;
      return same ? std::optional(nominal_place(place)) : std::nullopt;
    };
    const Program program = read_program(
        "def part():\n" + tools + "  movel(" + joints + ", a=1, v=0.025)\nend\n", "part", order.read);
    return program.moves.empty();
  };
  const std::string tool = "  set_tcp(p[0,0,0.15,0,0,0])\n", other = "  set_tcp(p[0,0,0.2,0,0,0])\n";
  CHECK(!left(tool));
  CHECK(left(other));
  CHECK(left(other + tool));
}
