#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cmath>

#include "counterflex/import/import.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/statics/nominal.hpp"
#include "import/arm_poses.hpp"

namespace counterflex::import_dh_test {
namespace {

struct DhRow {
  double a, alpha, d, theta;  // m, rad
  bool prismatic = false;
};

const std::vector<DhRow> ur10 = {{0, pi / 2, 0.1273, 0},   {-0.612, 0, 0, 0},       {-0.5723, 0, 0, 0},
                                 {0, pi / 2, 0.163941, 0}, {0, -pi / 2, 0.1157, 0}, {0, 0, 0.0922, 0}};
const std::vector<DhRow> bent = {{0.31, 1.1, 0.52, 0.4}, {-0.2, -0.7, 0.1, -0.9, true},
                                 {0.77, 2.4, -0.3, 1.7}, {0.05, -1.5, 0.9, 0.1},
                                 {0, 1.6, 0.02, -2.2},   {0.11, 0.3, 0.2, 0.6}};

std::string table_of(const std::vector<DhRow>& rows) {
  std::string text = "joint,type,a_m,alpha_rad,d_m,theta_rad\n";
  char line[200];
  for (const DhRow& row : rows) {
    std::snprintf(line, sizeof line, "axis,%s,%.17g,%.17g,%.17g,%.17g\n",
                  row.prismatic ? "prismatic" : "revolute", row.a, row.alpha, row.d, row.theta);
    text += line;
  }
  return text;
}

/// The matrices of textbooks, written out.
Pose standard_link(double a, double alpha, double d, double theta) {
  const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(alpha), sa = std::sin(alpha);
  Pose X;
  X.R << ct, -st * ca, st * sa, st, ct * ca, -ct * sa, 0, sa, ca;
  X.p << a * ct, a * st, d;
  return X;
}

Pose modified_link(double a, double alpha, double d, double theta) {
  const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(alpha), sa = std::sin(alpha);
  Pose X;
  X.R << ct, -st, 0, st * ca, ct * ca, -sa, st * sa, ct * sa, ca;
  X.p << a, -sa * d, ca * d;
  return X;
}

template <class Link>
Pose dh_pose(const std::vector<DhRow>& rows, const std::vector<double>& q, const Link& link) {
  Pose X;
  for (std::size_t i = 0; i < rows.size(); ++i)
    X = X * link(rows[i].a, rows[i].alpha, rows[i].d + (rows[i].prismatic ? q[i] : 0),
                 rows[i].theta + (rows[i].prismatic ? 0 : q[i]));
  return X;
}

std::string message_of(const std::string& text) {
  return diagnostic([&] { import_dh(text, "arm.csv", DhConvention::standard); });
}

}  // namespace

TEST_CASE("an imported DH table has the poses of the DH matrices at 1000 random joint vectors") {
  for (const auto& rows : {ur10, bent}) {
    check_poses(import_dh(table_of(rows), "arm.csv", DhConvention::standard),
                [&](const std::vector<double>& q) { return dh_pose(rows, q, standard_link); });
    check_poses(import_dh(table_of(rows), "arm.csv", DhConvention::modified),
                [&](const std::vector<double>& q) { return dh_pose(rows, q, modified_link); });
  }
}

TEST_CASE("lengths and angles of a DH table are those of the file, in its units, with decimal commas too") {
  const Machine dots =
      read_machine(import_dh("a_mm,alpha_deg,d_mm,theta_deg,min_deg,max_deg\n-612.5,90,127.3,0,-180,175\n",
                             "arm.csv", DhConvention::standard),
                   "m.toml");
  const Machine commas = read_machine(
      import_dh("a_m;alpha_rad;d_mm;theta_deg;min_deg;max_deg\n-0,6125;1,5707963267948966;127,3;0;-180;175\n",
                "arm.csv", DhConvention::standard),
      "m.toml");
  for (const Machine& machine : {dots, commas}) {
    const Pose X = platform_pose(machine, {0});
    CHECK(X.p == Vector3(-0.6125, 0, 0.1273));
    CHECK(log_so3(X.R).x() == doctest::Approx(pi / 2).epsilon(1e-14));
    CHECK(actuators(machine)[0].min == doctest::Approx(-pi));
    CHECK(actuators(machine)[0].max == doctest::Approx(175 * deg));
  }
}

TEST_CASE(
    "the home of an imported arm is regular, and every joint has an error slot and a compliance with a "
    "source, and a place for harmonics") {
  const Machine machine =
      read_machine(import_dh(table_of(ur10), "arm.csv", DhConvention::standard), "m.toml");
  CHECK(controls_pose(machine));
  const Model model = prepare(machine);
  REQUIRE(model.home_status == Status::converged);
  CHECK(actuator_jacobian(model, model.home).condition < 100);
  CHECK(parameters(machine).size() == 6 * (7 + 4));
  const NumberSources sources = number_sources(machine);
  CHECK(sources.prior == 6 * 7);
  CHECK(is_unmeasured(machine));
}

TEST_CASE("an arm of fewer than six joints controls as many components as it has joints") {
  const std::string scara =
      "type,a_mm,alpha_deg,d_mm,theta_deg,min_mm,max_mm\nrevolute,325,0,400,0,,\nrevolute,225,180,0,0,,\n"
      "prismatic,0,0,0,0,0,150\nrevolute,0,0,50,0,,\n";
  const Machine machine = read_machine(import_dh(scara, "scara.csv", DhConvention::standard), "m.toml");
  CHECK(machine.controlled ==
        std::vector<Component>{Component::x, Component::y, Component::z, Component::rz});
  const Model model = prepare(machine);
  CHECK(model.home_status == Status::converged);
  CHECK(actuator_jacobian(model, model.home).condition < 1e3);
}

TEST_CASE("a table of more than six joints can be analysed, and its file shows what to do") {
  std::vector<DhRow> rows = ur10;
  rows.insert(rows.begin(), {0, pi / 2, 0, 0, true});
  const std::string text = import_dh(table_of(rows), "rail.csv", DhConvention::standard);
  CHECK(read_machine(text, "m.toml").controlled.empty());
  CHECK(text.find("PLACEHOLDER: of more than six joints, make the external axes program_axis") != text.npos);
}

TEST_CASE("home values of the table are those of the machine") {
  const std::string text = import_dh("a_mm,alpha_deg,d_mm,theta_deg,home_deg\n300,0,0,0,10\n200,0,0,0,-75\n",
                                     "arm.csv", DhConvention::standard);
  const std::vector<Actuator> all = actuators(read_machine(text, "m.toml"));
  CHECK(all[0].home == doctest::Approx(10 * deg));
  CHECK(all[1].home == doctest::Approx(-75 * deg));
}

TEST_CASE("bad DH tables are refused at their place") {
  const std::string header = "a_mm,alpha_deg,d_mm,theta_deg\n";
  CHECK(message_of("") == "arm.csv:1:1: error: the table is empty; its first line names the columns");
  CHECK(message_of("# comment\n" + header) ==
        "arm.csv:2:1: error: the table has no joint; each line behind the header is one");
  CHECK(message_of("a_mm,alfa_deg,d_mm,theta_deg\n")
            .starts_with("arm.csv:1:6: error: unknown column 'alfa_deg'; did you mean alpha_deg?; allowed: "
                         "joint, type, a_mm, a_m"));
  CHECK(message_of("a_mm,alpha_deg,theta_deg\n0,0,0\n") ==
        "arm.csv:1:1: error: column d is missing: a table has a, alpha, d and theta of each joint, with the "
        "unit in the name "
        "(d_mm or d_m)");
  CHECK(message_of("a_mm,a_m,alpha_deg,d_mm,theta_deg\n") ==
        "arm.csv:1:6: error: column 'a_m' repeats 'a_mm'; remove one");
  CHECK(message_of(header + "0,90,nan,0\n") ==
        "arm.csv:2:6: error: d_mm is 'nan'; it must be a finite number");
  CHECK(message_of(header + "0,90, 12.5mm,0\n") ==
        "arm.csv:2:7: error: d_mm is '12.5mm'; it must be a finite number");
  CHECK(message_of(header + "0,90,1e30,0\n") ==
        "arm.csv:2:6: error: d_mm is 1e30; it must be at most 1e9 in size");
  CHECK(message_of(header + "0,90,1\n") ==
        "arm.csv:2:1: error: the row has 3 cells, the header has 4 columns");
  CHECK(message_of(header + "0,,1,0\n") == "arm.csv:2:3: error: alpha_deg is empty; a joint needs it");
  CHECK(message_of("type," + header + "spherical,0,0,0,0\n") ==
        "arm.csv:2:1: error: type is 'spherical'; it must be revolute or prismatic");
  CHECK(message_of("min_mm," + header + "5,0,0,0,0\n") ==
        "arm.csv:2:1: error: min_mm is given for a revolute joint; leave the cell empty");
  CHECK(message_of("min_deg,max_deg," + header + "10,-10,0,0,0,0\n") ==
        "arm.csv:2:1: error: the joint's max is not above its min");
  const std::string homes = "min_deg,max_deg,home_deg," + header;
  CHECK(message_of(homes + "-90,90,100,0,0,0,0\n") ==
        "arm.csv:2:1: error: the joint's home, 100 deg, is outside its travel from -90 deg to 90 deg");
  CHECK(message_of(homes + ",90,100,0,0,0,0\n") ==
        "arm.csv:2:1: error: the joint's home, 100 deg, is above its max, 90 deg");
  CHECK(message_of("type,min_m,home_mm," + header + "prismatic,0.1,50,0,0,0,0\n") ==
        "arm.csv:2:1: error: the joint's home, 50 mm, is below its min, 100 mm");
  CHECK_NOTHROW(
      import_dh(homes + "-90,90,90,0,0,0,0\n-90,90,-90,0,90,0,0\n", "arm.csv", DhConvention::standard));
}

}  // namespace counterflex::import_dh_test
