// Targets near the border of another configuration: the run is refused, or the corrected target has the
// configuration of the programmed one. Joint values are those of arms that share nothing with the statics.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <random>
#include <regex>

#include "compensation/support/arm.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

using Joints = Arm::Joints;

/// The UR10 without errors: each joint turns about z of its frame.
Matrix4 tip_of_ur(const Joints& q) {
  const std::array<Matrix4, 6> links{shift(0, 0, 0.1273) * turn_about(0, pi / 2),
                                     shift(-0.612, 0, 0),
                                     shift(-0.5723, 0, 0),
                                     shift(0, 0, 0.163941) * turn_about(0, pi / 2),
                                     shift(0, 0, 0.1157) * turn_about(0, -pi / 2),
                                     shift(0, 0, 0.0922 + 0.15)};
  Matrix4 T = Matrix4::Identity();
  for (std::size_t i = 0; i < 6; ++i) T = T * turn_about(2, q[static_cast<Eigen::Index>(i)]) * links[i];
  return T;
}

Matrix4 tip_of(const std::string& dialect, const Joints& q) {
  return dialect == "ur" ? tip_of_ur(q) : Arm{.perfect = true}.frames(q)[6];
}

/// The joints nearest to `q` that lead to `wanted`: Newton's method with differences.
Joints joints_near(const std::string& dialect, Joints q, const Matrix4& wanted) {
  const auto miss_at = [&](const Joints& at) {
    const Matrix4 tip = tip_of(dialect, at);
    const Eigen::AngleAxisd turn(
        Matrix3(wanted.topLeftCorner<3, 3>() * tip.topLeftCorner<3, 3>().transpose()));
    Joints miss;
    miss << wanted.topRightCorner<3, 1>() - tip.topRightCorner<3, 1>(), turn.angle() * turn.axis();
    return miss;
  };
  constexpr double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    Eigen::Matrix<double, 6, 6> J;
    for (Eigen::Index i = 0; i < 6; ++i)
      J.col(i) = (miss_at(q + h * Joints::Unit(i)) - miss_at(q - h * Joints::Unit(i))) / (2 * h);
    q -= J.partialPivLu().solve(miss_at(q));
  }
  REQUIRE(miss_at(q).norm() < 1e-10);
  return q;
}

/// The machine of the arm with errors, at home at `home` (deg).
Machine machine_at(const std::string& dialect, const Joints& home) {
  std::string text =
      "format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\", \"z\", \"rx\", \"ry\", ";
  const bool is_ur = dialect == "ur";
  text += is_ur ? "\"rz\"]\n[tool]\nxyz_mm = [0, 0, 150]\n"
                : "\"rz\"]\n[tool]\nxyz_mm = [250, 0, 120]\nrpy_deg = [0, -90, 0]\n";
  text +=
      "[[chain]]\nname = \"arm\"\nerrors.foot = { rpy_deg = [0.03, -0.02, 0.01] }\n"
      "errors.elbow = { rpy_deg = [0.01, 0.02, -0.02] }\nelements = [\n  { error = \"foot\" },\n";
  const std::array<const char*, 6> links =
      is_ur ? std::array{"xyz_mm = [0, 0, 127.3], rpy_deg = [90, 0, 0]",
                         "xyz_mm = [-612, 0, 0]",
                         "xyz_mm = [-572.3, 0, 0]",
                         "xyz_mm = [0, 0, 163.941], rpy_deg = [90, 0, 0]",
                         "xyz_mm = [0, 0, 115.7], rpy_deg = [-90, 0, 0]",
                         "xyz_mm = [0, 0, 92.2]"}
            : std::array{"xyz_mm = [350, 0, 675]", "xyz_mm = [1150, 0, 0]", "xyz_mm = [1200, 0, -41]",
                         "xyz_mm = [0, 0, 0]",     "xyz_mm = [0, 0, 0]",    "xyz_mm = [215, 0, 0]"};
  for (std::size_t i = 0; i < 6; ++i) {
    text += fmt::format(
        "  {{ actuator = \"revolute\", axis = \"{}\", min_deg = -700, max_deg = 700, home_deg = {:.6f} }},\n"
        "  {{ rigid = {{ {} }} }},\n",
        is_ur ? "z" : std::array{"z", "y", "y", "x", "y", "x"}[i], home[static_cast<Eigen::Index>(i)],
        links[i]);
    if (i == 1) text += "  { error = \"elbow\" },\n";
  }
  return read_machine(text + "]\n", "arm.toml");
}

