#include "counterflex/report/analysis.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <sstream>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/nominal.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Model model_of(const std::string& name) {
  return prepare(load_machine(std::string(COUNTERFLEX_SOURCE_DIR) + "/tests/statics/data/" + name + ".toml"));
}

const Model& orthoglide() {
  static const Model model = model_of("orthoglide_case_b");
  return model;
}

Pose at_mm(double x, double y, double z) {
  return translation(Vector3(x, y, z) * mm);
}

// Q0 to Q4 of the paper.
std::vector<Pose> corners() {
  return {at_mm(0, 0, 0), at_mm(126.35, 126.35, 126.35), at_mm(-73.65, -73.65, -73.65),
          at_mm(126.35, 126.35, -73.65), at_mm(-73.65, -73.65, 126.35)};
}

Load cutting_load() {
  return {(Vector6() << 215, -10, -25, 1, 21.5, 0).finished()};
}

void check_near(const Vector3& actual, const Vector3& expected, double tolerance) {
  CAPTURE(actual.transpose());
  CAPTURE(expected.transpose());
  CHECK((actual - expected).cwiseAbs().maxCoeff() <= tolerance);
}

double largest_moment(const PoseAnalysis& pose) {
  double result = 0;
  for (const ChainLoads& chain : pose.chains) result = std::max(result, chain[LoadKind::moment]);
  return result;
}

double largest_group_moment(const PoseAnalysis& pose) {
  double result = 0;
  for (const ChainLoads& chain : pose.chains) result = std::max(result, chain[LoadKind::group_moment]);
  return result;
}

double largest_spring_rotation(const PoseAnalysis& pose) {
  double result = 0;
  for (const ChainLoads& chain : pose.chains) result = std::max(result, chain[LoadKind::spring_rotation]);
  return result;
}

// A machine with one chain of three slides and `element`.
Model chain_of(const std::string& element, const std::string& tables = "") {
  return prepare(read_machine("format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\", \"z\"]\n" +
                                  tables + R"(
[[chain]]
name = "c"
elements = [ { actuator = "prismatic", axis = "x" }, { actuator = "prismatic", axis = "y" }, { actuator = "prismatic", axis = "z" }, )" +
                                  element + " ]\n",
                              "test.toml"));
}

}  // namespace

// Source: the linear formulas (13), (15), (16) with the parameters identified for the paper's machine; its
// Table 2 agrees within its print.
TEST_CASE("the linear analysis of the Orthoglide after assembly gives Table 2 of the paper") {
  const double dt[5][3] = {{-0.002, -0.002, -0.002},
                           {0.410, 0.410, 0.410},
                           {-0.960, -0.960, -0.960},
                           {-0.911, 1.311, 0.578},
                           {0.928, -0.095, -0.247}};
  const double rotation[5][3] = {{0.030, 0.030, 0.030},
                                 {-0.622, -0.622, -0.622},
                                 {0.214, 0.214, 0.214},
                                 {-0.192, -0.484, 0.441},
                                 {0.332, 0.220, -0.299}};
  const double bars_deg[5] = {0.94, 1.71, 0.80, 1.52, 1.31};
  const AnalysisReport report = analyze(orthoglide(), corners(), {}, Method::linear, "0.1.0");
  REQUIRE(report.poses.size() == 5);
  for (int i = 0; i < 5; ++i) {
    CAPTURE(i);
    const PoseAnalysis& pose = report.poses[i];
    REQUIRE(pose.status == Status::converged);
    check_near(pose.deviation.head<3>() / mm, Eigen::Map<const Vector3>(dt[i]), 0.00051);
    check_near(pose.deviation.tail<3>() / deg, Eigen::Map<const Vector3>(rotation[i]), 0.00061);
    CHECK(std::abs(largest_spring_rotation(pose) / deg - bars_deg[i]) < 0.006);
  }
  const double moments[3] = {2.09, 8.92, 1.48}, group_moments[3] = {2.09, 11.96, 1.74};
  for (int i = 0; i < 3; ++i) {
    CHECK(std::abs(largest_moment(report.poses[i]) - moments[i]) < 0.0051);
    CHECK(std::abs(largest_group_moment(report.poses[i]) - group_moments[i]) < 0.0051);
  }
  CHECK(std::abs(largest_group_moment(report.poses[4]) - 4.00) < 0.0051);
}

