#include "lane_region.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "kinematics.hpp"
#include "lane_polynomial.hpp"
#include "newton.hpp"

namespace counterflex {
namespace {

constexpr double polynomial_tolerance = 2e-12;   // m, rad
constexpr double largest_kinematic_condition = 1e4;        // of the nominal Jacobian: far from a singularity
constexpr double load_margin = 1.25;
constexpr double kinematic_closure = 1e-11;

std::vector<double> row_major(const Eigen::MatrixXd& A) {
  std::vector<double> list;
  list.reserve(static_cast<std::size_t>(A.size()));
  for (Eigen::Index r = 0; r < A.rows(); ++r)
    for (Eigen::Index c = 0; c < A.cols(); ++c) list.push_back(A(r, c));
  return list;
}

// Values of actuators and rotation of the nominal tip at `p`; empty where it is not reached.
Eigen::VectorXd kinematics_at(const Model& model, Kinematics& kinematics, const Configuration& start, const Pose& X_MT,
                              const Matrix3& R_centre) {
  Configuration configuration = start;
  if (!(kinematics.solve(&X_MT, configuration) < kinematic_closure)) return {};
  const Eigen::VectorXd rho = actuator_values(model.mechanism, configuration);
  Eigen::VectorXd outputs(rho.size() + 3);
  outputs << rho, log_so3(tip(model.mechanism, configuration).R * R_centre.transpose());
  return outputs;
}

// From (gap, gradient) to (dF, dx), in SI, of a condensed series.
Eigen::MatrixXd inside_matrix(const Series& series, const SeriesWork& work, const Units& units, Eigen::VectorXd& row_units) {
  const auto n = static_cast<Eigen::Index>(series.free.size());
  row_units.resize(6 + n);
  Eigen::VectorXd column_units(6 + n);
  row_units.head<6>() = units.of_pose().cwiseInverse() * units.energy();
  column_units.head<6>() = units.of_pose().cwiseInverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double unit = units.of_column(series.angular[series.free[i]]);
    row_units[6 + i] = unit;
    column_units[6 + i] = unit / units.energy();
  }
  const Eigen::MatrixXd inverse = work.lu.solve(Eigen::MatrixXd::Identity(6 + n, 6 + n));
  return row_units.asDiagonal() * inverse * column_units.asDiagonal();
}

// Inverse of a square matrix whose rows and columns are of very different size; empty where it is singular.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& A, const Eigen::VectorXd& rows, const Eigen::VectorXd& columns) {
  const Eigen::MatrixXd scaled = rows.asDiagonal() * A * columns.asDiagonal();
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(scaled);
  if (lu.rank() < A.cols()) return {};
  Eigen::MatrixXd inverse(A.cols(), A.cols());
  for (Eigen::Index i = 0; i < A.cols(); ++i) inverse.col(i) = solved(lu, Eigen::VectorXd(Eigen::VectorXd::Unit(A.cols(), i)));
  return columns.asDiagonal() * inverse * rows.asDiagonal();
}

}  // namespace

bool LaneRegion::fit_polynomials(double half, int degree) {
  Kinematics kinematics(model_.mechanism, {true, true});
  const auto at = [&](const Vector3& x) {
    return kinematics_at(model_, kinematics, nominal_, {tip(model_.mechanism, model_.home).R, centre_ + half * x}, R_centre_);
  };
  const PolynomialFit& fit = polynomial_fit(degree);
  const auto outputs = static_cast<Eigen::Index>(model_.mechanism.travel.size()) + 3;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(fit.points.size()), outputs);
  for (std::size_t n = 0; n < fit.points.size(); ++n) {
    const Eigen::VectorXd value = at(fit.points[n]);
    if (value.size() == 0) return false;
    values.row(static_cast<Eigen::Index>(n)) = value;
  }
  const Eigen::MatrixXd coefficients = fit.from_values * values;
  for (const Vector3& x : polynomial_checks()) {
    const Eigen::VectorXd value = at(x);
    if (value.size() == 0) return false;
    if (!((monomials(x, degree) * coefficients - value.transpose()).cwiseAbs().maxCoeff() <= polynomial_tolerance)) return false;
  }
  polynomials_ = row_major(coefficients.transpose());
  turns_ = coefficients.rightCols<3>().cwiseAbs().maxCoeff() > polynomial_tolerance;
  flat_.degree = degree;
  flat_.half = half;
  return true;
}

bool LaneRegion::fit_kinematics(double half, double margin) {
  for (const int degree : {2, 6})
    if (fit_polynomials(half + margin, degree)) return true;
  return false;
}

Eigen::MatrixXd LaneRegion::actuators_by_position() const {
  const auto actuators = static_cast<Eigen::Index>(model_.mechanism.travel.size());
  Eigen::MatrixXd J(actuators, 3);
  const int terms = monomial_count(flat_.degree);
  for (Eigen::Index a = 0; a < actuators; ++a)
    for (int i = 0; i < 3; ++i) J(a, i) = polynomials_[static_cast<std::size_t>(a * terms + linear_term(flat_.degree, i))] / flat_.half;
  return J;
}

