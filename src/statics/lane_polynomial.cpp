#include "lane_polynomial.hpp"

#include <cmath>
#include <map>
#include <mutex>

#include "counterflex/geometry/units.hpp"
#include "decompositions.hpp"

namespace counterflex {
namespace {

double radical_inverse(int n, int base) {
  double value = 0, digit = 1;
  for (; n > 0; n /= base) value += (digit /= base) * (n % base);
  return value;
}

Vector3 crowded_point(int n) {
  Vector3 x;
  const int bases[3] = {2, 3, 5};
  for (int i = 0; i < 3; ++i) x[i] = std::cos(pi * radical_inverse(n, bases[i]));
  return x;
}

constexpr int check_count = 20;

// Monomials at many points, one a row.
Eigen::MatrixXd powers_at(const std::vector<Vector3>& points, int degree) {
  Eigen::MatrixXd powers(static_cast<Eigen::Index>(points.size()), monomial_count(degree));
  for (std::size_t i = 0; i < points.size(); ++i) powers.row(static_cast<Eigen::Index>(i)) = monomials(points[i], degree);
  return powers;
}

PolynomialFit make_fit(int degree) {
  PolynomialFit fit;
  const int terms = monomial_count(degree), count = terms + terms / 2 + 8;
  for (int n = 0; n < count; ++n) fit.points.push_back(crowded_point(n + check_count + 1));
  fit.from_values = pseudo_inverse(powers_at(fit.points, degree));
  return fit;
}

}  // namespace

Eigen::RowVectorXd monomials(const Vector3& x, int degree) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> powers(3, degree + 1);
  powers.col(0).setOnes();
  for (int i = 1; i <= degree; ++i) powers.col(i) = powers.col(i - 1).cwiseProduct(x);
  Eigen::RowVectorXd values(monomial_count(degree));
  Eigen::Index at = 0;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; j <= i; ++j)
      for (int k = 0; k <= j; ++k) values[at++] = powers(0, degree - i) * powers(1, i - j) * powers(2, j - k);
  return values;
}

const PolynomialFit& polynomial_fit(int degree) {
  static std::mutex mutex;
  static std::map<int, PolynomialFit> fits;
  const std::lock_guard lock(mutex);
  const auto found = fits.find(degree);
  return found != fits.end() ? found->second : fits.emplace(degree, make_fit(degree)).first->second;
}

const Eigen::MatrixXd& powers_at_checks(int degree) {
  static std::mutex mutex;
  static std::map<int, Eigen::MatrixXd> powers;
  const std::lock_guard lock(mutex);
  Eigen::MatrixXd& of_degree = powers[degree];
  if (of_degree.size() == 0) of_degree = powers_at(polynomial_checks(), degree);
  return of_degree;
}

const std::vector<Vector3>& polynomial_checks() {
  static const std::vector<Vector3> points = [] {
    std::vector<Vector3> list;
    for (int n = 1; n <= check_count; ++n) list.push_back(crowded_point(n));
    return list;
  }();
  return points;
}

}  // namespace counterflex
