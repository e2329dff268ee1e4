#include "lane_zone.hpp"

#include <algorithm>
#include <cmath>

#include "lane_polynomial.hpp"
#include "lane_strength.hpp"

namespace counterflex {
namespace {

constexpr double polynomial_tolerance = 2e-12;         // m, rad
constexpr double largest_kinematic_condition = 1e4;    // of the nominal Jacobian: far from a singularity
constexpr double constant_orientation = 1e-11;         // rad
constexpr double largest_load = 1e12;                  // N
constexpr double coarse_sizes = 0.5, fine_sizes = 2;   // of loads that are told apart, in an octave

// Actuators and rotation vector of the nominal tip against the centre's, one a row, at places that are asked for in turn.
struct KinematicsOfZone {
  const LaneZone& zone;
  const Matrix3& R_centre;
  LaneMemory memory;
  Eigen::Index actuators;

  // From row `first` on; false where a place is not reached.
  bool fill(const std::vector<Vector3>& points, Eigen::Index first, Eigen::MatrixXd& values) {
    const auto count = static_cast<Eigen::Index>(points.size());
    for (; first < count; first += lanes::width) {
      for (int lane = 0; lane < lanes::width; ++lane)
        put_in_lane(zone.place_of(points[static_cast<std::size_t>(std::min(first + lane, count - 1))]), Vector6::Zero(), lane,
                    memory.batch);
      memory.solve(zone.flat(), {.target = false, .kinematics = true, .acting = {false, false}, .go_on = false});
      for (int lane = 0; lane < lanes::width && first + lane < count; ++lane)
        if (!take(lane, values.row(first + lane))) return false;
    }
    return true;
  }

