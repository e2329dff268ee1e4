#include "lane_polynomial.hpp"

#include <array>
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

// Points stand in fours, (+-x, +-y, z): monomials whose powers of x and y are even or odd then have nothing to do with the
// others, and four small systems take the place of a large one.
constexpr int mirrors = 4;

double sign_of(int power_x, int power_y, int mirror) {
  return (power_x % 2 && mirror & 1 ? -1. : 1.) * (power_y % 2 && mirror & 2 ? -1. : 1.);
}

// Powers of x and y of every monomial, in their order.
std::vector<std::array<int, 2>> powers_of(int degree) {
  std::vector<std::array<int, 2>> list;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; j <= i; ++j) list.insert(list.end(), static_cast<std::size_t>(j + 1), {degree - i, i - j});
  return list;
}

void fit_parity(int odd_x, int odd_y, const Eigen::MatrixXd& values, const std::vector<std::array<int, 2>>& powers,
                PolynomialFit& fit) {
  std::vector<int> terms;
  for (std::size_t m = 0; m < powers.size(); ++m)
    if (powers[m][0] % 2 == odd_x && powers[m][1] % 2 == odd_y) terms.push_back(static_cast<int>(m));
  const Eigen::MatrixXd inverse = pseudo_inverse(values(Eigen::all, terms));
  for (Eigen::Index point = 0; point < inverse.cols(); ++point)
    for (int mirror = 0; mirror < mirrors; ++mirror)
      fit.from_values(terms, mirrors * point + mirror) = inverse.col(point) * (sign_of(odd_x, odd_y, mirror) / mirrors);
}

PolynomialFit make_fit(int degree) {
  PolynomialFit fit;
  // What a high degree still misses is the points' own rounding: more of them average it out.
  const int terms = monomial_count(degree), more = degree > 8 ? terms / 10 : 0;
  const int fours = (terms + terms / 2) / mirrors + 2 + more;
  std::vector<Vector3> points;
  for (int n = 0; n < fours; ++n) {
    points.push_back(crowded_point(n + check_count + 1));
    for (int mirror = 0; mirror < mirrors; ++mirror)
      fit.points.push_back(points.back().cwiseProduct(Vector3(mirror & 1 ? -1 : 1, mirror & 2 ? -1 : 1, 1)));
  }
  const Eigen::MatrixXd values = powers_at(points, degree);
  const auto powers = powers_of(degree);
  fit.from_values.resize(terms, static_cast<Eigen::Index>(fit.points.size()));
  for (const int odd_x : {0, 1})
    for (const int odd_y : {0, 1}) fit_parity(odd_x, odd_y, values, powers, fit);
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

Eigen::Matrix<double, Eigen::Dynamic, 9> derivatives_of_monomials(const Vector3& x, int degree) {
  // Powers of each coordinate, and their first and second derivatives.
  std::vector<std::array<Vector3, 3>> powers(static_cast<std::size_t>(degree) + 1);
  powers[0] = {Vector3::Ones(), Vector3::Zero(), Vector3::Zero()};
  for (std::size_t n = 1; n < powers.size(); ++n)
    for (std::size_t order = 0; order < 3; ++order) {
      powers[n][order] = powers[n - 1][order].cwiseProduct(x);
      if (order > 0) powers[n][order] += static_cast<double>(order) * powers[n - 1][order - 1];
    }
  Eigen::Matrix<double, Eigen::Dynamic, 9> result(monomial_count(degree), 9);
  Eigen::Index at = 0;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; j <= i; ++j)
      for (int k = 0; k <= j; ++k, ++at) {
        const auto &a = powers[static_cast<std::size_t>(degree - i)], &b = powers[static_cast<std::size_t>(i - j)],
                   &c = powers[static_cast<std::size_t>(j - k)];
        const auto product = [&](std::size_t of_x, std::size_t of_y, std::size_t of_z) {
          return a[of_x][0] * b[of_y][1] * c[of_z][2];
        };
        result.row(at) << product(1, 0, 0), product(0, 1, 0), product(0, 0, 1), product(2, 0, 0), product(1, 1, 0),
            product(1, 0, 1), product(0, 2, 0), product(0, 1, 1), product(0, 0, 2);
      }
  return result;
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