bool LaneRegion::take_tangents(const LaneModel& lane_model, StaticsWork& work) {
  const Mechanism& mechanism = model_.mechanism;
  const Units units{mechanism.length};
  auto& works = work.impl().chains;
  evaluate_all(model_, reference_, {}, work.impl());
  Matrix6 K = Matrix6::Zero();
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(mechanism.travel.size()));
  for (std::size_t i = 0; i < works.size(); ++i) {
    if (!condense(mechanism.chains[i], units, true, works[i])) return false;
    K += works[i].K;
    for (std::size_t a = 0; a < mechanism.chains[i].actuators.size(); ++a)
      G.col(mechanism.chains[i].actuators[a]) += works[i].G.col(static_cast<Eigen::Index>(a));
  }
  matrices_.clear();
  const auto list = views(mechanism, reference_, works);
  for (const SeriesView& view : list) {
    Eigen::VectorXd row_units;
    matrices_.push_back(row_major(inside_matrix(*view.series, *view.work, units, row_units)));
    matrices_.push_back(row_major(row_units.asDiagonal() * view.work->solution.middleCols(1, 6)));
    matrices_.push_back(row_major(row_units.asDiagonal() * view.work->solution.middleCols(7, view.work->G.cols())));
  }
  for (std::size_t s = 0; s < list.size(); ++s) {
    inside_.push_back(matrices_[3 * s].data());
    by_end_.push_back(matrices_[3 * s + 1].data());
    by_actuators_.push_back(matrices_[3 * s + 2].data());
  }
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(9, 9);
  system.topLeftCorner<6, 6>() = K;
  system.topRightCorner<6, 3>() = G * actuators_by_position();
  system.bottomLeftCorner<3, 3>().setIdentity();
  system.block<3, 3>(6, 3) = -skew(reference_.X_MP.R * mechanism.X_PT.p);
  Eigen::VectorXd rows(9), columns(9);
  rows << units.of_pose() / units.energy(), Vector3::Constant(1 / units.length);
  columns << units.of_pose(), Vector3::Constant(units.length);
  const Eigen::MatrixXd forward = scaled_inverse(K, rows.head<6>(), columns.head<6>());
  const Eigen::MatrixXd target = scaled_inverse(system, rows, columns);
  if (forward.size() == 0 || target.size() == 0) return false;
  forward_ = row_major(forward);
  target_ = row_major(target);
  start_ = lane_model.state_of(reference_);
  for (const double x : start_) {
    cosine_.push_back(std::cos(x));
    sine_.push_back(std::sin(x));
  }
  return true;
}

Eigen::VectorXd LaneRegion::outputs_at(const Vector3& p) const {
  const Eigen::RowVectorXd powers = monomials((p - centre_) / flat_.half, flat_.degree);
  const Eigen::Index terms = powers.size(), count = static_cast<Eigen::Index>(polynomials_.size()) / terms;
  return Eigen::Map<const Eigen::MatrixXd>(polynomials_.data(), terms, count).transpose() * powers.transpose();
}

Eigen::VectorXd LaneRegion::rho_at(const Vector3& p) const {
  return outputs_at(p).head(static_cast<Eigen::Index>(model_.mechanism.travel.size()));
}

Matrix3 LaneRegion::R_MT(const Vector3& p) const {
  return turns_ ? Matrix3(exp_so3(Vector3(outputs_at(p).tail<3>())) * R_centre_) : R_centre_;
}

std::unique_ptr<LaneRegion> LaneRegion::make(const Model& model, const LaneModel& lane_model, const Vector3& centre, double half,
                                             double margin, StaticsWork& work) {
  std::unique_ptr<LaneRegion> region(new LaneRegion(model));
  region->centre_ = centre;
  const NominalResult nominal = follow(model, model.home, {tip(model.mechanism, model.home).R, centre});
  if (nominal.status != Status::converged) return nullptr;
  if (!(actuator_jacobian(model, nominal.configuration).condition < largest_kinematic_condition)) return nullptr;
  region->nominal_ = nominal.configuration;
  region->R_centre_ = tip(model.mechanism, nominal.configuration).R;
  if (!region->fit_kinematics(half, margin)) return nullptr;
  const Equilibrium reference = solve_forward(model, nominal.configuration, {}, {}, work);
  if (reference.status != Status::converged) return nullptr;
  region->reference_ = reference.configuration;
  if (!region->take_tangents(lane_model, work)) return nullptr;
  lanes::Region& flat = region->flat_;
  for (int i = 0; i < 3; ++i) flat.centre[i] = centre[i];
  for (int i = 0; i < 9; ++i) region->R_flat_[i] = region->R_centre_(i / 3, i % 3);
  flat.R_centre = region->R_flat_.data();
  flat.polynomials = region->polynomials_.data();
  flat.start = region->start_.data();
  flat.cosine = region->cosine_.data();
  flat.sine = region->sine_.data();
  flat.inside = region->inside_.data();
  flat.by_end = region->by_end_.data();
  flat.by_actuators = region->by_actuators_.data();
  flat.forward = region->forward_.data();
  flat.target = region->target_.data();
  return region;
}

bool LaneRegion::bears(double size, bool moments, double errors, StaticsWork& work) const {
  const int exponent = static_cast<int>(std::ceil(std::log2(std::max(size, 1.0))));
  const std::array<int, 3> key{exponent, moments, errors > 0};
  const std::lock_guard lock(mutex_);
  if (const auto found = borne_.find(key); found != borne_.end()) return found->second;
  const int axes = moments ? 6 : 3;
  const double reach = load_margin * std::sqrt(axes) * std::ldexp(1.0, exponent);
  bool borne = true;
  for (int vertex = 0; vertex < 2 * axes && borne; ++vertex) {
    Load load;
    const int axis = vertex / 2;
    load.F[axis] = (vertex % 2 ? -1 : 1) * reach * (axis < 3 ? 1 : model_.mechanism.length);
    borne = solve_forward(model_, nominal_, load, {.errors = errors}, work).status == Status::converged;
  }
  return borne_[key] = borne;
}

}  // namespace counterflex