/// About the axes Z, Y, X in degrees.
Vector3 angles_of(const Matrix3& R) {
  return Vector3(std::atan2(R(1, 0), R(0, 0)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
                 std::atan2(R(2, 1), R(2, 2))) /
         deg;
}

/// What the languages state of a place: which axes are negative, quarter turns, half turns.
std::array<int, 6> negative_axes(const Joints& q) {
  std::array<int, 6> signs{};
  for (std::size_t i = 0; i < 6; ++i) signs[i] = q[static_cast<Eigen::Index>(i)] < 0;
  return signs;
}
std::array<int, 3> quadrants(const Joints& q) {
  const auto of = [&](Eigen::Index i) { return static_cast<int>(std::floor(q[i] / (pi / 2))); };
  return {of(0), of(3), of(5)};
}
std::array<int, 3> turns(const Joints& q) {
  const auto of = [&](Eigen::Index i) { return static_cast<int>(std::floor((q[i] + pi) / (2 * pi))); };
  return {of(0), of(3), of(5)};
}

/// The signs of what is zero where the wrist, the elbow and the shoulder change.
std::array<bool, 3> flips(const std::string& dialect, const Joints& q) {
  const double wrist = std::sin(q[4]);
  if (dialect == "ur") {
    const double out = 0.612 * std::cos(q[1]) + 0.5723 * std::cos(q[1] + q[2]) -
                       0.1157 * std::sin(q[1] + q[2] + q[3]);  // of the wrist, from the plane of axes 1 and 2
    return {wrist > 0, std::sin(q[2]) > 0, out > 0};
  }
  const double bend = std::atan2(0.041, 1.2), forearm = std::hypot(1.2, 0.041);
  const double out = 0.350 + 1.150 * std::cos(q[1]) + forearm * std::cos(q[1] + q[2] + bend);
  return {wrist > 0, std::sin(q[2] + bend) > 0, out > 0};
}

struct Place {
  Joints q;
  Matrix4 tip;
};

std::string numbers(const Matrix4& T, double unit, const std::vector<double>& orientation) {
  const Vector3 p = T.topRightCorner<3, 1>() / unit;
  std::vector<std::string> all;
  for (int i = 0; i < 3; ++i) all.push_back(fmt::format("{:.9f}", p[i]));
  for (const double number : orientation) all.push_back(fmt::format("{:.9f}", number));
  return fmt::format("{}", fmt::join(all, ","));
}

/// A joint move to `first` and a line to `last`. The robot stops at both.
std::string text_of(const std::string& dialect, const Place& first, const Place& last) {
  const auto rotation = [](const Place& at) { return Matrix3(at.tip.topLeftCorner<3, 3>()); };
  const auto abc = [&](const Place& at) { return angles_of(rotation(at)); };
  if (dialect == "kuka") {
    const auto target = [&](const Place& at) {
      const Vector3 p = at.tip.topRightCorner<3, 1>() / mm, a = abc(at);
      int bits = 0;
      for (std::size_t i = 0; i < 6; ++i) bits |= negative_axes(at.q)[i] << i;
      return fmt::format("{{X {:.9f},Y {:.9f},Z {:.9f},A {:.9f},B {:.9f},C {:.9f},S 2,T {}}}", p.x(), p.y(),
                         p.z(), a.x(), a.y(), a.z(), bits);
    };
    return "DEF part( )\n$VEL.CP=0.025\nPTP " + target(first) + "\nLIN " + target(last) + "\nEND\n";
  }
  if (dialect == "abb") {
    const auto target = [&](const Place& at) {
      const Eigen::Quaterniond h(rotation(at));
      const auto cf = quadrants(at.q);
      return fmt::format(
          "[[{:.9f},{:.9f},{:.9f}],[{:.9f},{:.9f},{:.9f},{:.9f}],[{},{},{},0],[9E9,9E9,9E9,9E9,"
          "9E9,9E9]]",
          at.tip(0, 3) / mm, at.tip(1, 3) / mm, at.tip(2, 3) / mm, h.w(), h.x(), h.y(), h.z(), cf[0], cf[1],
          cf[2]);
    };
    return "MODULE part\nPROC main()\n MoveJ " + target(first) + ",v100,fine,tool0;\n MoveL " + target(last) +
           ",v20,fine,tool0;\nENDPROC\nENDMODULE\n";
  }
  if (dialect == "ur") {
    const auto target = [&](const Place& at) {
      const Eigen::AngleAxisd turn(rotation(at));
      const Vector3 v = turn.angle() * turn.axis();
      return "p[" + numbers(at.tip, 1, {v.x(), v.y(), v.z()}) + "]";
    };
    return "def part():\n  movej(" + target(first) + ", a=1.0, v=0.3)\n  movel(" + target(last) +
           ", a=1.0, v=0.025)\nend\n";
  }
  const auto rzyx = [&](const Place& at) { return std::vector{abc(at).z(), abc(at).y(), abc(at).x()}; };
  if (dialect == "yaskawa") {
    const auto target = [&](const char* name, const Place& at) {
      const auto beyond = turns(at.q);
      return fmt::format("///RCONF 1,0,0,{},{},{},0,0\n{}=", beyond[1] != 0, beyond[2] != 0, beyond[0] != 0,
                         name) +
             numbers(at.tip, mm, rzyx(at)) + "\n";
    };
    return "/JOB\n//NAME PART\n//POS\n///NPOS 2,0,0,0,0,0\n///TOOL 2\n///POSTYPE BASE\n///RECTAN\n" +
           target("C00000", first) + target("C00001", last) +
           "//INST\n///DATE 2020/11/19 13:27\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\nMOVJ C00000 VJ=25.00 PL=0\n"
           "MOVL C00001 V=25.0 PL=0\nEND\n";
  }
  const auto target = [&](int number, const Place& at) {
    const auto n = turns(at.q);
    const std::vector<double> wpr = rzyx(at);
    return fmt::format(
        "P[{}]{{\n   GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, {}, {}, {}',\n X = {:.9f} mm, Y = {:.9f} mm, Z "
        "= "
        "{:.9f} mm,\n W = {:.9f} deg, P = {:.9f} deg, R = {:.9f} deg\n}};\n",
        number, n[0], n[1], n[2], at.tip(0, 3) / mm, at.tip(1, 3) / mm, at.tip(2, 3) / mm, wpr[0], wpr[1],
        wpr[2]);
  };
  return "/PROG PART\n/MN\n   1:J P[1] 100% FINE ;\n   2:L P[2] 25mm/sec FINE ;\n/POS\n" + target(1, first) +
         target(2, last) + "/END\n";
}

/// The poses of the two targets in a program that `text_of` wrote.
std::vector<Matrix4> poses_in(const std::string& dialect, const std::string& text) {
  const std::string n = "(-?[0-9]+\\.[0-9]{3,})", c = "\\]?,\\[?" + n;
  std::string pattern = n + c + c + c + c + c;  // Yaskawa, UR
  if (dialect == "kuka") pattern = "X " + n + ",Y " + n + ",Z " + n + ",A " + n + ",B " + n + ",C " + n;
  if (dialect == "abb") pattern += c;
  if (dialect == "fanuc_tp")
    pattern = "X = " + n + " mm, Y = " + n + " mm, Z = " + n + " mm,\\s*W = " + n + " deg, P = " + n +
              " deg, R = " + n;
  const std::regex regex(pattern);
  std::vector<Matrix4> poses;
  for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) {
    std::vector<double> v;
    for (std::size_t i = 1; i < at->size(); ++i) v.push_back(std::stod((*at)[i]));
    Matrix3 R;
    if (dialect == "abb")
      R = Eigen::Quaterniond(v[3], v[4], v[5], v[6]).normalized().toRotationMatrix();
    else if (dialect == "ur")
      R = Eigen::AngleAxisd(Vector3(v[3], v[4], v[5]).norm(), Vector3(v[3], v[4], v[5]).normalized())
              .toRotationMatrix();
    else
      R = rotation_of_words(dialect == "kuka" ? Vector3(v[5], v[4], v[3]) : Vector3(v[3], v[4], v[5]));
    poses.push_back(homogeneous(Vector3(v[0], v[1], v[2]) * (dialect == "ur" ? 1 : mm), R));
  }
  REQUIRE(poses.size() == 2);
  return poses;
}

