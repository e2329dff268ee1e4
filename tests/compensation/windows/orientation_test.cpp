// Programs that turn the tool of a six-axis machine: position and orientation are corrected. What the machine
// does is judged by the arm of the tests.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <regex>
#include <vector>

#include "compensation/support/arm.hpp"
#include "compensation/support/shop.hpp"
#include "counterflex/program/rewrite.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr char turning[] =
    "G21 G90 G17 G94\n"
    "G0 X-20 Y-10 Z40 A0 B0 C0\n"
    "G0 Z5\n"
    "G1 Z0 F500\n"
    "X100 A12 B-8 F1500\n"
    "X140 Y60 A-10 B10 C40\n"
    "G3 X120 Y80 I-20 J0 C60\n"
    "G1 A5 (turns in place)\n"
    "X0 Y0 Z10 A0 B0 C-20\n"
    "G0 Z40\n"
    "M30\n";

const Vector3 corner(1.75, 0.05, 0.6);

Order turning_order(const std::string& text = turning) {
  Order order{.machine = arm_machine(), .text = text};
  order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  order.X_MW = translation(corner);
  order.read.dialect = "linuxcnc";
  order.read.tool_orientation = true;
  return order;
}

}  // namespace

TEST_CASE("the tip of the product is that of an independent arm, before and after, at every waypoint") {
  const Shop shop(turning_order());
  const Compensation result = compensated(shop);
  const Arm arm;
  int judged = 0;
  double largest_before = 0;
  for (const Waypoint& w : result.waypoints) {
    REQUIRE(w.R_MT);
    CAPTURE(w.line);
    CAPTURE(w.fraction);
    const Matrix3 R_command = *commanded_orientation(w);
    const Matrix4 after = arm.tip(homogeneous(w.p_MT + w.correction.head<3>(), R_command), w.wrench),
                  before = arm.tip(homogeneous(w.p_MT, *w.R_MT), w.wrench);
    const Vector3 after_shift = after.topRightCorner<3, 1>() - w.p_MT,
                  before_shift = before.topRightCorner<3, 1>() - w.p_MT;
    CHECK((after_shift - w.after.head<3>()).norm() < 1e-9);
    CHECK(std::abs(angle_between(after.topLeftCorner<3, 3>(), *w.R_MT) - w.after.tail<3>().norm()) < 1e-8);
    if (knows_before(w)) {
      CHECK((before_shift - w.before.head<3>()).norm() < 1e-9);
      largest_before = std::max(largest_before, before_shift.norm());
    }
    ++judged;
  }
  CHECK(judged > 100);
  CHECK(largest_before > 0.5e-3);
}

TEST_CASE("the written program leads the independent arm along the path, in the orientation of each place") {
  const Order order = turning_order();
  const Shop shop(order);
  const Compensation result = compensated(shop);
  const Arm arm;
  const Program written = read_program(result.text, "out.ngc", order.read);
  REQUIRE(written.left_alone.empty());
  // The original's ends, in their order, and each moves' end in the corrected program.
  std::size_t next = 0;
  int ends = 0;
  for (const Move& original : shop.program.moves) {
    const Vector3 p = corner + original.end_mm * mm;
    const Matrix3 R = rotation_of_words(
        {original.orientation->end[0], original.orientation->end[1], original.orientation->end[2]});
    const Vector6 F = original.motion == Motion::feed
                          ? Vector6((Vector6() << 120, -300, -80, 2, 5, -3).finished())
                          : Vector6(Vector6::Zero());
    double best = HUGE_VAL, turned = HUGE_VAL;
    for (std::size_t k = next; k < std::min(next + 12, written.moves.size()); ++k) {
      const Move& move = written.moves[k];
      const auto& abc = move.orientation->end;
      const Matrix4 tip =
          arm.tip(homogeneous(corner + move.end_mm * mm, rotation_of_words({abc[0], abc[1], abc[2]})), F);
      const double miss = (tip.topRightCorner<3, 1>() - p).norm(),
                   turn = angle_between(tip.topLeftCorner<3, 3>(), R);
      if (miss + turn >= best + turned) continue;
      best = miss, turned = turn, next = k;
    }
    CAPTURE(original.line);
    CHECK(best < 5e-6);
    CHECK(turned < 0.02 * deg);
    ++ends;
  }
  CHECK(ends == 9);
}

