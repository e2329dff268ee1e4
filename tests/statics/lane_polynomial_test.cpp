/// Polynomials that stand for nominal kinematics.
#include "lane_polynomial.hpp"

#include "lane_zone.hpp"
#include "lanes_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

TEST_CASE("a fit reproduces every polynomial of its degree, and none of a higher one") {
  for (const int degree : {2, 6, 7, 8, 10}) {
    CAPTURE(degree);
    const PolynomialFit& fit = polynomial_fit(degree);
    const auto largest_miss = [&](const auto& f) {
      Eigen::VectorXd values(static_cast<Eigen::Index>(fit.points.size()));
      for (std::size_t i = 0; i < fit.points.size(); ++i)
        values[static_cast<Eigen::Index>(i)] = f(fit.points[i]);
      const Eigen::VectorXd coefficients = fit.from_values * values;
      double miss = 0;
      for (const Vector3& x : polynomial_checks())
        miss = std::max(miss, std::abs(monomials(x, degree).dot(coefficients) - f(x)));
      return miss;
    };
    CHECK(largest_miss([&](const Vector3& x) {
            return std::pow(0.3 * x[0] - 0.5 * x[1] + 0.2 * x[2] + 0.1, degree);
          }) <= 2e-12);
    CHECK(largest_miss([&](const Vector3& x) { return (std::pow(x[0], degree) - 3 * x[1] * x[2] + 7) / 11; }) <=
          2e-12);
    CHECK(largest_miss([&](const Vector3& x) { return std::pow(x[0], degree + 1); }) > 1e-4);
    CHECK(largest_miss([&](const Vector3& x) { return std::abs(x[0]); }) > 1e-3);
  }
}

TEST_CASE("monomials stand from the highest power of x down, as the kernels read them") {
  const Eigen::RowVectorXd values = monomials({2, 3, 5}, 1);
  CHECK(values == Eigen::RowVector4d(2, 3, 5, 1));
  CHECK(monomials({2, 3, 5}, 2).size() == monomial_count(2));
  CHECK(monomials({2, 3, 5}, 2)[1] == 6);
}

TEST_CASE("derivatives of monomials are their central differences") {
  const Vector3 x(0.3, -0.7, 0.45);
  constexpr double h = 1e-4;
  for (const int degree : {1, 2, 7}) {
    const auto slopes = derivatives_of_monomials(x, degree);
    int second = 3;
    for (int i = 0; i < 3; ++i) {
      const Vector3 way = h * Vector3::Unit(i);
      const Eigen::RowVectorXd expected = (monomials(x + way, degree) - monomials(x - way, degree)) / (2 * h);
      CHECK((slopes.col(i).transpose() - expected).cwiseAbs().maxCoeff() < 1e-6);
      for (int j = i; j < 3; ++j, ++second) {
        const Vector3 other = h * Vector3::Unit(j);
        const Eigen::VectorXd change = (derivatives_of_monomials(x + other, degree).col(i) -
                                        derivatives_of_monomials(x - other, degree).col(i)) /
                                       (2 * h);
        CHECK((slopes.col(second) - change).cwiseAbs().maxCoeff() < 1e-6);
      }
    }
  }
}

TEST_CASE("points of the check are in no fit, and all points are in the cube") {
  for (const int degree : {2, 10})
    for (const Vector3& point : polynomial_fit(degree).points) {
      CHECK(point.cwiseAbs().maxCoeff() <= 1);
      for (const Vector3& check : polynomial_checks()) CHECK((check - point).norm() > 1e-6);
    }
}

TEST_CASE("a zone in which actuators are no polynomials of the position is refused") {
  const Model model = model_of("orthoglide_case_b");
  const LaneModel lane_model(model, false);
  StaticsWork work(model.mechanism);
  const Vector3 home = tip(model.mechanism, model.home).p;
  CHECK(LaneZone::make(model, lane_model, home, 0.02, work) != nullptr);
  CHECK(LaneZone::make(model, lane_model, home, 0.25, work) ==
        nullptr);  // up to the singularities at its faces
  CHECK(LaneZone::make(model, lane_model, home + Vector3(5, 0, 0), 0.02, work) == nullptr);
}

TEST_CASE(
    "the actuators that a zone knows are those of followed kinematics, and their slopes those of its "
    "Jacobian") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    const LaneModel lane_model(model, false);
    StaticsWork work(model.mechanism);
    const Pose home = tip(model.mechanism, model.home);
    const auto zone = LaneZone::make(model, lane_model, home.p + trial.centre, 0.02, work);
    REQUIRE(zone != nullptr);
    for (const Vector3& x : {Vector3(0.02, -0.02, 0.02), Vector3(-0.013, 0.004, 0.02), Vector3(0, 0, 0)}) {
      const Vector3 p = home.p + trial.centre + 0.999 * x;
      const NominalResult nominal = follow(model, model.home, {home.R, p});
      REQUIRE(nominal.status == Status::converged);
      CHECK(
          (zone->rho_at(p) - actuator_values(model.mechanism, nominal.configuration)).cwiseAbs().maxCoeff() <=
          1e-11);
      const Eigen::MatrixXd J = actuator_jacobian(model, nominal.configuration).J.inverse();
      CHECK((zone->actuators_by_position(p) - J.leftCols(3)).cwiseAbs().maxCoeff() <= 1e-5);
    }
  }
}
