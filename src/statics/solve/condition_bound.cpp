// A cheap proof, from the condensed matrices, that a configuration is well conditioned. It can only say yes;
// where it does not, the whole system decides. EQUATIONS.md, section 7.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "statics/solve/newton.hpp"

namespace counterflex {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using MatrixX9 = Eigen::Matrix<double, Eigen::Dynamic, 9>;

// Bounds of a condensed series: norms of the matrix of everything inside it and of its inverse. Everything
// inside answers to nine numbers: the twist of the end and, where the series leans, the turn of its start
// frame.
struct Bounds {
  double matrix = 0, inverse = 0;
  double lean = 0;  // norm of what a turn of the start frame enters
  Matrix9 right = Matrix9::Zero(),
          left = Matrix9::Zero();  // R'R of the answers of the matrix and of its transpose

  // Side by side: blocks of a diagonal.
  void add(const Bounds& other) {
    matrix = std::max(matrix, other.matrix);
    inverse = std::max(inverse, other.inverse);
    lean = std::hypot(lean, other.lean);
    right += other.right;
    left += other.left;
  }
};

Matrix6 in_units(const Matrix6& K, const Units& units) {
  return units.of_pose().asDiagonal() * K * units.of_pose().asDiagonal() / units.energy();
}

// Norm of A_w as evaluated: its rows are g x V_c.
double lean_norm(const Series& series, const SeriesWork& work, const Units& units) {
  if (work.weight == 0) return 0;
  double squares = 0;
  for (int c : series.free)
    squares += std::pow(units.of_column(series.angular[c]) * work.masses.V.col(c).norm(), 2);
  return std::sqrt(squares) * work.weight / series.mass / units.energy();
}

// How the rows of a bordered matrix act on a group's branches.
struct Entrance {
  Eigen::Index first = 0;           // of the six rows that are the twist of their end
  Matrix3 R = Matrix3::Identity();  // of their start frame
  Eigen::Matrix<double, 3, Eigen::Dynamic>
      turn;  // of that frame, its axes, by the rows before; empty where none leans

  bool leans() const { return turn.cols() > 0; }
};

Entrance entrance(const Series& series, const Part& group, const SeriesWork& work) {
  Entrance in;
  in.first = 6 + (std::find(series.free.begin(), series.free.end(), group.column) - series.free.begin());
  in.R = work.v.middleCols<3>(group.column);
  const auto& branches = series.groups[group.group].branches;
  if (std::none_of(branches.begin(), branches.end(), [](const Series& branch) { return branch.leans; }))
    return in;
  in.turn.setZero(3, in.first);
  for (Eigen::Index row = 6; row < in.first; ++row) {
    const int c = series.free[row - 6];
    if (series.angular[c]) in.turn.col(row) = in.R.transpose() * work.w.col(c);
  }
  return in;
}

// Norm of what condensing a branch has put into the bordered matrix.
double condensed_norm(const Series& branch, const SeriesWork& work, const Entrance& in, const Units& units) {
  const double K = in_units(work.K, units).norm();
  if (!branch.leans) return K;
  const Matrix63 G_w = units.of_pose().asDiagonal() * work.lean.G_w / units.energy();
  const Matrix36 N_xi = work.lean.N.middleCols<6>(1) * units.of_pose().asDiagonal() / units.energy();
  const double N_w = work.lean.N.rightCols<3>().norm() / units.energy(), turn = in.turn.norm();
  return K + turn * (G_w.norm() + N_xi.norm()) + turn * turn * N_w;
}

// Z'Z of a series: the unit matrix but for the rows from `begin` to `end`. Its lower half.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::Index begin, end;

  explicit Normal(Eigen::Index n) : begin(n), end(n) {}