TEST_CASE("a perfect arm leaves every byte of a program that turns the tool") {
  Order order = turning_order();
  const std::string text =
      replaced(replaced(read_file(robot), "errors.base = { rpy_deg = [0, 0.02, 0] }", ""),
               "errors.joint_2 = { rpy_deg = [0, 0.05, 0] }", "");
  order.machine = read_machine(
      replaced(replaced(replaced(text, "{ error = \"base\" },", ""), "{ error = \"joint_2\" },", ""),
               "xyz_mm = [250, 0, 120]", "xyz_mm = [250, 0, 120]\nrpy_deg = [0, -90, 0]"),
      "perfect.toml");
  order.force = {};
  CHECK(compensated(Shop(order)).text == turning);
}

TEST_CASE("batches and single solves give the same text where the tool turns") {
  Order order = turning_order();
  const std::string text = compensated(Shop(order)).text;
  order.in_batches = false;
  CHECK(compensated(Shop(order)).text == text);
}

TEST_CASE("verification finds a tilt, a spin where it is asked for, and an orientation of another line") {
  const Order order = turning_order();
  Shop shop(order);
  const std::string text = compensated(shop).text;
  const auto verdict = [&](const std::string& changed) {
    return verify(shop.job(), read_program(changed, "out.ngc", order.read), false).failure;
  };
  const Program written = read_program(text, "out.ngc", order.read);
  CHECK(!verdict(text));
  const auto with_angle = [&](std::size_t angle, double change_deg) {
    std::vector<MoveEdit> edits;
    for (std::size_t m = 0; m < written.moves.size(); ++m) {
      const Move& move = written.moves[m];
      MoveEdit edit{.move = m, .end_mm = move.end_mm, .orientation = move.orientation->end};
      if (move.arc) edit.centre_mm = move.arc->centre_mm;
      (*edit.orientation)[angle] += change_deg;
      edits.push_back(edit);
    }
    return rewrite(written, edits, {}).text;
  };
  CHECK(!verdict(with_angle(0, 0.004)));
  const auto tilted = verdict(with_angle(0, 0.05));
  REQUIRE(tilted);
  CHECK(tilted->what.find("tilted") != std::string::npos);
  CHECK(verdict(with_angle(1, -0.05)));
  CHECK(verdict(with_angle(2, 90)));  // degrees for something else
  CHECK(verdict(with_angle(0, 180)));
}

