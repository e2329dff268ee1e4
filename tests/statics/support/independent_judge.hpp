#pragma once
/// Stability of an equilibrium, judged without the module: own kinematics, multipliers by least squares,
/// second differences of the Lagrangian, all in long double. For machines without groups and masses, under a
/// force at the tip.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <functional>
#include <vector>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex::independent {

using Real = long double;
using V3 = Eigen::Matrix<Real, 3, 1>;
using M3 = Eigen::Matrix<Real, 3, 3>;
using V = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using M = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

struct Frame {
  M3 R = M3::Identity();
  V3 p = V3::Zero();
};

inline M3 turn(const V3& w) {
  const Real angle = w.norm();
  return angle == 0 ? M3(M3::Identity()) : M3(Eigen::AngleAxis<Real>(angle, w / angle).toRotationMatrix());
}

/// All columns of the chains, one after another, then the platform's step from where it is.
class Judge {
 public:
  Judge(const Model& model, const Configuration& at, const Vector3& force)
      : model_(model), force_(force.cast<Real>()) {
    platform_ = {at.X_MP.R.cast<Real>(), at.X_MP.p.cast<Real>()};
    Eigen::Index count = 0;
    for (std::size_t c = 0; c < at.chains.size(); ++c) {
      first_.push_back(count);
      count += at.chains[c].x.size();
    }
    pose_ = count;
    x_ = V::Zero(count + 6);
    for (std::size_t c = 0; c < at.chains.size(); ++c) {
      x_.segment(first_[c], at.chains[c].x.size()) = at.chains[c].x.cast<Real>();
      for (const int column : model.mechanism.chains[c].free) free_.push_back(first_[c] + column);
    }
    for (int i = 0; i < 6; ++i) free_.push_back(pose_ + i);
  }

  /// Least eigenvalue, every coordinate scaled by its own stiffness.
  Real least_eigenvalue() const {
    const auto n = static_cast<Eigen::Index>(free_.size()),
               closures = static_cast<Eigen::Index>(6 * first_.size());
    M C(closures, n), A = M::Zero(n, n);
    V gradient(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      C.col(i) = slope(free_[i], [&](const V& x) { return gaps(x); });
      gradient[i] = slope(free_[i], [&](const V& x) { return V(V::Constant(1, energy(x))); })[0];
    }
    const V lambda = C.transpose().colPivHouseholderQr().solve(gradient);
    const auto lagrangian = [&](const V& x) { return energy(x) - lambda.dot(gaps(x)); };
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        if (meet(free_[i], free_[j])) A(i, j) = A(j, i) = second(free_[i], free_[j], lagrangian);
    const V D = A.diagonal().cwiseAbs().cwiseMax(std::max<Real>(1, force_.norm())).cwiseSqrt().cwiseInverse();
    const Eigen::ColPivHouseholderQR<M> qr(M(C * D.asDiagonal()).transpose());
    const M Q = qr.householderQ() * M::Identity(n, n), Z = Q.rightCols(n - qr.rank());
    const M reduced = Z.transpose() * D.asDiagonal() * A * D.asDiagonal() * Z;
    return Eigen::SelfAdjointEigenSolver<M>(reduced, Eigen::EigenvaluesOnly).eigenvalues()[0];
  }

 private:
  Frame platform(const V& x) const {
    return {turn(x.tail<3>()) * platform_.R, platform_.p + x.segment<3>(pose_)};
  }

  Frame end(std::size_t chain, const V& x) const {
    Frame at;
    for (const Part& part : model_.mechanism.chains[chain].parts) {
      const auto column = first_[chain] + part.column;
      if (part.kind == PartKind::fixed || part.kind == PartKind::error) {
        at.p += at.R * part.X.p.cast<Real>();
        at.R = at.R * part.X.R.cast<Real>();
      } else if (part.kind == PartKind::spring) {
        at.p += at.R * x.segment<3>(column);
        at.R = at.R * turn(x.segment<3>(column + 3));
      } else if (part.joint.kind == JointKind::prismatic) {
        at.p += at.R * V3(x[column] * part.joint.axis.cast<Real>());
      } else {
        at.R = at.R * turn(x[column] * part.joint.axis.cast<Real>());
      }
    }
    return at;
  }

  V gaps(const V& x) const {
    V all(6 * first_.size());
    const Frame wanted = platform(x);
    for (std::size_t c = 0; c < first_.size(); ++c) {
      const Frame reached = end(c, x);
      const M3 R = reached.R * wanted.R.transpose();
      all.segment<3>(6 * c) = reached.p - wanted.p;
      all.segment<3>(6 * c + 3) = V3(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)) / 2;
    }
    return all;
  }

  Real energy(const V& x) const {
    const Frame P = platform(x);
    Real sum = -force_.dot(P.p + P.R * model_.mechanism.X_PT.p.cast<Real>());
    for (std::size_t c = 0; c < first_.size(); ++c)
      for (const Part& part : model_.mechanism.chains[c].parts) {
        const auto column = first_[c] + part.column;
        if (part.kind == PartKind::spring) {
          const Eigen::Matrix<Real, 6, 1> bent = x.segment<6>(column) - part.theta_0.cast<Real>();
          sum += bent.dot(part.K.cast<Real>() * bent) / 2;
        }
        if (part.kind == PartKind::passive)
          sum += part.k * (x[column] - part.rest) * (x[column] - part.rest) / 2;
        if (part.kind == PartKind::compliance) sum += part.k * x[column] * x[column] / 2;
      }
    return sum;
  }

  /// Columns of two chains do not: only through the platform.
  bool meet(Eigen::Index i, Eigen::Index j) const {
    if (i >= pose_ || j >= pose_) return true;
    for (std::size_t c = 1; c < first_.size(); ++c)
      if ((i < first_[c]) != (j < first_[c])) return false;
    return true;
  }

  template <class Function>
  V slope(Eigen::Index i, const Function& f) const {
    constexpr Real h = 1e-3L;
    const auto at = [&](Real step) {
      V x = x_;
      x[i] += step;
      return f(x);
    };
    return (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  }

  template <class Function>
  Real second(Eigen::Index i, Eigen::Index j, const Function& f) const {
    constexpr Real h = 1e-4L;
    const auto at = [&](Real step_i, Real step_j) {
      V x = x_;
      x[i] += step_i;
      x[j] += step_j;
      return f(x);
    };
    return (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4 * h * h);
  }

  const Model& model_;
  V3 force_;
  Frame platform_;
  std::vector<Eigen::Index> first_, free_;
  Eigen::Index pose_ = 0;
  V x_;
};

}  // namespace counterflex::independent
