#include "lane_tangents.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "newton.hpp"

namespace counterflex {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Map<RowMajor> block(std::vector<double>& numbers, int at, Eigen::Index rows, Eigen::Index columns) {
  return {numbers.data() + at, rows, columns};
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

// The platform's equations with others beside them: their inverse.
class PlatformInverse {
 public:
  PlatformInverse(const Matrix6& K, const Units& units) : K_(K), units_(units) {}

  Eigen::MatrixXd with(const Eigen::MatrixXd& right, const Eigen::MatrixXd& below, const Eigen::VectorXd& row_units,
                       const Eigen::VectorXd& column_units) const {
    const Eigen::Index m = right.cols();
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(6 + m, 6 + m);
    system.topLeftCorner<6, 6>() = K_;
    system.topRightCorner(6, m) = right;
    system.bottomLeftCorner(m, 6) = below;
    Eigen::VectorXd rows(6 + m), columns(6 + m);
    rows << units_.of_pose() / units_.energy(), row_units;
    columns << units_.of_pose(), column_units;
    return scaled_inverse(system, rows, columns);
  }

 private:
  Matrix6 K_;
  Units units_;
};

// What a load moves: the platform, then from it inwards, as the kernels distribute a step.
void take_response(const lanes::Program& program, const Configuration& reference, std::vector<double>& numbers) {
  auto all = block(numbers, program.response, program.rows + 6, 6);
  Matrix6 balance = Matrix6::Identity();
  balance.bottomLeftCorner<3, 3>() = skew(reference.X_MP.R * Vector3::Map(program.arm));
  all.bottomRows<6>() = block(numbers, program.forward, 6, 6) * balance;
  std::vector<int> end(static_cast<std::size_t>(program.series_count), program.rows);
  for (int s = program.series_count - 1; s >= 0; --s) {
    const lanes::Series& series = program.series[s];
    all.middleRows(series.step, series.rows) = block(numbers, series.by_end, series.rows, 6) * all.middleRows(end[s], 6).eval();
    for (int k = 0; k < series.part_count; ++k)
      if (const lanes::Part& part = series.parts[k]; part.operation == lanes::Operation::group)
        std::fill_n(end.begin() + part.first_branch, part.branches, series.step + part.row);
  }
}

}  // namespace

LaneStart::LaneStart(std::vector<double> state) : state_(std::move(state)) {
  for (const double x : state_) {
    cosine_.push_back(std::cos(x));
    sine_.push_back(std::sin(x));
  }
}

void LaneStart::enter(lanes::Region& region) const {
  region.start = state_.data();
  region.cosine = cosine_.data();
  region.sine = sine_.data();
}

bool LaneTangents::take(const Model& model, const LaneModel& lane_model, const Configuration& reference, const Eigen::MatrixXd& J,
                        StaticsWork& work) {
  const Mechanism& mechanism = model.mechanism;
  const lanes::Program& program = lane_model.program();
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
  numbers.assign(static_cast<std::size_t>(program.tangents), 0.0);
  const lanes::Series* flat = program.series;
  for (const SeriesView& view : views(mechanism, reference, works)) {
    const SeriesUnits series = units_of(*view.series, units);
    const Eigen::Index rows = series.rhs.size(), actuators = view.work->G.cols();
    const Eigen::MatrixXd inverse = view.work->lu.solve(Eigen::MatrixXd::Identity(rows, rows));
    const Eigen::MatrixXd solution = series.solution.asDiagonal() * view.work->solution;
    block(numbers, flat->inside, rows, rows) = series.solution.asDiagonal() * inverse * series.rhs.asDiagonal();
    block(numbers, flat->by_end, rows, 6) = solution.middleCols(1, 6);
    block(numbers, flat->by_actuators, rows, actuators) = solution.middleCols(7, actuators);
    ++flat;
  }
  return take_platform(model, program, reference, K, G, J);
}

bool LaneTangents::take_platform(const Model& model, const lanes::Program& program, const Configuration& reference,
                                 const Matrix6& K, const Eigen::MatrixXd& G, const Eigen::MatrixXd& J) {
  const Mechanism& mechanism = model.mechanism;
  const Units units{mechanism.length};
  const PlatformInverse inverse(K, units);
  const Eigen::VectorXd none(0), length = Vector3::Constant(units.length);
  Matrix6 T = Matrix6::Identity();  // twist of the tip from that of the platform
  T.topRightCorner<3, 3>() = -skew(reference.X_MP.R * mechanism.X_PT.p);
  const Eigen::MatrixXd forward = inverse.with(Eigen::MatrixXd(6, 0), Eigen::MatrixXd(0, 6), none, none);
  const Eigen::MatrixXd target = inverse.with(G * J, T.topRows<3>(), length.cwiseInverse(), length);
  if (forward.size() == 0 || target.size() == 0) return false;
  block(numbers, program.forward, 6, 6) = forward;
  block(numbers, program.target, 9, 9) = target;
  take_response(program, reference, numbers);
  const RowMajor straightening = -target.leftCols<6>() * G;
  straighten.assign(straightening.data(), straightening.data() + straightening.size());

  Eigen::VectorXd actuator_units(G.cols());
  for (Eigen::Index a = 0; a < G.cols(); ++a)
    actuator_units[a] = units.of_column(mechanism.travel[a].kind == JointKind::revolute);
  const Eigen::VectorXd controlled_units = units.of_pose()(fixed_components(mechanism));
  const Eigen::MatrixXd C = tip_equations(mechanism, reference.X_MP, reference.X_MP * mechanism.X_PT).rows;
  const RowMajor all = inverse.with(G, C, controlled_units.cwiseInverse(), actuator_units);
  kinematic.assign(all.data(), all.data() + all.size());
  return true;
}

}  // namespace counterflex