// Source: tests/statics/data/orthoglide_assembly.json, computed by an independent solver.
TEST_CASE("the direct analysis of the Orthoglide after assembly is that of an independent solver") {
  const double dp_mm[5][3] = {{-0.007944182, -0.007944182, -0.007944182},
                              {0.400775744, 0.400775744, 0.400775744},
                              {-0.98655742, -0.98655742, -0.98655742},
                              {-0.93050963, 1.307834928, 0.573971072},
                              {0.923042006, -0.105355717, -0.253314768}};
  const double drot_deg[5][3] = {{0.029606722, 0.029606722, 0.029606722},
                                 {-0.624474275, -0.624474275, -0.624474275},
                                 {0.217693752, 0.217693752, 0.217693752},
                                 {-0.191701732, -0.488749766, 0.438270342},
                                 {0.32983496, 0.218184742, -0.297880104}};
  const AnalysisReport report = analyze(orthoglide(), corners(), {}, Method::direct, "0.1.0");
  for (int i = 0; i < 5; ++i) {
    CAPTURE(i);
    check_near(report.poses[i].deviation.head<3>() / mm, Eigen::Map<const Vector3>(dp_mm[i]), 2e-9);
    check_near(report.poses[i].deviation.tail<3>() / deg, Eigen::Map<const Vector3>(drot_deg[i]), 2e-9);
  }
}

// Source: tests/statics/data/orthoglide_line.json, case B at y = 126.35.
TEST_CASE(
    "direct and nested analysis under the milling load give the corrected target of an independent solver") {
  for (const Method method : {Method::direct, Method::nested}) {
    const PoseAnalysis pose =
        analyze_pose(orthoglide(), at_mm(-73.65, 126.35, -73.65), cutting_load(), method);
    REQUIRE(pose.status == Status::converged);
    check_near(pose.deviation.head<3>() / mm, {0.1021297766, -0.3779462547, 0.7415413124}, 2e-9);
    check_near(pose.rho / mm, {-37.0172828971, 144.3562361658, -37.0172828971}, 2e-9);
    REQUIRE(pose.corrected);
    CHECK(pose.corrected->status == Status::converged);
    check_near(pose.corrected->rho / mm, {-36.744478233, 144.9481660443, -37.5580653903}, 2e-9);
    check_near((pose.corrected->X_MT.p - pose.X_MT.p) / mm, {-0.1031457055, 0.3775806572, -0.743259099},
               2e-9);
  }
}

TEST_CASE("the linear corrected target takes the linear deviation from the wanted one") {
  const PoseAnalysis pose = analyze_pose(orthoglide(), at_mm(20, -30, 10), cutting_load(), Method::linear);
  REQUIRE(pose.corrected);
  check_near(pose.corrected->X_MT.p, pose.X_MT.p - pose.deviation.head<3>(), 1e-15);
  CHECK(pose.corrected->X_MT.R.isIdentity(1e-12));
}

TEST_CASE("the chains' wrenches balance the load") {
  const PoseAnalysis pose = analyze_pose(orthoglide(), at_mm(20, -30, 10), cutting_load(), Method::direct);
  Vector6 sum = Vector6::Zero();
  for (const ChainLoads& chain : pose.chains) sum += chain.wrench;
  CHECK((sum - cutting_load().F).norm() < 1e-6);
}