  void add(const Entrance& in, const Matrix9& response) {
    if (matrix.size() == 0) matrix.setIdentity(end, end);
    begin = std::min(begin, in.leans() ? 6 : in.first);
    end = in.first + 6;  // groups come in order
    matrix.block<6, 6>(in.first, in.first) += response.topLeftCorner<6, 6>();
    if (!in.leans()) return;
    matrix.block(in.first, 0, 6, in.first) += response.topRightCorner<6, 3>() * in.turn;
    matrix.topLeftCorner(in.first, in.first) +=
        in.turn.transpose() * response.bottomRightCorner<3, 3>() * in.turn;
  }
  Eigen::MatrixXd rows() const {
    if (matrix.size() == 0) return {};
    return matrix.block(begin, begin, end - begin, end - begin);
  }
};

// |Z_r S^-1 Z_l'|, from S^-1 and from the rows of Z'Z that are not those of the unit matrix. Infinite where
// rounding forbids to tell.
double norm_through(const Eigen::MatrixXd& right, const Eigen::MatrixXd& left, Eigen::Index begin,
                    Eigen::MatrixXd inverse) {
  if (right.size() > 0) {
    const Eigen::LLT<Eigen::MatrixXd> r = cholesky(right), l = cholesky(left);
    if (r.info() != Eigen::Success || l.info() != Eigen::Success)
      return std::numeric_limits<double>::infinity();
    inverse.middleRows(begin, right.rows()) = (r.matrixU() * inverse.middleRows(begin, right.rows())).eval();
    inverse.middleCols(begin, left.rows()) = (inverse.middleCols(begin, left.rows()) * l.matrixL()).eval();
  }
  const double norm = inverse.norm();
  return std::isfinite(norm) ? norm : std::numeric_limits<double>::infinity();
}

// What the rows of a series answer to its end's twist and, in the last three columns, where it leans, to its
// start's turn; the same of the transpose.
struct Answers {
  MatrixX9 right, left;
  bool leans = false;
};

Answers answers(const Series& series, const SeriesWork& work, const Eigen::MatrixXd& inverse,
                const Units& units) {
  const Eigen::Index n = inverse.rows();
  Answers z{MatrixX9(n, 9), MatrixX9(n, 9), series.leans};
  z.right.leftCols<6>() = inverse.leftCols<6>();
  z.left.leftCols<6>() = inverse.topRows<6>().transpose();
  if (!series.leans) return z;
  z.right.rightCols<3>() = work.solution.rightCols<3>();
  Eigen::Matrix<double, Eigen::Dynamic, 3> entered = Eigen::MatrixXd::Zero(n, 3);
  for (Eigen::Index row = 6; row < n; ++row) {
    const int c = series.free[row - 6];
    entered.row(row) = units.of_column(series.angular[c]) / units.energy() * work.lean.N_x.col(c).transpose();
  }
  z.left.rightCols<3>().noalias() = inverse.transpose() * entered;
  return z;
}

Matrix9 squared(const MatrixX9& z, bool leans) {
  Matrix9 result = Matrix9::Zero();
  if (leans)
    result.noalias() = z.transpose().lazyProduct(z);
  else
    result.topLeftCorner<6, 6>().noalias() = z.leftCols<6>().transpose().lazyProduct(z.leftCols<6>());
  return result;
}

// The response of a group's branches to what the rows of the series answer by z: to the six rows of the group
// and, where a branch leans, to the turn of its start frame, which a turn of the series' start turns too.
Matrix9 seen_through(const Entrance& in, const MatrixX9& z, bool leans, const Matrix9& response) {
  Matrix9 result = Matrix9::Zero();
  if (!leans && !in.leans()) {
    const Matrix6 u = z.block<6, 6>(in.first, 0);
    result.topLeftCorner<6, 6>() = u.transpose() * response.topLeftCorner<6, 6>() * u;
    return result;
  }
  const int inputs = leans ? 9 : 6;
  Matrix9 u = Matrix9::Zero();
  u.topLeftCorner(6, inputs) = z.block(in.first, 0, 6, inputs);
  if (in.leans()) u.bottomLeftCorner(3, inputs) = in.turn * z.topLeftCorner(in.first, inputs);
  if (in.leans() && leans) u.bottomRightCorner<3, 3>() += in.R.transpose();
  const Matrix9 response_u = response * u;
  return u.transpose() * response_u;
}

