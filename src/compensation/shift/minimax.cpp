#include "compensation/shift/minimax.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace counterflex {
namespace {

constexpr double accuracy = 1e-7;  // of the largest norm, in units of the largest |r|

struct Barrier {
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

// Interior point method. Minimises, over x and t, with z = (x, t),
//
//     tau (t + (from + x)' C (from + x) / 2) - sum log(t^2 - |r + J x|^2)
//
// for increasing tau: the minimum is within 2 m / tau of the least t, m the number of rows.
class InteriorPoint {
 public:
  InteriorPoint(std::span<const MinimaxRow> rows, const MinimaxCost& cost) : rows_(rows), cost_(cost) {}

  Eigen::VectorXd solve() {
    const Eigen::Index n = cost_.of.size();
    double largest = 0;
    for (const MinimaxRow& row : rows_) largest = std::max(largest, row.r.norm());
    Eigen::VectorXd z = Eigen::VectorXd::Zero(n + 1);
    z[n] = 1.1 * largest + accuracy;
    const double last = 2 * static_cast<double>(rows_.size()) / accuracy;
    for (double tau = 10 * static_cast<double>(rows_.size());; tau = std::min(10 * tau, last)) {
      centre(z, tau);
      if (tau == last) return z.head(n);
    }
  }

 private:
  // Newton's method with halved steps.
  void centre(Eigen::VectorXd& z, double tau) const {
    constexpr int most_steps = 60;
    for (int i = 0; i < most_steps; ++i) {
      const Barrier at = barrier(z, tau);
      const Eigen::VectorXd dz = -at.hessian.ldlt().solve(at.gradient);
      const double slope = at.gradient.dot(dz);
      if (!(slope < -1e-9)) return;
      double share = 1;
      while (share > 1e-12 && !(value(z + share * dz, tau) <= at.value + 0.1 * share * slope)) share /= 2;
      if (share <= 1e-12) return;  // rounding errors are larger than the step
      z += share * dz;
    }
  }

  double value(const Eigen::VectorXd& z, double tau) const {
    const Eigen::Index n = cost_.of.size();
    const double t = z[n];
    if (!(t > 0)) return HUGE_VAL;
    double sum = tau * (t + 0.5 * (cost_.from + z.head(n)).cwiseAbs2().dot(cost_.of));
    for (const MinimaxRow& row : rows_) {
      const double size = row.at(z).norm();
      if (!(size < t)) return HUGE_VAL;
      sum -= std::log((t - size) * (t + size));
    }
    return sum;
  }

  Barrier barrier(const Eigen::VectorXd& z, double tau) const {
    const Eigen::Index n = cost_.of.size();
    const double t = z[n];
    Barrier at{value(z, tau), Eigen::VectorXd::Zero(n + 1), Eigen::MatrixXd::Zero(n + 1, n + 1)};
    at.gradient.head(n) = tau * cost_.of.cwiseProduct(cost_.from + z.head(n));
    at.gradient[n] = tau;
    at.hessian.diagonal().head(n) = tau * cost_.of;
    for (const MinimaxRow& row : rows_) {
      const Vector3 v = row.at(z);
      const double size = v.norm(), s = (t - size) * (t + size);
      const auto count = row.J.cols();
      const Eigen::VectorXd g = row.J.transpose() * v;
      for (Eigen::Index a = 0; a < count; ++a) {
        const int i = row.column[a];
        at.gradient[i] += 2 * g[a] / s;
        at.hessian(i, n) -= 4 * t * g[a] / (s * s);
        at.hessian(n, i) -= 4 * t * g[a] / (s * s);
        for (Eigen::Index b = 0; b < count; ++b)
          at.hessian(i, row.column[b]) += 4 * g[a] * g[b] / (s * s) + 2 * row.J.col(a).dot(row.J.col(b)) / s;
      }
      at.gradient[n] -= 2 * t / s;
      at.hessian(n, n) += 4 * t * t / (s * s) - 2 / s;
    }
    return at;
  }

  std::span<const MinimaxRow> rows_;
  const MinimaxCost& cost_;
};

}  // namespace

Vector3 MinimaxRow::at(const Eigen::VectorXd& x) const {
  Vector3 v = r;
  for (Eigen::Index k = 0; k < J.cols(); ++k) v += x[column[k]] * J.col(k);
  return v;
}

// Over a few rows, to which the largest ones of all are added. It ends when all others are smaller.
Eigen::VectorXd least_largest(std::span<const MinimaxRow> rows, const MinimaxCost& cost) {
  const Eigen::Index n = cost.of.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  double scale = 0;
  for (const MinimaxRow& row : rows) scale = std::max(scale, row.r.norm());
  if (!(scale > 0) || n == 0) return x;
  std::vector<MinimaxRow> scaled(rows.begin(), rows.end());
  for (MinimaxRow& row : scaled) row.r /= scale;
  const MinimaxCost scaled_cost{scale * cost.of, cost.from / scale};
  std::vector<bool> is_in(rows.size(), false);
  std::vector<MinimaxRow> active;
  std::vector<std::size_t> order(rows.size());
  const auto together = static_cast<std::size_t>(2 * n + 2);
  for (;;) {
    std::vector<double> sizes(rows.size());
    std::transform(scaled.begin(), scaled.end(), sizes.begin(),
                   [&](const MinimaxRow& row) { return row.at(x).norm(); });
    double inside = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (is_in[i]) inside = std::max(inside, sizes[i]);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    std::size_t added = 0;
    for (const std::size_t i : order) {
      if (added == together || (!active.empty() && sizes[i] <= inside + accuracy)) break;
      if (is_in[i]) continue;
      is_in[i] = true;
      active.push_back(scaled[i]);
      ++added;
    }
    if (added == 0) return scale * x;
    x = InteriorPoint(active, scaled_cost).solve();
  }
}

}  // namespace counterflex