TEST_CASE(
    "without load the stiffness of the linear analysis is symmetric, and its softest direction deflects "
    "most") {
  const PoseAnalysis pose = analyze_pose(orthoglide(), at_mm(126.35, 126.35, -73.65), {}, Method::linear);
  REQUIRE(pose.stiffness_available);
  CHECK((pose.K - pose.K.transpose()).norm() < 1e-9 * pose.K.norm());
  REQUIRE(pose.tip_compliance);
  CHECK(pose.tip_compliance->isApprox(pose.K.inverse(), 1e-9));  // the tip is at the reference point
  const Matrix3 C = pose.tip_compliance->topLeftCorner<3, 3>();
  CHECK(pose.softest.dot(C * pose.softest) == doctest::Approx(1 / pose.softest_stiffness).epsilon(1e-9));
  for (const Vector3& e : {Vector3(Vector3::UnitX()), Vector3(Vector3::UnitY()), Vector3(Vector3::UnitZ())})
    CHECK(e.dot(C * e) <= 1 / pose.softest_stiffness * (1 + 1e-9));
}

// Source: an independent solver; a force at the reference point would meet 1.012 N/um.
TEST_CASE("the softest direction of a robot is that of a force at its tip") {
  const Model model =
      prepare(load_machine(std::string(COUNTERFLEX_SOURCE_DIR) + "/samples/robot-spindle/machine.toml"));
  const AnalysisReport report =
      analyze(model, {tip(model.mechanism, model.home)}, {}, Method::linear, "0.1.0");
  CHECK(report.poses[0].softest_stiffness == doctest::Approx(0.590e6).epsilon(1e-3));
  CHECK(contains(to_text(report), ": 0.590 N/um\n"));
  CHECK(contains(to_text(report), "Stiffness at the tool tip"));
  CHECK(contains(to_text(report), "      rx, urad "));
}

// Without the tool the same force at the same tip gives the machine's springs and joints the same loads.
TEST_CASE("an elastic tool does not count in the loads of a pose, and every chain keeps its row") {
  const struct {
    const char* sample;
    Pose X_MT;
  } cases[] = {{"mill3", at_mm(200, 100, -200)}, {"orthoglide-groove", at_mm(0, 0, 0)}};
  for (const auto& [sample, X_MT] : cases) {
    const auto& shown = sample;
    CAPTURE(shown);
    const Machine machine =
        load_machine(std::string(COUNTERFLEX_SOURCE_DIR) + "/samples/" + sample + "/machine.toml");
    const Model base = prepare(machine);
    const Tool tool{.yields = radial_tool(2e6)};
    const Model bent = prepare_with_tool(machine, base, tool);
    const Load load{(Vector6() << 100, 0, 0, 0, 0, 0).finished()};
    const Pose at{tip(base.mechanism, base.home).R, X_MT.p};
    const PoseAnalysis rigid = analyze_pose(base, at, load, Method::direct);
    const PoseAnalysis pose = analyze_pose(bent, at, load, Method::direct, {&base.mechanism});
    REQUIRE(pose.status == Status::converged);
    REQUIRE(pose.chains.size() == rigid.chains.size());
    for (std::size_t i = 0; i < pose.chains.size(); ++i) {
      CHECK(pose.chains[i].name == rigid.chains[i].name);
      CHECK(pose.chains[i][LoadKind::moment] ==
            doctest::Approx(rigid.chains[i][LoadKind::moment]).epsilon(0.01));
      CHECK(pose.chains[i][LoadKind::spring_translation] ==
            doctest::Approx(rigid.chains[i][LoadKind::spring_translation]).epsilon(0.01));
      CHECK(pose.chains[i][LoadKind::spring_rotation] ==
            doctest::Approx(rigid.chains[i][LoadKind::spring_rotation]).epsilon(0.01));
    }
  }
}

