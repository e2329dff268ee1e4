// The least largest norm of vectors that depend linearly on common variables.
#include "compensation/shift/minimax.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <random>

using namespace counterflex;

namespace {

MinimaxRow moved_point(const Vector3& p) {
  MinimaxRow row{p, {}, {0, 1, 2}};
  row.J = Matrix3::Identity();
  return row;
}

MinimaxCost small_cost(Eigen::Index variables) {
  return {Eigen::VectorXd::Constant(variables, 1e-3), Eigen::VectorXd::Zero(variables)};
}

double largest(const std::vector<MinimaxRow>& rows, const Eigen::VectorXd& x) {
  double size = 0;
  for (const MinimaxRow& row : rows) size = std::max(size, row.at(x).norm());
  return size;
}

// The sphere through some points with its centre in their flat: r^2 and c by linear equations.
Vector3 centre_through(const std::vector<Vector3>& points) {
  const auto n = static_cast<Eigen::Index>(points.size()) - 1;
  if (n == 0) return points[0];
  Eigen::MatrixXd A(3, n);
  for (Eigen::Index k = 0; k < n; ++k) A.col(k) = points[static_cast<std::size_t>(k) + 1] - points[0];
  const Eigen::VectorXd b = 0.5 * A.colwise().squaredNorm().transpose();
  return points[0] + A * (A.transpose() * A).fullPivLu().solve(b);
}

// The radius of the smallest sphere around all points: the least of spheres through at most four of them that
// have all others inside.
double smallest_sphere(const std::vector<Vector3>& points) {
  double least = HUGE_VAL;
  const std::size_t n = points.size();
  for (unsigned set = 1; set < (1U << n); ++set) {
    std::vector<Vector3> on;
    for (std::size_t i = 0; i < n; ++i)
      if ((set >> i & 1) != 0) on.push_back(points[i]);
    if (on.size() > 4) continue;
    const Vector3 c = centre_through(on);
    double radius = 0;
    for (const Vector3& p : points) radius = std::max(radius, (p - c).norm());
    least = std::min(least, radius);
  }
  return least;
}

}  // namespace

TEST_CASE("the least largest norm of shifted points is the radius of their smallest enclosing sphere") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 40; ++trial) {
    CAPTURE(trial);
    std::vector<Vector3> points;
    std::vector<MinimaxRow> rows;
    const Vector3 middle = 1e-3 * Vector3(normal(random), normal(random), normal(random));
    for (int i = 0; i < 1 + trial % 11; ++i) {
      points.push_back(middle + 1e-4 * Vector3(normal(random), normal(random), normal(random)));
      rows.push_back(moved_point(points.back()));
    }
    const double found = largest(rows, least_largest(rows, small_cost(3)));
    CHECK(std::abs(found - smallest_sphere(points)) < 5e-9);
  }
}

TEST_CASE("no other values of common variables make the largest norm less") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    CAPTURE(trial);
    const Eigen::Index n = 3 + trial % 5;
    std::vector<MinimaxRow> rows(200);
    for (MinimaxRow& row : rows) {
      row.r = 1e-4 * Vector3(normal(random), normal(random), normal(random) + 2);
      row.J.resize(3, std::min<Eigen::Index>(n, MinimaxRow::most));
      for (Eigen::Index k = 0; k < row.J.cols(); ++k) {
        row.column[static_cast<std::size_t>(k)] = static_cast<int>(k);
        row.J.col(k) = Vector3(normal(random), normal(random), normal(random));
      }
    }
    const Eigen::VectorXd x = least_largest(rows, small_cost(n));
    const double least = largest(rows, x);
    for (int i = 0; i < 2000; ++i) {
      Eigen::VectorXd other(n);
      for (Eigen::Index k = 0; k < n; ++k) other[k] = normal(random);
      const double size = std::pow(10.0, -4 - i % 6);
      CHECK(largest(rows, x + size * other) > least - 1e-10);
    }
  }
}

TEST_CASE(
    "a variable on which nothing depends stays zero, and of two that do the same the cheaper one changes") {
  std::vector<MinimaxRow> rows{moved_point({1e-4, 0, 0}), moved_point({3e-4, 0, 0})};
  for (MinimaxRow& row : rows) {
    row.J.resize(3, 4);
    row.J << Matrix3::Identity(), Vector3::UnitX();
    row.column = {0, 1, 2, 4};
  }
  MinimaxCost cost = small_cost(5);
  cost.of[4] *= 1e3;
  const Eigen::VectorXd x = least_largest(rows, cost);
  CHECK(std::abs(x[0] + 2e-4) < 1e-6);
  CHECK(std::abs(x[4]) < 1e-6);
  CHECK(std::abs(x[3]) < 1e-12);
  CHECK(std::abs(largest(rows, x) - 1e-4) < 1e-9);
}

TEST_CASE("nothing is moved where nothing deviates") {
  const std::vector<MinimaxRow> rows{moved_point(Vector3::Zero())};
  CHECK(least_largest(rows, small_cost(3)).isZero(0));
}