namespace {

constexpr char turns_in_place[] =
    "G21 G90 G17 G94\nG0 X0 Y0 Z20 A0 B0 C0\nG1 Z0 F300\nN40 X50\nN50 A30 C10\nN60 X60\nG0 Z40\nM30\n";

double turned_by(const Move& move) {
  const OrientationNumbers &a = move.orientation->start, &b = move.orientation->end;
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

/// Minutes by the rule of RS274/NGC: F is in mm/min if X, Y or Z moves, else in deg/min.
double minutes_of(const Move& move) {
  const double way_mm = (move.end_mm - move.start_mm).norm();
  return (way_mm > 0 ? way_mm : turned_by(move)) / move.feed_mm_min;
}

}  // namespace

TEST_CASE("a block that only turns the tool takes the time of the original, evenly") {
  const Order order = turning_order(turns_in_place);
  const Shop shop(order);
  const Compensation result = compensated(shop);
  const Program written = read_program(result.text, "out.ngc", order.read);
  const double wanted = std::hypot(30, 10) / 300;
  double minutes = 0;
  int pieces = 0;
  for (const Move& move : written.moves) {
    if (move.motion != Motion::feed || turned_by(move) < 0.1) continue;
    CHECK(minutes_of(move) == doctest::Approx(turned_by(move) / 300).epsilon(1e-4));
    minutes += minutes_of(move);
    ++pieces;
  }
  CHECK(pieces > 1);
  CHECK(minutes == doctest::Approx(wanted).epsilon(1e-3));
  CHECK(written.moves[written.moves.size() - 2].feed_mm_min == 300);
  // Verified from its start to its end.
  double last = 0, gap = 0;
  for (const Waypoint& w : result.waypoints) {
    if (w.line != 5) continue;
    gap = std::max(gap, w.fraction - last);
    last = w.fraction;
  }
  CHECK(last == 1);
  CHECK(gap < 0.2);
}

TEST_CASE("a block that only turns the tool is verified also where other points would be chosen") {
  const Order order = turning_order(turns_in_place);
  Shop shop(order);
  const Program written = read_program(compensated(shop).text, "out.ngc", order.read);
  for (const double tolerance : {4e-6, 4.5e-6, 6e-6, 20e-6}) {
    CAPTURE(tolerance);
    shop.options.tolerance = tolerance;
    const auto failure = verify(shop.job(), written, false).failure;
    CHECK((!failure || failure->what.find("the tip misses the path") != std::string::npos));
  }
}

TEST_CASE("pieces of a turn that take another time, or leave another F, are found") {
  const Order order = turning_order(turns_in_place);
  const Shop shop(order);
  const std::string text = compensated(shop).text;
  const auto verdict = [&](const std::string& changed) {
    const auto failure = verify(shop.job(), read_program(changed, "out.ngc", order.read), false).failure;
    return failure ? failure->what : "";
  };
  CHECK(verdict(text).empty());
  const std::string no_feeds = std::regex_replace(text, std::regex(" F[0-9.]+\n"), "\n"),
                    same_feed = replaced(no_feeds, "G1 ", "G1 F300 ");
  CHECK(verdict(same_feed).find("in 2") != std::string::npos);
  CHECK(verdict(std::regex_replace(text, std::regex(" F300.\n"), " F301.\n")) != "");
  CHECK(verdict(std::regex_replace(text, std::regex(" F300.\n"), "\n")) != "");
}

TEST_CASE("a turn about the tool's axis is judged only where its tolerance is given") {
  // A cutter that stands along Z: C turns it about its own axis.
  const std::string upright = "G21 G90 G94\nG0 X0 Y0 Z20 A0 B0 C0\nG1 Z0 F300\nX50 C30\nM30\n";
  Order order = turning_order(upright);
  Shop shop(order);
  const std::string text = compensated(shop).text;
  Program written = read_program(text, "out.ngc", order.read);
  std::vector<MoveEdit> edits;
  for (std::size_t m = 0; m < written.moves.size(); ++m) {
    const Move& move = written.moves[m];
    MoveEdit edit{.move = m, .end_mm = move.end_mm, .orientation = move.orientation->end};
    (*edit.orientation)[2] += 0.002;  // the tip is on the axis, so it stays
    edits.push_back(edit);
  }
  const Program spun = read_program(rewrite(written, edits, {}).text, "out.ngc", order.read);
  CHECK(!verify(shop.job(), spun, false).failure);
  shop.options.spin_tolerance = 0.001 * deg;
  const auto failure = verify(shop.job(), spun, false).failure;
  REQUIRE(failure);
  CHECK(failure->what.find("about its axis") != std::string::npos);
}

namespace {

/// Targets of one path: position (mm), and angles about fixed axes (deg); the first and the last one are
/// rapids.
struct PathTarget {
  Vector3 p_mm, abc_deg;
};
const std::vector<PathTarget> targets{{{1730, 40, 640}, {0, 0, 0}},   {{1730, 40, 600}, {0, 0, 0}},
                                      {{1850, 50, 601}, {12, -8, 0}}, {{1890, 110, 600}, {-10, 10, 40}},
                                      {{1760, 60, 610}, {3, 0, -20}}, {{1760, 60, 650}, {0, 0, 0}}};

Eigen::Quaterniond quaternion(const PathTarget& t) {
  return Eigen::Quaterniond(rotation_of_words(t.abc_deg));
}

/// A language: how it writes a target, and how this test finds the numbers of one in a text.
struct Language {
  const char *name, *head;
  std::string tail;
  std::string (*statement)(const PathTarget&, bool rapid);
  std::regex target;
  Pose (*pose)(const std::array<double, 7>&);
  /// Of a language with a list of targets above its statements: what is between them, and a statement.
  const char* instructions = "";
  std::string (*instruction)(std::size_t index, bool rapid) = nullptr;
};

Pose of_angles(const Vector3& p_mm, const Vector3& abc_deg) {
  return {rotation_of_words(abc_deg), p_mm * mm};
}

const std::string number = "(-?[0-9.]+)";

/// The positions of a FANUC program.
std::string tp_positions_of_targets() {
  std::string text = "/POS\n";
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const PathTarget& t = targets[i];
    text += fmt::format(
        "P[{}]{{\n GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = {:.6f} mm, Y = {:.6f} mm, Z = "
        "{:.6f} "
        "mm,\n W = {:.6f} deg, P = {:.6f} deg, R = {:.6f} deg\n}};\n",
        i + 1, t.p_mm.x(), t.p_mm.y(), t.p_mm.z(), t.abc_deg.x(), t.abc_deg.y(), t.abc_deg.z());
  }
  return text + "/END\n";
}

std::vector<Language> languages() {
  return {
      {"linuxcnc", "G21 G90\n", "M30\n",
       [](const PathTarget& t, bool rapid) {
         return fmt::format("{} X{:.6f} Y{:.6f} Z{:.6f} A{:.6f} B{:.6f} C{:.6f} F1500\n", rapid ? "G0" : "G1",
                            t.p_mm.x(), t.p_mm.y(), t.p_mm.z(), t.abc_deg.x(), t.abc_deg.y(), t.abc_deg.z());
       },
       std::regex("X" + number + " Y" + number + " Z" + number + " A" + number + " B" + number + " C" +
                  number),
       [](const std::array<double, 7>& n) {
         return of_angles({n[0], n[1], n[2]}, {n[3], n[4], n[5]});
       }},
      {"kuka", "DEF part( )\n$VEL.CP=0.025\n", "END\n",
       [](const PathTarget& t, bool rapid) {
         return fmt::format("{} {{X {:.6f},Y {:.6f},Z {:.6f},A {:.6f},B {:.6f},C {:.6f}}}{}\n",
                            rapid ? "PTP" : "LIN", t.p_mm.x(), t.p_mm.y(), t.p_mm.z(), t.abc_deg.z(),
                            t.abc_deg.y(), t.abc_deg.x(), rapid ? "" : " C_DIS");
       },
       std::regex("X " + number + ",Y " + number + ",Z " + number + ",A " + number + ",B " + number + ",C " +
                  number),
       [](const std::array<double, 7>& n) {
         return of_angles({n[0], n[1], n[2]}, {n[5], n[4], n[3]});
       }},
      {"abb", "MODULE part\nPROC main()\nConfJ\\Off;\n", "ENDPROC\nENDMODULE\n",
       [](const PathTarget& t, bool rapid) {
         const Eigen::Quaterniond q = quaternion(t);
         return fmt::format(
             "{} [[{:.6f},{:.6f},{:.6f}],[{:.9f},{:.9f},{:.9f},{:.9f}],[0,0,0,0],"
             "[9E9,9E9,9E9,9E9,9E9,9E9]],v25,z1,tool0;\n",
             rapid ? "MoveJ" : "MoveL", t.p_mm.x(), t.p_mm.y(), t.p_mm.z(), q.w(), q.x(), q.y(), q.z());
       },
       std::regex("\\[\\[" + number + "," + number + "," + number + "\\],\\[" + number + "," + number + "," +
                  number + "," + number + "\\]"),
       [](const std::array<double, 7>& n) {
         return Pose{Eigen::Quaterniond(n[3], n[4], n[5], n[6]).normalized().toRotationMatrix(),
                     Vector3(n[0], n[1], n[2]) * mm};
       }},
      {"ur", "def part():\n", "end\n",
       [](const PathTarget& t, bool rapid) {
         const Eigen::AngleAxisd turn(quaternion(t));
         const Vector3 p = t.p_mm * mm, phi = turn.angle() * turn.axis();
         return fmt::format("  {}(p[{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}],a=1,v=0.025{})\n",
                            rapid ? "movej" : "movel", p.x(), p.y(), p.z(), phi.x(), phi.y(), phi.z(),
                            rapid ? "" : ",r=0.001");
       },
       std::regex("p\\[" + number + "," + number + "," + number + "," + number + "," + number + "," + number +
                  "\\]"),
       [](const std::array<double, 7>& n) {
         const Vector3 phi(n[3], n[4], n[5]);
         return Pose{Eigen::AngleAxisd(phi.norm(), phi.stableNormalized()).toRotationMatrix(),
                     Vector3(n[0], n[1], n[2])};
       }},
      {"fanuc_tp", "/PROG part\n/MN\n", tp_positions_of_targets(),
       [](const PathTarget& t, bool rapid) {
         const auto i = &t - targets.data() + 1;
         return fmt::format("{0}:{1} P[{0}] {2} ;\n", i, rapid ? "J" : "L",
                            rapid ? "50% FINE" : "25mm/sec CNT100");
       },
       std::regex("X = +" + number + " mm, Y = +" + number + " mm, Z = +" + number + " mm,\n W = +" + number +
                  " deg, P = +" + number + " deg, R = +" + number + " deg"),
       [](const std::array<double, 7>& n) {
         return of_angles({n[0], n[1], n[2]}, {n[3], n[4], n[5]});
       }},
      {"yaskawa", "/JOB\n//POS\n///NPOS 6,0,0,0,0,0\n///POSTYPE BASE\n///RECTAN\n", "END\n",
       [](const PathTarget& t, bool) {
         const auto index = static_cast<std::size_t>(&t - targets.data());
         return fmt::format("C{:05}={:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", index, t.p_mm.x(),
                            t.p_mm.y(), t.p_mm.z(), t.abc_deg.x(), t.abc_deg.y(), t.abc_deg.z());
       },
       std::regex("C[0-9]+=" + number + "," + number + "," + number + "," + number + "," + number + "," +
                  number),
       [](const std::array<double, 7>& n) {
         return of_angles({n[0], n[1], n[2]}, {n[3], n[4], n[5]});
       },
       "//INST\nNOP\n",
       [](std::size_t index, bool rapid) {
         return fmt::format("{} C{:05} {}\n", rapid ? "MOVJ" : "MOVL", index, rapid ? "VJ=5.00" : "V=25.0");
       }},
  };
}

/// The poses of the targets in a text, in order.
std::vector<Pose> poses_in(const std::string& text, const Language& language) {
  std::vector<Pose> poses;
  for (std::sregex_iterator at(text.begin(), text.end(), language.target), end; at != end; ++at) {
    std::array<double, 7> numbers{};
    for (std::size_t i = 1; i < at->size(); ++i) numbers[i - 1] = std::stod((*at)[i]);
    poses.push_back(language.pose(numbers));
  }
  return poses;
}

/// The pose nearest to a target of the original: its own corrected one.
Pose corrected(const std::vector<Pose>& poses, const PathTarget& target) {
  const auto off = [&](const Pose& X) {
    return (X.p - target.p_mm * mm).norm() + 0.01 * angle_between(X.R, rotation_of_words(target.abc_deg));
  };
  return *std::min_element(poses.begin(), poses.end(),
                           [&](const Pose& a, const Pose& b) { return off(a) < off(b); });
}

}  // namespace