TEST_CASE("an analysis in full names every joint and spring, and gives each chain's matrices") {
  const AnalysisReport report =
      analyze(orthoglide(), {at_mm(20, -30, 10)}, cutting_load(), Method::direct, "0.1.0", {.full = true});
  REQUIRE(report.poses[0].details.size() == 3);
  const std::string json = to_json(report), text = to_text(report);
  for (const char* key : {"\"full\": [", "\"energy_J\": ", "\"eps_si\": [", "\"dt_si\": [", "\"K_Cq_si\": [",
                          "\"K_Ctheta_rows\": [\"5 spring x\", ", "\"element\": \"7/upper_bar/4\""})
    CHECK(contains(json, key));
  CHECK(contains(text, "  7/lower_bar/4 spring rz "));
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    CAPTURE(line);
    CHECK(line.size() <= 100);
    CHECK((line.empty() || line.back() != ' '));
  }
  CHECK_FALSE(
      contains(to_json(analyze(orthoglide(), {at_mm(0, 0, 0)}, {}, Method::direct, "0.1.0")), "\"full\""));
}

TEST_CASE("a held pose has the wrench that holds it, a curve its points, in text, JSON and CSV") {
  AnalysisExtras extras;
  extras.hold = at_mm(0.1, 0, 0);
  extras.curve = CurveRequest{Vector3::UnitX(), 0, 0.1e-3, 2};
  const AnalysisReport report = analyze(orthoglide(), {at_mm(0, 0, 0)}, {}, Method::direct, "0.1.0", extras);
  const PoseAnalysis& pose = report.poses[0];
  REQUIRE(pose.held);
  REQUIRE(pose.held->status == Status::converged);
  Vector6 sum = Vector6::Zero();
  for (const ChainDetail& chain : pose.held->chains) sum += chain.wrench;
  CHECK((sum - pose.held->at_platform).norm() < 1e-9);
  CHECK(pose.held->at_tip.norm() > 1);
  REQUIRE(pose.curve);
  REQUIRE(pose.curve->points.size() == 3);
  REQUIRE(pose.tip_compliance);
  CHECK(pose.curve->points[0].stiffness == doctest::Approx(1 / (*pose.tip_compliance)(0, 0)).epsilon(1e-6));
  CHECK(contains(to_json(report), "\"wrench_at_tip_N_Nm\": ["));
  CHECK(contains(to_json(report), "\"displacement_mm\": 0.05,"));
  CHECK(contains(to_text(report), "Held with the tip at (0.1000, 0.0000, 0.0000) mm"));
  CHECK(to_csv(report).starts_with(
      "pose,displacement_mm,force_N,stiffness_N_per_m,stable,x_mm,y_mm,z_mm\n1,0."));
}

TEST_CASE("a stated force and the force of a curve name what acts beside them") {
  AnalysisExtras extras;
  extras.curve = CurveRequest{Vector3::UnitX(), 0, 0.1e-3, 2};
  AnalysisReport report = analyze(orthoglide(), {at_mm(0, 0, 0)}, {}, Method::direct, "0.1.0", extras);
  CHECK(contains(to_text(report), ", no load\n"));
  CHECK(contains(to_text(report), "from its place without force\n"));
  report.preloaded = true;
  CHECK(contains(to_text(report), ", no load but the machine's preloads\n"));
  CHECK(contains(to_text(report), "under the machine's preloads, to which this force adds\n"));
  report.weighs = true;
  report.load.F[0] = 10;
  CHECK(contains(to_text(report), "\nwhich acts in addition to the machine's own weight and preloads\n"));
  CHECK(contains(to_text(report), "under --force and the machine's own weight and preloads, to which"));
}

TEST_CASE("a pose outside the actuators' travel is analyzed and marked") {
  const PoseAnalysis pose = analyze_pose(orthoglide(), at_mm(-140, 0, 0), {}, Method::direct);
  CHECK(pose.status == Status::outside_travel);
  CHECK(pose.why.find("is outside its travel (") != std::string::npos);
  CHECK(pose.deviation.norm() > 0);
  CHECK(pose.chains.size() == 3);
}

