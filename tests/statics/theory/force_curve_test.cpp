#include <cmath>

#include "counterflex/statics/tip_stiffness.hpp"
#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

constexpr double half_span = 0.3, height = 0.02, k_bar = 2e6;

// Two bars, axially elastic, pinned 600 mm apart; their common end 20 mm above, guided so that it does not
// turn.
const char* const truss = R"(
controlled = []
[home]
xyz_mm = [0, 0, 20]
[[chain]]
name = "left"
elements = [ { rigid = { xyz_mm = [-300, 0, 0] } }, { passive = "revolute", axis = "y", home_deg = -3.814074834 },
             { rigid = { xyz_mm = [300.665927567, 0, 0] } }, { compliance = "prismatic", axis = "x", stiffness_N_per_m = 2e6 },
             { passive = "revolute", axis = "y", home_deg = 3.814074834 } ]
[[chain]]
name = "right"
elements = [ { rigid = { xyz_mm = [300, 0, 0], rpy_deg = [0, 0, 180] } }, { passive = "revolute", axis = "y", home_deg = -3.814074834 },
             { rigid = { xyz_mm = [300.665927567, 0, 0] } }, { compliance = "prismatic", axis = "x", stiffness_N_per_m = 2e6 },
             { passive = "revolute", axis = "y", home_deg = 3.814074834 }, { rigid = { rpy_deg = [0, 0, -180] } } ]
[[chain]]
name = "guide"
elements = [ { passive = "prismatic", axis = "x" }, { passive = "prismatic", axis = "z", home_mm = 20 } ]
)";

// P = 2 k (L_0 - L) (h - w) / L,  L^2 = b^2 + (h - w)^2
double truss_force(double w) {
  const double L_0 = std::hypot(half_span, height), L = std::hypot(half_span, height - w);
  return 2 * k_bar * (L_0 - L) * (height - w) / L;
}

// dP/dw = 0:  L^3 = L_0 b^2
double truss_limit() {
  const double L = std::cbrt(std::hypot(half_span, height) * half_span * half_span);
  return height - std::sqrt(L * L - half_span * half_span);
}

// All translations are equally stiff: what the compression takes from the lever, the shear of the middle adds
// to it.
std::string strut(double rigid) {
  const std::string k = std::to_string(rigid), translations = k + ", " + k + ", " + k;
  return "controlled = [\"x\"]\n[home]\nxyz_mm = [1000, 0, 0]\n[springs.mid]\nstiffness_diag_si = [" +
         translations + ", 1e5, 1000, 1e5]\n[springs.guide]\nstiffness_diag_si = [" + translations +
         ", 1e5, 1e5, 1e5]\n" + R"([[chain]]
name = "strut"
elements = [ { actuator = "prismatic", axis = "x" }, { passive = "revolute", axis = "y" }, { rigid = { xyz_mm = [500, 0, 0] } },
             { spring = "mid" }, { rigid = { xyz_mm = [500, 0, 0] } }, { passive = "revolute", axis = "y" } ]
[[chain]]
name = "guide"
elements = [ { rigid = { xyz_mm = [1000, 0, 0] } }, { passive = "prismatic", axis = "x" }, { spring = "guide" } ]
)";
}

}  // namespace

// Source: the closed form above.
TEST_CASE("the curve of a two-bar truss is its closed form, before its limit point and beyond") {
  const Model model = model_of_text(truss);
  REQUIRE(model.home_status == Status::converged);
  StaticsWork work(model.mechanism);
  const CurveRequest down{-Vector3::UnitZ(), 0, 0.045, 45};
  const ForceCurve curve = force_curve(model, model.home, down, work);
  REQUIRE(curve.status == Status::converged);
  REQUIRE(curve.points.size() == 46);
  for (const CurvePoint& point : curve.points) {
    CAPTURE(point.displacement);
    CHECK(point.force == doctest::Approx(truss_force(point.displacement)).epsilon(1e-6).scale(1000));
    const double h = 1e-5, w = point.displacement;
    CHECK(point.stiffness ==
          doctest::Approx((truss_force(w + h) - truss_force(w - h)) / (2 * h)).epsilon(1e-4).scale(1e5));
    const bool between = w > truss_limit() && w < 2 * height - truss_limit();
    CHECK(point.stable == !between);
  }
  REQUIRE(curve.critical.size() == 1);
  CHECK(curve.critical[0].displacement == doctest::Approx(truss_limit()).epsilon(1e-6));
  CHECK(curve.critical[0].force == doctest::Approx(truss_force(truss_limit())).epsilon(1e-6));
}

