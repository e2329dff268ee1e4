// Orientations where numbers are ambiguous, in every language, against rotations that are written out by
// hand.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "counterflex/geometry/turn.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"

using namespace counterflex;

namespace {

/// A language whose orientation is three angles: R = Rz Ry Rx. `statement` has the place and the angles about
/// x, y and z in its own order.
struct AngleLanguage {
  std::string dialect, head, between, tail;
  std::string (*target)(int index, double x_mm, const Vector3& about_xyz);
};

std::string tp_corner_position(int index, double x_mm, const Vector3& a) {
  return fmt::format(
      "P[{}]{{\n   GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = {} mm, Y = 0 mm, Z = 0 mm,\n W = "
      "{} "
      "deg, P = {} deg, R = {} deg\n}};\n",
      index, x_mm, a.x(), a.y(), a.z());
}

std::vector<AngleLanguage> angle_languages() {
  return {
      {"kuka", "DEF part( )\n$VEL.CP=0.1\n", "", "END\n",
       [](int index, double x_mm, const Vector3& a) {
         return fmt::format("{} {{X {},Y 0,Z 0,A {},B {},C {}}}{}\n", index == 1 ? "PTP" : "LIN", x_mm, a.z(),
                            a.y(), a.x(), index == 1 ? "" : " C_DIS");
       }},
      {"fanuc_tp", "/PROG PART\n/MN\n   1:J P[1] 50% FINE ;\n   2:L P[2] 25mm/sec CNT100 ;\n/POS\n", "",
       "/END\n", tp_corner_position},
      {"yaskawa",
       "/JOB\n//NAME PART\n//POS\n///NPOS 2,0,0,0,0,0\n///TOOL 0\n///POSTYPE BASE\n///RECTAN\n///RCONF "
       "0,0,0,0,0,0,0,0\n",
       "",
       "//INST\n///DATE 2024/01/01 12:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\nMOVJ C00000 VJ=50.00\nMOVL "
       "C00001 V=100.0\nEND\n",
       [](int index, double x_mm, const Vector3& a) {
         return fmt::format("C{:05}={},0,0,{},{},{}\n", index - 1, x_mm, a.x(), a.y(), a.z());
       }},
  };
}

std::string corner_text(const AngleLanguage& language, const Vector3& start, const Vector3& end) {
  return language.head + language.target(1, 0, start) + language.between + language.target(2, 50, end) +
         language.tail;
}

/// How the second of two targets turns the tool.
Turn turn_of_second(const std::string& dialect, const std::string& text) {
  CAPTURE(text);
  const Program program = read_program(text, "part", {.dialect = dialect});
  REQUIRE(program.moves.size() == 2);
  REQUIRE(program.moves[1].orientation);
  REQUIRE(all_known(program.moves[1].known_start));
  return turn_of(*program.moves[1].orientation);
}

/// The constant turn from `start` to `end` by the shorter way, on a grid of 201 places.
void check_turn(const Turn& turn, const Matrix3& start, const Matrix3& end) {
  constexpr double room = 1e-9;
  const Eigen::Quaterniond q0(start), q1(end);
  double largest = 0;
  for (int i = 0; i <= 200; ++i) {
    const double u = i / 200.0;
    const Matrix3 wanted = q0.slerp(u, q1).toRotationMatrix();  // the shorter way: it turns the sign of q1
    largest = std::max(largest, (orientation_at(turn, u) - wanted).norm());
  }
  CHECK(largest < room);
}

Matrix3 rows(std::initializer_list<double> values) {
  Matrix3 R;
  auto value = values.begin();
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) R(i, j) = *value++;
  return R;
}

/// Rz(z) Ry(90) Rx(x), multiplied out: only x - z counts.
Matrix3 up(double x_deg, double z_deg) {
  const double c = std::cos((x_deg - z_deg) * deg), s = std::sin((x_deg - z_deg) * deg);
  return rows({0, s, c, 0, c, -s, -1, 0, 0});
}

/// Rz(z) Ry(-90) Rx(x), multiplied out: only x + z counts.
Matrix3 down(double x_deg, double z_deg) {
  const double c = std::cos((x_deg + z_deg) * deg), s = std::sin((x_deg + z_deg) * deg);
  return rows({0, -s, -c, 0, c, -s, 1, 0, 0});
}

Matrix3 about_z(double angle_deg) {
  const double c = std::cos(angle_deg * deg), s = std::sin(angle_deg * deg);
  return rows({c, -s, 0, s, c, 0, 0, 0, 1});
}