TEST_CASE("a pose out of reach has a status, words, and nulls instead of numbers") {
  AnalysisReport report = analyze(orthoglide(), {at_mm(5000, 0, 0)}, {}, Method::direct, "0.1.0");
  CHECK(report.poses[0].status != Status::converged);
  CHECK_FALSE(report.poses[0].why.empty());
  const std::string json = to_json(report);
  for (const char* key :
       {"displacement_mm", "rotation_deg", "stiffness_si", "actuators", "corrected", "condition"})
    CHECK(contains(json, std::string("\"") + key + "\": null"));
  CHECK(contains(json, "\"chains\": []"));
  CHECK(contains(to_text(report), "pose 1: " + report.poses[0].why));
}

TEST_CASE("a machine that controls nothing is analyzed without a corrected target") {
  const Model model = model_of("two_chains_equal");
  const AnalysisReport report =
      analyze(model, {tip(model.mechanism, model.home)}, {(Vector6() << 1, 0, 0, 0, 0, 0).finished()},
              Method::direct, "0.1.0");
  REQUIRE(report.poses[0].status == Status::converged);
  CHECK_FALSE(report.poses[0].corrected);
  CHECK(contains(to_json(report), "\"corrected\": null"));
  CHECK(contains(to_text(report), "undefined: the machine controls no component of the tip"));
}

TEST_CASE("the JSON of an analysis has its keys in order and lists on one line") {
  AnalysisReport report;
  report.version = "0.1.0";
  report.machine = "Two axes";
  report.load.F << 1, 2, 3, 0, 0, 0;
  report.travel = {{-1, 1, JointKind::prismatic}, {-1, 1, JointKind::revolute}};
  PoseAnalysis pose;
  pose.X_MT = at_mm(1, 2, 3);
  pose.status = Status::converged;
  pose.deviation << 1e-4, 0, 0, 0, 0, 0.5 * deg;
  pose.rho = Eigen::Vector2d(10 * mm, 20 * deg);
  pose.K = 1e6 * Matrix6::Identity();
  pose.stiffness_available = true;
  pose.corrected = CorrectedTarget{at_mm(0.9, 2, 3), Eigen::Vector2d(9.9 * mm, 20 * deg), Status::converged};
  pose.chains = {{"leg", (Vector6() << 1, 2, 3, 0, 0, 0).finished(), 4, 5 * mm, 6 * deg, 7, 8, 9, 10 * deg}};
  report.poses = {pose};
  CHECK(to_json(report) == R"({
  "schema": "counterflex-analysis 1",
  "tool": "counterflex 0.1.0",
  "machine": "Two axes",
  "wrench_N_Nm": [1.0, 2.0, 3.0, 0.0, 0.0, 0.0],
  "wrench_at": "tip",
  "poses": [
    {
      "target_mm": [1.0, 2.0, 3.0],
      "target_rpy_deg": [0.0, 0.0, 0.0],
      "method": "direct",
      "status": "converged",
      "why": null,
      "displacement_mm": [0.1, 0.0, 0.0],
      "rotation_deg": [0.0, 0.0, 0.5],
      "stiffness_si": [
        [1000000.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 1000000.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 1000000.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1000000.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 1000000.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 1000000.0]
      ],
      "tip_stiffness_si": null,
      "tip_compliance_si": null,
      "weakest_direction": null,
      "weakest_stiffness_N_per_m": 0.0,
      "softest_direction": null,
      "softest_stiffness_N_per_m": null,
      "indeterminate_wrenches": false,
      "condition": 0.0,
      "stability": 0.0,
      "actuators": [10.0, 20.0],
      "corrected": {
        "target_mm": [0.9, 2.0, 3.0],
        "rpy_deg": [0.0, 0.0, 0.0],
        "actuators": [9.9, 20.0],
        "status": "converged"
      },
      "chains": [
        {
          "name": "leg",
          "wrench_N_Nm": [1.0, 2.0, 3.0, 0.0, 0.0, 0.0],
          "moment_max_Nm": 4.0,
          "spring_translation_max_mm": 5.0,
          "spring_rotation_max_deg": 6.0,
          "spring_force_max_N": 7.0,
          "spring_torque_max_Nm": 8.0,
          "group_moment_max_Nm": 9.0,
          "passive_change_max_deg": 10.0
        }
      ]
    }
  ]
}
)");
}