/// A border: of an axis, at an angle of it.
struct Border {
  std::string of;  ///< "wrist", "elbow", "shoulder", or the borders of what a target states: "turns"
  int axis;
  double at_deg;
};

std::vector<Border> borders_of(const std::string& dialect) {
  if (dialect == "ur") {
    // The wrist is in the plane of axes 1 and 2 at this angle of axis 2.
    const Joints q = (Joints() << 0, 0, 100, -40, 70, 0).finished() * deg;
    const double along = 0.612 + 0.5723 * std::cos(q[2]) - 0.1157 * std::sin(q[2] + q[3]),
                 across = -0.5723 * std::sin(q[2]) - 0.1157 * std::cos(q[2] + q[3]);
    return {{"wrist", 4, 0},   {"wrist", 4, 180},
            {"elbow", 2, 0},   {"shoulder", 1, std::atan2(-along, across) / deg},
            {"turns", 0, 180}, {"turns", 3, 180},
            {"turns", 5, 180}};
  }
  const double bend = std::atan2(0.041, 1.2) / deg, forearm = std::hypot(1.2, 0.041),
               back = std::asin(0.35 / std::hypot(1.15, forearm)) / deg,
               elbow = std::atan2(forearm, 1.15) / deg;
  std::vector<Border> borders{{"wrist", 4, 0}, {"elbow", 2, -bend}, {"shoulder", 1, -90 - back - elbow}};
  for (const int axis : {0, 3, 5}) {
    if (dialect == "kuka") borders.push_back({"turns", axis, 0});
    if (dialect == "abb")
      for (const double at : {-180, -90, 0, 90}) borders.push_back({"turns", axis, at});
    if (dialect == "fanuc_tp" || dialect == "yaskawa")
      for (const double at : {-180, 180}) borders.push_back({"turns", axis, at});
  }
  if (dialect == "kuka") borders.push_back({"turns", 1, 0});
  return borders;
}