  bool take(int lane, Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> row) const {
    if (!memory.batch.converged[lane]) return false;
    for (Eigen::Index a = 0; a < actuators; ++a) row[a] = memory.rho(static_cast<std::size_t>(a), lane);
    Matrix3 R;
    for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = memory.batch.tip[i][lane];
    row.tail<3>() = log_so3(R * R_centre.transpose());
    return true;
  }
};

// The largest miss of polynomials at the points that judge them.
bool fits(const Eigen::MatrixXd& coefficients, int degree, const Eigen::MatrixXd& checks) {
  const Eigen::MatrixXd& powers = powers_at_checks(degree);
  return (powers * coefficients - checks).cwiseAbs().maxCoeff() <= polynomial_tolerance;
}

}  // namespace

bool LaneZone::find_centre(StaticsWork& work) {
  const NominalResult followed = follow(model_, model_.home, {tip(model_.mechanism, model_.home).R, centre_});
  if (followed.status != Status::converged) return false;
  const ActuatorJacobian J = actuator_jacobian(model_, followed.configuration);
  if (!(J.condition < largest_kinematic_condition)) return false;
  nominal_ = followed.configuration;
  R_centre_ = tip(model_.mechanism, nominal_).R;
  const Equilibrium reference = solve_forward(model_, nominal_, {}, {}, work);
  if (reference.status != Status::converged) return false;
  reference_ = reference.configuration;
  const Eigen::MatrixXd by_position = J.J.inverse().leftCols(3);
  if (!tangents_.take(model_, lane_model_, reference_, by_position, work)) return false;
  start_ = LaneStart(lane_model_.state_of(reference_));
  start_.enter(flat_);
  flat_.tangents = tangents_.numbers.data();
  flat_.kinematic = tangents_.kinematic.data();
  return !tangents_.kinematic.empty();
}

// The points of a fit are the first ones of every higher degree's.
bool LaneZone::fit_kinematics() {
  const auto n = static_cast<Eigen::Index>(lane_model_.program().actuators);
  KinematicsOfZone kinematics{*this, R_centre_, LaneMemory(lane_model_), n};
  Eigen::MatrixXd checks(static_cast<Eigen::Index>(polynomial_checks().size()), n + 3), values(0, n + 3);
  if (!kinematics.fill(polynomial_checks(), 0, checks)) return false;
  for (const int degree : {2, 6, 7, 8, 10}) {
    const PolynomialFit& fit = polynomial_fit(degree);
    const Eigen::Index known = values.rows();
    values.conservativeResize(static_cast<Eigen::Index>(fit.points.size()), Eigen::NoChange);
    if (!kinematics.fill(fit.points, known, values)) return false;
    const Eigen::MatrixXd coefficients = fit.from_values * values;
    if (!fits(coefficients, degree, checks)) continue;
    take_polynomials(coefficients, degree);
    turns_ = values.rightCols<3>().cwiseAbs().maxCoeff() > constant_orientation;
    return true;
  }
  return false;
}

void LaneZone::take_polynomials(const Eigen::MatrixXd& coefficients, int degree) {
  const Eigen::MatrixXd by_power = coefficients.leftCols(coefficients.cols() - 3).transpose();
  polynomials_.assign(by_power.data(), by_power.data() + by_power.size());
  orientation_ = coefficients.rightCols<3>();
  flat_.degree = degree;
  flat_.polynomials = polynomials_.data();
}

std::unique_ptr<LaneZone> LaneZone::make(const Model& model, const LaneModel& lane_model, const Vector3& centre, double half,
                                         StaticsWork& work) {
  std::unique_ptr<LaneZone> zone(new LaneZone(model, lane_model));
  zone->centre_ = centre;
  for (int i = 0; i < 3; ++i) zone->flat_.centre[i] = centre[i];
  zone->flat_.half = half;
  if (!zone->find_centre(work) || !zone->fit_kinematics()) return nullptr;
  return zone;
}

Eigen::RowVectorXd LaneZone::powers_at(const Vector3& p) const {
  return monomials((p - centre_) / flat_.half, flat_.degree);
}

Eigen::Map<const Eigen::MatrixXd> LaneZone::coefficients() const {
  return {polynomials_.data(), static_cast<Eigen::Index>(model_.mechanism.travel.size()), monomial_count(flat_.degree)};
}

Eigen::VectorXd LaneZone::rho_at(const Vector3& p) const { return coefficients() * powers_at(p).transpose(); }

Eigen::MatrixXd LaneZone::actuators_by_position(const Vector3& p) const {
  const auto slopes = derivatives_of_monomials((p - centre_) / flat_.half, flat_.degree);
  return coefficients() * slopes.leftCols<3>() / flat_.half;
}

std::vector<double> LaneZone::bend_of_actuators(const Vector3& p) const {
  constexpr int second_by[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};  // xx xy xz yy yz zz
  const auto slopes = derivatives_of_monomials((p - centre_) / flat_.half, flat_.degree);
  const Eigen::MatrixXd second = coefficients() * slopes.rightCols<6>() / (flat_.half * flat_.half);
  std::vector<double> bend;
  for (Eigen::Index a = 0; a < second.rows(); ++a)
    for (const auto& by : second_by)
      for (const int of : by) bend.push_back(second(a, of));
  return bend;
}

Matrix3 LaneZone::R_MT(const Vector3& p) const {
  return turns_ ? Matrix3(exp_so3(Vector3((powers_at(p) * orientation_).transpose())) * R_centre_) : R_centre_;
}

bool LaneZone::bears_octahedron(double force, double turning, lanes::Acting acting, StaticsWork& work) const {
  const std::array<double, 4> key{force, turning, acting.errors ? 1.0 : 0.0, acting.weights ? 1.0 : 0.0};
  if (const auto found = borne_.find(key); found != borne_.end()) return found->second;
  const auto loads = corners_of_loads(force, turning * model_.mechanism.length, lane_model_.at_platform());
  return borne_[key] = bears_everywhere(model_, lane_model_, *this, loads, acting, work);
}

// Most loads are borne four times over: they are all one then.
bool LaneZone::bears(double force, double moment, lanes::Acting acting, StaticsWork& work) const {
  const double turning = moment / model_.mechanism.length;
  if (!(force <= largest_load && turning <= largest_load)) return false;
  const std::lock_guard lock(mutex_);
  for (const double sizes : {coarse_sizes, fine_sizes}) {
    const auto rounded_up = [sizes](double size) {
      return std::exp2(std::ceil(sizes * std::log2(std::max(size, 1.0))) / sizes);
    };
    if (bears_octahedron(rounded_up(force), moment > 0 ? rounded_up(turning) : 0, acting, work)) return true;
  }
  return false;
}

}  // namespace counterflex