TEST_CASE("the tables of an analysis fit 100 columns, without trailing blanks") {
  const AnalysisReport report = analyze(orthoglide(), corners(), cutting_load(), Method::direct, "0.1.0");
  const std::string text = to_text(report);
  CHECK(contains(text,
                 "Orthoglide, method direct\nload (215.00, -10.00, -25.00) N, (1.000, 21.500, 0.000) N m"));
  CHECK(contains(
      text,
      "    2    126.350    126.350    126.350   1.0279   0.0400  -0.0771  -0.1820  -0.4070  -0.2052\n"));
  CHECK(contains(text, "    1 nominal      0.0000 mm      0.0000 mm      0.0000 mm\n"));
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    CAPTURE(line);
    CHECK(line.size() <= 100);
    CHECK((line.empty() || line.back() != ' '));
  }
}

TEST_CASE("an analysis states that the machine's own weight acts") {
  Machine machine =
      load_machine(std::string(COUNTERFLEX_SOURCE_DIR) + "/samples/orthoglide-groove/machine.toml");
  machine.gravity.g = {0, 0, -9.81};
  CHECK(
      to_text(analyze(prepare(machine), {at_mm(0, 0, 0)}, {}, Method::direct, "0.1.0")).find(", no load\n") !=
      std::string::npos);
  machine.chains[0].elements.push_back(PointMass{4, Vector3::Zero()});
  const Model model = prepare(machine);
  CHECK(to_text(analyze(model, {at_mm(0, 0, 0)}, {}, Method::direct, "0.1.0"))
            .find(", no load but the machine's own weight\n") != std::string::npos);
  const Load cut{(Vector6() << 10, 0, 0, 0, 0, 0).finished(), false};
  CHECK(to_text(analyze(model, {at_mm(0, 0, 0)}, cut, Method::direct, "0.1.0"))
            .find("which acts in addition to the machine's own weight\n") != std::string::npos);
}

namespace {

/// Two bars of 2 N/um, pinned 600 mm apart, whose common end `h` mm above them is guided along z.
Model shallow_truss(double h) {
  const double angle = std::atan2(h, 300.0) / deg, length = std::hypot(h, 300.0);
  const auto bar = [&](const char* name, double x, double turn) {
    return fmt::format(
        "[[chain]]\nname = \"{}\"\nelements = [\n{{ rigid = {{ xyz_mm = [{}, 0, 0], rpy_deg = [0, 0, {}] }} "
        "}},\n"
        "{{ passive = \"revolute\", axis = \"y\", home_deg = {} }},\n{{ rigid = {{ xyz_mm = [{}, 0, 0] }} "
        "}},\n"
        "{{ compliance = \"prismatic\", axis = \"x\", stiffness_N_per_m = 2e6 }},\n"
        "{{ passive = \"revolute\", axis = \"y\", home_deg = {} }},\n{{ rigid = {{ rpy_deg = [0, 0, {}] }} "
        "}},\n]\n",
        name, x, turn, -angle, length, angle, -turn);
  };
  return prepare(read_machine(
      fmt::format("format = \"counterflex-machine 1\"\ncontrolled = []\n[home]\nxyz_mm = [0, 0, {}]\n", h) +
          bar("left", -300, 0) + bar("right", 300, 180) +
          fmt::format(
              "[[chain]]\nname = \"guide\"\nelements = [\n{{ passive = \"prismatic\", axis = \"x\" }},\n"
              "{{ passive = \"prismatic\", axis = \"z\", home_mm = {} }},\n]\n",
              h),
      "truss.toml"));
}

/// N: the load at which it snaps through. The closed form is that of samples/truss.
double snapping_load(double h) {
  const double b = 0.3, L0 = std::hypot(b, h * mm), L = std::cbrt(L0 * b * b);
  return 2 * 2e6 * (L0 - L) * std::sqrt(L * L - b * b) / L;
}

}  // namespace