std::string rapid_corner(const std::string& start, const std::string& end) {
  const std::string rest = ",[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
  return "MODULE part\nPROC main()\nConfJ\\Off;\nMoveJ [[0,0,0],[" + start + "]" + rest +
         ",v100,z1,tool0;\nMoveL [[50,0,0],[" + end + "]" + rest + ",v100,z1,tool0;\nENDPROC\nENDMODULE\n";
}

std::string ur_corner(const std::string& start, const std::string& end) {
  return "def part():\n  movej(p[0.1,0,0," + start + "])\n  movel(p[0.15,0,0," + end + "], r=0.001)\nend\n";
}

}  // namespace

TEST_CASE(
    "at +-90 degrees about y only the sum of the other angles counts, and the tool turns the shorter way") {
  for (const AngleLanguage& language : angle_languages()) {
    CAPTURE(language.dialect);
    const auto turn = [&](const Vector3& start, const Vector3& end) {
      return turn_of_second(language.dialect, corner_text(language, start, end));
    };
    check_turn(turn({10, 90, 30}, {40, 90, 30}), up(10, 30), up(40, 30));
    check_turn(turn({10, 90, 30}, {80, 90, 100}), up(10, 30), up(10, 30));  // other angles, the same rotation
    check_turn(turn({10, -90, 30}, {-60, -90, 45}), down(10, 30), down(-60, 45));
    check_turn(
        turn({5, 90, 0}, {5, 0, 0}), up(5, 0),
        rows({1, 0, 0, 0, std::cos(5 * deg), -std::sin(5 * deg), 0, std::sin(5 * deg), std::cos(5 * deg)}));
  }
}

TEST_CASE("from 359.999 to 0.001 degrees the tool turns by 0.002 degrees") {
  for (const AngleLanguage& language : angle_languages()) {
    CAPTURE(language.dialect);
    const Turn turn = turn_of_second(language.dialect, corner_text(language, {0, 0, 359.999}, {0, 0, 0.001}));
    check_turn(turn, about_z(-0.001), about_z(0.001));
    CHECK(rotation_between(turn.end, turn.start).norm() == doctest::Approx(0.002 * deg));
    check_turn(turn_of_second(language.dialect, corner_text(language, {0, 0, -179.5}, {0, 0, 179.5})),
               about_z(180.5), about_z(179.5));
  }
}

TEST_CASE("a quaternion and its negative are one rotation, and the tool turns the shorter way") {
  const auto q = [](double angle_deg, int sign) {
    return fmt::format("{:.12f},0,0,{:.12f}", sign * std::cos(angle_deg / 2 * deg),
                       sign * std::sin(angle_deg / 2 * deg));
  };
  check_turn(turn_of_second("abb", rapid_corner(q(10, 1), q(10, -1))), about_z(10), about_z(10));
  check_turn(turn_of_second("abb", rapid_corner(q(10, 1), q(30, -1))), about_z(10), about_z(30));
  check_turn(turn_of_second("abb", rapid_corner(q(170, 1), q(190, 1))), about_z(170), about_z(190));
  check_turn(turn_of_second("abb", rapid_corner("0,1,0,0", "0,-0.999847695156,0.017452406437,0")),
             rows({1, 0, 0, 0, -1, 0, 0, 0, -1}), about_z(-2) * rows({1, 0, 0, 0, -1, 0, 0, 0, -1}));
}

TEST_CASE("a rotation vector of half a turn has two signs") {
  const std::string pi_x = "3.141592653590,0,0", minus_pi_x = "-3.141592653590,0,0";
  const Matrix3 half = rows({1, 0, 0, 0, -1, 0, 0, 0, -1});
  check_turn(turn_of_second("ur", ur_corner(pi_x, minus_pi_x)), half, half);
  const double c = std::cos(0.02), s = std::sin(0.02);
  check_turn(turn_of_second("ur", ur_corner(pi_x, "-3.121592653590,0,0")), half,
             half * rows({1, 0, 0, 0, c, -s, 0, s, c}));
  // Half a turn about (cos 1 deg, sin 1 deg, 0), against half a turn about x: 2 degrees about z.
  const std::string beside =
      fmt::format("{:.12f},{:.12f},0", 3.14159265359 * std::cos(1 * deg), 3.14159265359 * std::sin(1 * deg));
  check_turn(turn_of_second("ur", ur_corner(minus_pi_x, beside)), half, about_z(2) * half);
  check_turn(turn_of_second("ur", ur_corner("0,0,0", "0,0,6.283185307180")), Matrix3::Identity(),
             Matrix3::Identity());
}