/// Joints (deg) at `border`, off by `off_deg`. Near no other border.
Joints joints_at(const std::string& dialect, const Border& border, double off_deg, std::mt19937& random) {
  std::uniform_real_distribution<double> some(-4, 4);
  Joints q = dialect == "ur" ? Joints((Joints() << 35, -100, 100, -40, 70, -35).finished())
                             : Joints((Joints() << 35, -70, 100, 40, 55, -35).finished());
  if (border.of == "shoulder" && dialect != "ur") q[2] = 90 - std::atan2(0.041, 1.2) / deg;
  if (border.of != "shoulder")
    for (double& angle : q) angle += some(random);
  q[border.axis] = border.at_deg + off_deg;
  return q;
}

std::string states(const std::string& dialect, const Joints& q) {
  if (dialect == "kuka") return fmt::format("{}", fmt::join(negative_axes(q), " "));
  if (dialect == "abb") return fmt::format("{}", fmt::join(quadrants(q), " "));
  return dialect == "ur" ? "" : fmt::format("{}", fmt::join(turns(q), " "));
}

struct Outcomes {
  int kept = 0, refused = 0;
};

/// A program whose joint move (or line) ends at the border.
void try_target(const std::string& dialect, const Border& border, bool line_ends_there, std::mt19937& random,
                Outcomes& outcomes) {
  std::uniform_real_distribution<double> off(0.0005, 0.0095);
  const double side = random() % 2 == 0 ? 1 : -1;
  const Joints there = joints_at(dialect, border, side * off(random), random),
               away = there + side * Joints::Constant(1.5), home = there + side * Joints::Constant(4);
  const auto place = [&](const Joints& q) { return Place{q * deg, tip_of(dialect, q * deg)}; };
  const std::array<Place, 2> places{place(line_ends_there ? away : there),
                                    place(line_ends_there ? there : away)};
  Order order{.machine = machine_at(dialect, home), .text = text_of(dialect, places[0], places[1])};
  order.max_correction = 20e-3;
  order.tolerance = 50e-6;
  order.read.dialect = dialect;
  CAPTURE(order.text);
  CAPTURE(home.transpose());
  const Compensation result = Shop(order).run();
  if (result.failure) {
    ++outcomes.refused;
    CAPTURE(result.failure->what);
    CHECK(result.failure->kind == ErrorKind::not_compensated);
    const std::string reason = border.of == "turns" ? "across" : border.of + ": ";
    CHECK(result.failure->what.find(reason) != std::string::npos);
    CHECK(result.failure->what.find("deg") != std::string::npos);
    return;
  }
  ++outcomes.kept;
  const std::vector<Matrix4> written = poses_in(dialect, result.text);
  for (std::size_t i = 0; i < 2; ++i) {
    CAPTURE(i);
    const Joints q = joints_near(dialect, places[i].q, written[i]);
    CHECK((q - places[i].q).norm() > 1e-5);  // it was corrected
    CHECK(flips(dialect, q) == flips(dialect, places[i].q));
    if (i == 0) CHECK(states(dialect, q) == states(dialect, places[i].q));  // a line takes the nearest turn
  }
}

}  // namespace