TEST_CASE("an analysis finds no state beyond a limit point, however far beyond it the load is") {
  for (const double h : {1.0, 7.14, 20.0}) {
    const Model model = shallow_truss(h);
    for (const double share : {0.95, 1.05, 10.0, 64.0, 20000.0}) {
      CAPTURE(h);
      CAPTURE(share);
      const Load load{(Vector6() << 0, 0, -share * snapping_load(h), 0, 0, 0).finished(), false};
      const Status status =
          analyze(model, {at_mm(0, 0, h)}, load, Method::direct, "0.1.0").poses.front().status;
      CHECK((status == Status::converged) == (share < 1));
    }
  }
}

TEST_CASE("a state that is not reached by increasing the load is reported as unstable") {
  const Model model = model_of("lifted_truss");
  const auto status_under = [&](double N) {
    const Load load{(Vector6() << 0, 0, -N, 0, 0, 0).finished(), false};
    return analyze(model, {at_mm(0, 0, 5)}, load, Method::direct, "0.1.0").poses.front().status;
  };
  CHECK(status_under(30) == Status::converged);
  CHECK(status_under(100) == Status::unstable);
}

TEST_CASE("the curve of a rigid direction has its reason in words, and no number for its stiffness") {
  AnalysisExtras extras;
  extras.curve = CurveRequest{Vector3::UnitX(), 0, 1e-3, 1};
  const AnalysisReport report =
      analyze(chain_of("{ compliance = \"prismatic\", axis = \"z\", stiffness_N_per_m = 1e7 }"),
              {at_mm(0, 0, 0)}, {}, Method::direct, "0.1.0", extras);
  CHECK(contains(to_text(report),
                 "            0.0000             rigid   stable\n"
                 "      singular: the machine is rigid along this direction: a force along it does not "
                 "move the tip\n"));
  CHECK(contains(to_json(report), "\"why\": \"the machine is rigid along this direction: "));
  CHECK(contains(to_json(report), "\"stiffness_N_per_m\": null"));
  CHECK(contains(to_csv(report), "\n1,0.000000000,0,,1,0.000000000,"));
}

TEST_CASE("a very soft machine has its stiffness in significant digits, and its columns stay apart") {
  const Model model =
      chain_of("{ spring = \"k\" }", "springs.k = { stiffness_diag_si = [400, 4e4, 123456, 10, 10, 10] }");
  const Load load{(Vector6() << 400, 0, 0, 0, 0, 0).finished(), false};
  const std::string text = to_text(analyze(model, {at_mm(0, 0, 0)}, load, Method::direct, "0.1.0"));
  CHECK(contains(text, "along x, y, z: 0.0004, 0.040, 0.123 N/um\n"));
  CHECK(contains(text, "softest to a force at the tip along (1.000, 0.000, 0.000): 0.0004 N/um\n"));
  CHECK(contains(text, "   0.000 1000.0000   0.0000   0.0000   0.0000"));
}

TEST_CASE("a sprung joint that is relaxed is not a preload") {
  const auto text = [](const std::string& preload) {
    return to_text(analyze(chain_of("{ parallel = [\"a\", \"b\"] }",
                                    "branches.a = { elements = [ { compliance = \"revolute\", axis = \"z\", "
                                    "stiffness_Nm_per_rad = 1e5 } ] }\n"
                                    "branches.b = { elements = [ { passive = \"revolute\", axis = \"z\", "
                                    "stiffness_Nm_per_rad = 1e5" +
                                        preload + " } ] }"),
                           {at_mm(0, 0, 0)}, {}, Method::direct, "0.1.0"));
  };
  CHECK(contains(text(""), ", no load\n"));
  CHECK(contains(text(", preload_deg = 0.01"), ", no load but the machine's preloads\n"));
}