TEST_CASE("a snap-through between two stable points of a curve has its critical load") {
  const Model model = model_of_text(truss);
  StaticsWork work(model.mechanism);
  for (const CurveRequest& wide :
       {CurveRequest{-Vector3::UnitZ(), 0, 0.045, 1}, CurveRequest{-Vector3::UnitZ(), 0, 0.09, 2},
        CurveRequest{-Vector3::UnitZ(), 0.040, 0.045, 1}}) {
    const ForceCurve curve = force_curve(model, model.home, wide, work);
    REQUIRE(curve.status == Status::converged);
    CHECK(curve.points.back().stable);
    REQUIRE(curve.critical.size() == 1);
    CHECK(curve.critical[0].force == doctest::Approx(truss_force(truss_limit())).epsilon(1e-6));
  }
}

// Source: a pinned strut of two rigid halves of length a with a rotational spring k in its middle buckles at
// 2k/a.
TEST_CASE("the critical load of a pinned strut is 2k/a") {
  for (const double rigid : {1e6, 1e7}) {
    CAPTURE(rigid);
    const Model model = model_of_text(strut(rigid));
    StaticsWork work(model.mechanism);
    const double end = 5000 / rigid;
    const ForceCurve curve = force_curve(model, model.home, {Vector3::UnitX(), 0, -end, 10}, work);
    REQUIRE(curve.status == Status::converged);
    REQUIRE(curve.critical.size() == 1);
    CHECK(curve.critical[0].force == doctest::Approx(-4000).epsilon(1e-5));
    CHECK(curve.points.front().force == doctest::Approx(-5000).epsilon(1e-6));
    CHECK_FALSE(curve.points.front().stable);
    CHECK(curve.points.back().stable);
  }
}

TEST_CASE("the force of a curve puts the tip where the curve defines") {
  for (const char* name : {"orthoglide_case_b", "serial6r_joints", "hexapod_joint_springs"}) {
    CAPTURE(name);
    const Model model = model_of(name);
    StaticsWork work(model.mechanism);
    const Vector3 direction = Vector3(1, -2, 2) / 3;
    const Load besides{(Vector6() << 10, 20, -5, 0, 1, 0).finished(), false};
    const ForceCurve curve = force_curve(model, model.home, {direction, -1e-4, 2e-4, 3, besides}, work);
    REQUIRE(curve.status == Status::converged);
    REQUIRE(curve.points.size() == 4);
    CHECK(curve.critical.empty());
    const Equilibrium free = solve_forward(model, model.home, besides, {}, work);
    for (const CurvePoint& point : curve.points) {
      Load load = besides;
      load.F.head<3>() += point.force * direction;
      const Equilibrium found = solve_forward(model, model.home, load, {}, work);
      REQUIRE(found.status == Status::converged);
      const Pose X = tip(model.mechanism, found.configuration);
      CHECK((X.p - point.X_MT.p).norm() < 1e-10);
      CHECK(direction.dot(X.p - tip(model.mechanism, free.configuration).p) ==
            doctest::Approx(point.displacement).epsilon(1e-6));
    }
  }
}

TEST_CASE("along a direction in which the machine is rigid a curve is singular, and its stiffness infinite") {
  const Model model = model_of_text(R"(controlled = ["x"]
[[chain]]
name = "slide"
elements = [ { actuator = "prismatic", axis = "x" }, { compliance = "prismatic", axis = "z", stiffness_N_per_m = 1e7 } ]
)");
  StaticsWork work(model.mechanism);
  const ForceCurve x = force_curve(model, model.home, {Vector3::UnitX(), 0, 1e-3, 1}, work);
  CHECK(x.rigid);
  CHECK(x.status == Status::singular);
  REQUIRE(x.points.size() == 1);
  CHECK(std::isinf(x.points[0].stiffness));
  const ForceCurve oblique =
      force_curve(model, model.home, {Vector3(1, 0, 1).normalized(), 0, 1e-3, 1}, work);
  CHECK_FALSE(oblique.rigid);
  REQUIRE(oblique.status == Status::converged);
  CHECK(oblique.points[0].stiffness == doctest::Approx(2e7).epsilon(1e-9));
  CHECK(force_curve(model, model.home, {Vector3::UnitX(), 1e-3, 2e-3, 1}, work).points.empty());
}
