#include "lane_tangents.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "newton.hpp"

namespace counterflex {
namespace {

std::vector<double> row_major(const Eigen::MatrixXd& A) {
  std::vector<double> list;
  list.reserve(static_cast<std::size_t>(A.size()));
  for (Eigen::Index r = 0; r < A.rows(); ++r)
    for (Eigen::Index c = 0; c < A.cols(); ++c) list.push_back(A(r, c));
  return list;
}

// Units of the rows of a condensed series' solution, and of its right-hand side.
struct SeriesUnits {
  Eigen::VectorXd solution, rhs;
};

SeriesUnits units_of(const Series& series, const Units& units) {
  const auto n = static_cast<Eigen::Index>(series.free.size());
  SeriesUnits result{Eigen::VectorXd(6 + n), Eigen::VectorXd(6 + n)};
  result.solution.head<6>() = units.of_pose().cwiseInverse() * units.energy();
  result.rhs.head<6>() = units.of_pose().cwiseInverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double unit = units.of_column(series.angular[series.free[i]]);
    result.solution[6 + i] = unit;
    result.rhs[6 + i] = unit / units.energy();
  }
  return result;
}

// Inverse of a square matrix whose rows and columns are of very different size; empty where it is singular.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& A, const Eigen::VectorXd& rows, const Eigen::VectorXd& columns) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd(rows.asDiagonal() * A * columns.asDiagonal()));
  if (lu.rank() < A.cols()) return {};
  Eigen::MatrixXd inverse(A.cols(), A.cols());
  for (Eigen::Index i = 0; i < A.cols(); ++i)
    inverse.col(i) = solved(lu, Eigen::VectorXd(Eigen::VectorXd::Unit(A.cols(), i)));
  return columns.asDiagonal() * inverse * rows.asDiagonal();
}

}  // namespace

bool LaneTangents::take_platform(const Model& model, const Configuration& reference, const Matrix6& K, const Eigen::MatrixXd& G,
                                 const Eigen::MatrixXd& J) {
  const Mechanism& mechanism = model.mechanism;
  const Units units{mechanism.length};
  const Eigen::Index n = G.cols();
  const Eigen::MatrixXd C = tip_equations(mechanism, reference.X_MP, reference.X_MP * mechanism.X_PT).rows;
  Matrix6 T = Matrix6::Identity();  // twist of the tip from that of the platform
  T.topRightCorner<3, 3>() = -skew(reference.X_MP.R * mechanism.X_PT.p);
  const auto inverse_with = [&](const Eigen::MatrixXd& right, const Eigen::MatrixXd& below, const Eigen::VectorXd& row_units,
                                const Eigen::VectorXd& column_units) {
    const Eigen::Index m = right.cols();
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(6 + m, 6 + m);
    system.topLeftCorner<6, 6>() = K;
    system.topRightCorner(6, m) = right;
    system.bottomLeftCorner(m, 6) = below;
    Eigen::VectorXd rows(6 + m), columns(6 + m);
    rows << units.of_pose() / units.energy(), row_units;
    columns << units.of_pose(), column_units;
    return row_major(scaled_inverse(system, rows, columns));
  };
  const Eigen::VectorXd none(0), length = Vector3::Constant(units.length);
  forward_ = inverse_with(Eigen::MatrixXd(6, 0), Eigen::MatrixXd(0, 6), none, none);
  target_ = inverse_with(G * J, T.topRows<3>(), length.cwiseInverse(), length);
  Eigen::VectorXd actuator_units(n);
  for (Eigen::Index a = 0; a < n; ++a) actuator_units[a] = units.of_column(mechanism.travel[a].kind == JointKind::revolute);
  const Eigen::VectorXd controlled_units = units.of_pose()(fixed_components(mechanism));
  kinematic_ = inverse_with(G, C, controlled_units.cwiseInverse(), actuator_units);
  return !forward_.empty() && !target_.empty();
}

bool LaneTangents::take(const Model& model, const LaneModel& lane_model, const Configuration& reference, const Eigen::MatrixXd& J,
                        StaticsWork& work) {
  const Mechanism& mechanism = model.mechanism;
  const Units units{mechanism.length};
  auto& works = work.impl().chains;
  evaluate_all(model, reference, {}, work.impl());
  Matrix6 K = Matrix6::Zero();
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(mechanism.travel.size()));
  for (std::size_t i = 0; i < works.size(); ++i) {
    if (!condense(mechanism.chains[i], units, true, works[i])) return false;
    K += works[i].K;
    for (std::size_t a = 0; a < mechanism.chains[i].actuators.size(); ++a)
      G.col(mechanism.chains[i].actuators[a]) += works[i].G.col(static_cast<Eigen::Index>(a));
  }
  for (const SeriesView& view : views(mechanism, reference, works)) {
    const SeriesUnits series = units_of(*view.series, units);
    const Eigen::Index rows = series.rhs.size();
    const Eigen::MatrixXd inverse = view.work->lu.solve(Eigen::MatrixXd::Identity(rows, rows));
    const Eigen::MatrixXd solution = series.solution.asDiagonal() * view.work->solution;
    matrices_.push_back(row_major(series.solution.asDiagonal() * inverse * series.rhs.asDiagonal()));
    matrices_.push_back(row_major(solution.middleCols(1, 6)));
    matrices_.push_back(row_major(solution.middleCols(7, view.work->G.cols())));
  }
  for (std::size_t i = 0; i < matrices_.size(); i += 3) {
    inside_.push_back(matrices_[i].data());
    by_end_.push_back(matrices_[i + 1].data());
    by_actuators_.push_back(matrices_[i + 2].data());
  }
  start_ = lane_model.state_of(reference);
  for (const double x : start_) {
    cosine_.push_back(std::cos(x));
    sine_.push_back(std::sin(x));
  }
  G_ = G;
  return take_platform(model, reference, K, G, J);
}

void LaneTangents::bend(const std::array<Eigen::MatrixXd, 3>& J_by_position) {
  const Eigen::Index n = G_.cols();
  const Eigen::Map<const Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> solve(target_.data());
  for (Eigen::Index a = 0; a < n; ++a)
    for (const Eigen::MatrixXd& J : J_by_position)
      for (Eigen::Index of = 0; of < 3; ++of) bend_.push_back(J(a, of));
  straighten_ = row_major(-solve.leftCols<6>() * G_);
}

void LaneTangents::enter(lanes::Region& region, const Vector3& place) const {
  for (int i = 0; i < 3; ++i) region.place[i] = place[i];
  region.bend = bend_.empty() ? nullptr : bend_.data();
  region.straighten = straighten_.data();
  region.start = start_.data();
  region.cosine = cosine_.data();
  region.sine = sine_.data();
  region.inside = inside_.data();
  region.by_end = by_end_.data();
  region.by_actuators = by_actuators_.data();
  region.forward = forward_.data();
  region.target = target_.data();
  region.kinematic = kinematic_.empty() ? nullptr : kinematic_.data();
}

}  // namespace counterflex