Bounds bounds(const Series& series, const SeriesWork& work, const Units& units);

Bounds bounds_of_branches(const std::vector<Series>& branches, const std::vector<SeriesWork>& works,
                          const Units& units) {
  Bounds inside;
  for (std::size_t b = 0; b < branches.size(); ++b) inside.add(bounds(branches[b], works[b], units));
  return inside;
}

// The same, answering to what the series in which they lie answers to.
Bounds seen_through(const Entrance& in, const Answers& z, Bounds inside) {
  inside.right = seen_through(in, z.right, z.leans, inside.right);
  inside.left = seen_through(in, z.left, z.leans, inside.left);
  if (!z.leans) inside.lean = 0;
  return inside;
}

//     M = [ B  C ; C'  D ], S the Schur complement of B:    M^-1 = [ B^-1  0 ; 0  0 ] + Z_r S^-1 Z_l'
//     Z_r = [ -B^-1 C ; I ],  Z_l = [ -B^-T C ; I ],  Z'Z = L L':    |Z_r S^-1 Z_l'| = |L_r' S^-1 L_l|
//
// B is what lies inside groups, C how it meets the rows of this series. B, D and S are not symmetric under
// load.
Bounds bounds(const Series& series, const SeriesWork& work, const Units& units) {
  Eigen::MatrixXd inverse = work.lu.inverse();
  const Answers z = answers(series, work, inverse, units);
  Bounds result;
  if (series.leans) result.lean = lean_norm(series, work, units);
  result.right = squared(z.right, z.leans);
  result.left = squared(z.left, z.leans);
  Normal right(inverse.rows()), left(inverse.rows());
  double D = work.bordered.norm(), C = 0;
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const auto& branches = series.groups[part.group].branches;
    const auto& works = work.groups[part.group];
    const Entrance in = entrance(series, part, work);
    const Bounds inside = bounds_of_branches(branches, works, units);
    right.add(in, inside.right);
    left.add(in, inside.left);
    for (std::size_t b = 0; b < branches.size(); ++b) D += condensed_norm(branches[b], works[b], in, units);
    C = std::hypot(C, std::sqrt(branches.size()) + inside.lean * in.turn.norm());
    result.add(seen_through(in, z, inside));
  }
  result.matrix = std::max(result.matrix, D) + C;
  result.inverse += norm_through(right.rows(), left.rows(), right.begin, std::move(inverse));
  return result;
}

// Z'Z at the platform, which chains meet by their ends alone.
Matrix6 normal_of_platform(const Matrix9& response) {
  return Matrix6::Identity() + response.topLeftCorner<6, 6>();
}

}  // namespace

bool surely_well_conditioned(const Mechanism& mechanism, std::vector<SeriesWork>& works,
                             const Matrix6& load_tangent, const Units& units, double limit) {
  Bounds inside;
  Matrix6 K = -load_tangent;
  for (std::size_t i = 0; i < works.size(); ++i) {
    if (!condense(mechanism.chains[i], units, false, works[i])) return false;
    inside.add(bounds(mechanism.chains[i], works[i], units));
    K += works[i].K;
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> platform(Eigen::MatrixXd(in_units(K, units)));
  const double inverse =
      inside.inverse +
      norm_through(normal_of_platform(inside.right), normal_of_platform(inside.left), 0, platform.inverse());
  const double matrix =
      std::max(inside.matrix, in_units(load_tangent, units).norm()) + std::sqrt(works.size());
  return std::isfinite(inverse) && inverse * matrix < limit;
}

}  // namespace counterflex
