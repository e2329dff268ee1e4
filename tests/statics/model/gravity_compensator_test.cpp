// A gravity compensator is a branch beside a joint: a spring whose line of action goes from the arm's base to
// its link. Against the moments of both forces about the joint.
#include <fmt/format.h>

#include <cmath>

#include "counterflex/files/files.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/nominal.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

constexpr double arm_weight = 9.81 * 100, gear_compliance = 1e-6;  // N, rad/(N m)
constexpr double spring_stiffness = 20000, relaxed = 0.7;          // of the compensator: N/m, m
const Vector3 anchor(-0.4, 0, 0.3), lug(0.3, 0, 0), end(1, 0, 0);

/// The machine file's values at home, where the joint is at zero.
std::string arm_text() {
  const Vector3 line = lug - anchor;
  const double pitch_deg = std::atan2(-line.z(), line.x()) / deg;
  return fmt::format(R"(controlled = ["z"]
gravity_m_s2 = [0, 0, -9.81]
gravity_reference = "unloaded"
[branches.shoulder]
elements = [
  {{ actuator = "revolute", axis = "y", min_deg = -80, max_deg = 80 }},
  {{ compliance = "revolute", axis = "y", compliance_rad_per_Nm = 1e-6 }},
]
[branches.compensator]
elements = [
  {{ rigid = {{ xyz_mm = [-400, 0, 300], rpy_deg = [0, {0:.15g}, 0] }} }},
  {{ passive = "revolute", axis = "y" }},
  {{ passive = "revolute", axis = "z" }},
  {{ passive = "prismatic", axis = "x", home_mm = {1:.15g}, stiffness_N_per_m = 20000, preload_mm = 700 }},
  {{ passive = "revolute", axis = "x" }},
  {{ passive = "revolute", axis = "y" }},
  {{ passive = "revolute", axis = "z" }},
  {{ rigid = {{ rpy_deg = [0, -{0:.15g}, 0] }} }},
  {{ rigid = {{ xyz_mm = [-300, 0, 0] }} }},
]
[[chain]]
name = "arm"
elements = [
  {{ parallel = ["shoulder", "compensator"] }},
  {{ rigid = {{ xyz_mm = [1000, 0, 0] }}, mass = {{ kg = 100 }} }},
]
)",
                     pitch_deg, line.norm() / mm);
}

Vector3 turned_about_y(const Vector3& p, double angle) {
  return Vector3(std::cos(angle) * p.x() + std::sin(angle) * p.z(), p.y(),
                 std::cos(angle) * p.z() - std::sin(angle) * p.x());
}

/// Moment about y of weight and compensator, with the link at `angle`.
double moment_at(double angle) {
  const Vector3 at = turned_about_y(lug, angle), line = anchor - at;
  const Vector3 pull = spring_stiffness * (line.norm() - relaxed) * line.normalized();
  return (at.cross(pull) + turned_about_y(end, angle).cross(Vector3(0, 0, -arm_weight))).y();
}

/// The angle at which the gearbox, at `commanded`, holds both.
double held_at(double commanded) {
  double angle = commanded;
  for (int i = 0; i < 60; ++i) angle = commanded + gear_compliance * moment_at(angle);
  return angle;
}

}  // namespace

TEST_CASE("a gravity compensator pulls along its line of action") {
  const Model model = model_of_text(arm_text());
  REQUIRE(model.home_status == Status::converged);
  for (const double commanded : {-60 * deg, -20 * deg, 0.0, 25 * deg, 70 * deg}) {
    CAPTURE(commanded);
    const NominalResult nominal = nominal_forward(model, model.home, Eigen::VectorXd::Constant(1, commanded));
    REQUIRE(nominal.status == Status::converged);
    StaticsWork work(model.mechanism);
    const Equilibrium e = solve_forward(model, nominal.configuration, {}, {}, work);
    REQUIRE(e.status == Status::converged);
    const Vector3 found = tip(model.mechanism, e.configuration).p,
                  wanted = turned_about_y(end, held_at(commanded));
    CHECK((found - wanted).norm() < 1e-9);
    const double alone =
        commanded + gear_compliance * turned_about_y(end, commanded).cross(Vector3(0, 0, -arm_weight)).y();
    CHECK((turned_about_y(end, alone) - wanted).norm() > 3e-5);  // what the compensator takes
  }
}

TEST_CASE("the numbers of the compensator in the guide are those of its line at home") {
  const std::string guide = read_file(COUNTERFLEX_SOURCE_DIR "/programs/guide/machine.md");
  const Vector3 line = lug - anchor;
  const double pitch = std::atan2(-line.z(), line.x()) / deg;
  CHECK(guide.find(fmt::format("xyz_mm = [-400, 0, 300], rpy_deg = [0, {:.10g}, 0]", pitch)) !=
        std::string::npos);
  CHECK(guide.find(fmt::format("{{ rigid = {{ rpy_deg = [0, {:.10g}, 0] }} }}", -pitch)) !=
        std::string::npos);
  CHECK(guide.find(fmt::format("home_mm = {:.10g}, stiffness_N_per_m = 20000, preload_mm = 700",
                               line.norm() / mm)) != std::string::npos);
}