TEST_CASE("one path in seven languages has the same corrected targets, to the written digit") {
  std::vector<std::vector<Pose>> found;
  for (const Language& language : languages()) {
    CAPTURE(language.name);
    std::string text = language.head;
    for (std::size_t i = 0; i < targets.size(); ++i)
      text += language.statement(targets[i], i == 0 || i + 1 == targets.size());
    text += language.instructions;
    for (std::size_t i = 0; language.instruction != nullptr && i < targets.size(); ++i)
      text += language.instruction(i, i == 0 || i + 1 == targets.size());
    Order order = turning_order(text + language.tail);
    order.X_MW = {};
    order.read.dialect = language.name;
    const Compensation result = compensated(Shop(order));
    const std::vector<Pose> poses = poses_in(result.text, language);
    REQUIRE(poses.size() > targets.size());  // points were inserted
    std::vector<Pose>& of_targets = found.emplace_back();
    for (const PathTarget& target : targets) of_targets.push_back(corrected(poses, target));
    of_targets.front() = poses.front();  // the first cut begins beside it, where a point was inserted
  }
  for (std::size_t k = 1; k < found.size(); ++k)
    for (std::size_t i = 0; i < targets.size(); ++i) {
      CAPTURE(k);
      CAPTURE(i);
      CHECK((found[k][i].p - found[0][i].p).norm() < 2e-9);
      CHECK(angle_between(found[k][i].R, found[0][i].R) < 5e-8);
      CHECK((found[k][i].p - targets[i].p_mm * mm).norm() > 1e-5);  // they were corrected
    }
}