TEST_CASE("a target near another configuration is refused, or corrected without a change of configuration") {
  int targets = 0;
  for (const std::string dialect : {"kuka", "abb", "fanuc_tp", "yaskawa", "ur"}) {
    CAPTURE(dialect);
    std::mt19937 random(21);
    Outcomes at_turns, at_flips, lines;
    for (const Border& border : borders_of(dialect)) {
      CAPTURE(border.of);
      CAPTURE(border.axis);
      CAPTURE(border.at_deg);
      const bool turns = border.of == "turns";
      for (int k = 0; k < (turns ? dialect == "abb" ? 2 : 3 : 1); ++k)
        try_target(dialect, border, false, random, turns ? at_turns : at_flips);
      if (!turns || border.axis == 5) try_target(dialect, border, true, random, turns ? lines : at_flips);
    }
    CHECK(at_flips.kept == 0);
    CHECK(lines.refused == 0);
    CHECK(at_turns.kept > 0);
    CHECK((at_turns.refused > 0) == (dialect != "ur"));  // a target of UR states no turns
    for (const Outcomes& some : {at_turns, at_flips, lines}) targets += some.kept + some.refused;
    MESSAGE(dialect << ": " << at_flips.refused << " refused near a flip; at borders of turns "
                    << at_turns.refused << " refused, " << at_turns.kept + lines.kept << " kept");
  }
  CHECK(targets >= 100);
}