TEST_CASE("a tool frame of the control with any axis along the spindle has the same corrections") {
  const Language kuka = languages()[1];
  std::vector<std::vector<Pose>> found, original;
  constexpr double rounding = 2 * 3 * 0.5e-4 * deg;  // inserted targets have angles of four decimals
  for (const SpindleAxis axis :
       {SpindleAxis::z, SpindleAxis::minus_z, SpindleAxis::x, SpindleAxis::minus_y}) {
    std::string text = kuka.head;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const Matrix3 R = rotation_of_words(targets[i].abc_deg) * tool_axes(axis).transpose();
      const OrientationNumbers words = numbers_of(OrientationForm::fixed_axes, R, {});
      text += kuka.statement({targets[i].p_mm, {words[0], words[1], words[2]}},
                             i == 0 || i + 1 == targets.size());
    }
    Order order = turning_order(text + kuka.tail);
    order.X_MW = {};
    order.read.dialect = "kuka";
    order.read.spindle_axis = axis;
    const Compensation result = compensated(Shop(order));
    std::vector<Pose>& poses = found.emplace_back(poses_in(result.text, kuka));
    REQUIRE(poses.size() > targets.size());
    for (Pose& X : poses) X.R = X.R * tool_axes(axis);
    std::vector<Pose>& of_targets = original.emplace_back();
    for (const PathTarget& target : targets) of_targets.push_back(corrected(poses, target));
    of_targets.front() = poses.front();
  }
  for (std::size_t k = 1; k < found.size(); ++k) {
    CAPTURE(k);
    REQUIRE(found[k].size() == found[0].size());
    for (std::size_t i = 0; i < found[0].size(); ++i) {
      CAPTURE(i);
      CHECK((found[k][i].p - found[0][i].p).norm() < 2e-9);
      CHECK(angle_between(found[k][i].R, found[0][i].R) < rounding);
    }
    for (std::size_t i = 0; i < targets.size(); ++i) {
      CAPTURE(i);
      CHECK(angle_between(original[k][i].R, original[0][i].R) < 5e-8);
    }
  }
}
