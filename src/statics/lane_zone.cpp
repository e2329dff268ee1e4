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
constexpr double slope_step = 1e-2;                    // of half an edge

// Actuators and rotation of the nominal tip at many places, one a row; empty where one is not reached.
Eigen::MatrixXd kinematics_at(const LaneModel& lane_model, const LaneZone& zone, const std::vector<Vector3>& places,
                              const Matrix3& R_centre) {
  LaneMemory memory(lane_model);
  const auto n = static_cast<Eigen::Index>(lane_model.program().actuators);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(places.size()), n + 3);
  for (std::size_t first = 0; first < places.size(); first += lanes::width) {
    for (int lane = 0; lane < lanes::width; ++lane)
      put_in_lane(places[std::min(first + lane, places.size() - 1)], Vector6::Zero(), lane, memory.batch);
    memory.solve(zone.flat(), {.target = false, .kinematics = true, .errors = false, .go_on = false});
    for (int lane = 0; lane < lanes::width && first + lane < places.size(); ++lane) {
      if (!memory.batch.converged[lane]) return {};
      const auto row = static_cast<Eigen::Index>(first) + lane;
      for (Eigen::Index a = 0; a < n; ++a) values(row, a) = memory.rho(static_cast<std::size_t>(a), lane);
      Matrix3 R;
      for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = memory.batch.tip[i][lane];
      values.row(row).tail<3>() = log_so3(R * R_centre.transpose());
    }
  }
  return values;
}

}  // namespace

bool LaneZone::find_centre(const LaneModel& lane_model, StaticsWork& work) {
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
  if (!tangents_.take(model_, lane_model, reference_, by_position, work)) return false;
  tangents_.enter(flat_, centre_);
  return flat_.kinematic != nullptr;
}

bool LaneZone::fit_kinematics(const LaneModel& lane_model, int degree) {
  const auto places = [this](const std::vector<Vector3>& points) {
    std::vector<Vector3> list;
    for (const Vector3& x : points) list.push_back(centre_ + flat_.half * x);
    return list;
  };
  const PolynomialFit& fit = polynomial_fit(degree);
  const Eigen::MatrixXd values = kinematics_at(lane_model, *this, places(fit.points), R_centre_);
  const Eigen::MatrixXd checks = kinematics_at(lane_model, *this, places(polynomial_checks()), R_centre_);
  if (values.size() == 0 || checks.size() == 0) return false;
  const Eigen::MatrixXd coefficients = fit.from_values * values;
  for (std::size_t i = 0; i < polynomial_checks().size(); ++i) {
    const Eigen::RowVectorXd miss =
        monomials(polynomial_checks()[i], degree) * coefficients - checks.row(static_cast<Eigen::Index>(i));
    if (!(miss.cwiseAbs().maxCoeff() <= polynomial_tolerance)) return false;
  }
  turns_ = values.rightCols<3>().cwiseAbs().maxCoeff() > constant_orientation;
  const Eigen::Index n = coefficients.cols() - 3;
  const Eigen::MatrixXd by_power = coefficients.leftCols(n).transpose();
  polynomials_.assign(by_power.data(), by_power.data() + by_power.size());
  orientation_ = coefficients.rightCols<3>();
  flat_.degree = degree;
  flat_.polynomials = polynomials_.data();
  return true;
}

std::unique_ptr<LaneZone> LaneZone::make(const Model& model, const LaneModel& lane_model, const Vector3& centre, double half,
                                         StaticsWork& work) {
  std::unique_ptr<LaneZone> zone(new LaneZone(model, lane_model));
  zone->centre_ = centre;
  for (int i = 0; i < 3; ++i) zone->flat_.centre[i] = centre[i];
  zone->flat_.half = half;
  if (!zone->find_centre(lane_model, work)) return nullptr;
  for (const int degree : {2, 6, 8, 10})
    if (zone->fit_kinematics(lane_model, degree)) return zone;
  return nullptr;
}

Eigen::RowVectorXd LaneZone::powers_at(const Vector3& p) const {
  return monomials((p - centre_) / flat_.half, flat_.degree);
}

Eigen::VectorXd LaneZone::rho_at(const Vector3& p) const {
  const Eigen::RowVectorXd powers = powers_at(p);
  const auto n = static_cast<Eigen::Index>(model_.mechanism.travel.size());
  return Eigen::Map<const Eigen::MatrixXd>(polynomials_.data(), n, powers.size()) * powers.transpose();
}

Eigen::MatrixXd LaneZone::actuators_by_position(const Vector3& p) const {
  const double h = slope_step * flat_.half;
  Eigen::MatrixXd J(static_cast<Eigen::Index>(model_.mechanism.travel.size()), 3);
  for (int i = 0; i < 3; ++i) J.col(i) = (rho_at(p + h * Vector3::Unit(i)) - rho_at(p - h * Vector3::Unit(i))) / (2 * h);
  return J;
}

std::array<Eigen::MatrixXd, 3> LaneZone::bend_of_actuators(const Vector3& p) const {
  const double h = slope_step * flat_.half;
  std::array<Eigen::MatrixXd, 3> bend;
  for (int i = 0; i < 3; ++i)
    bend[static_cast<std::size_t>(i)] =
        (actuators_by_position(p + h * Vector3::Unit(i)) - actuators_by_position(p - h * Vector3::Unit(i))) / (2 * h);
  return bend;
}

Matrix3 LaneZone::R_MT(const Vector3& p) const {
  return turns_ ? Matrix3(exp_so3(Vector3((powers_at(p) * orientation_).transpose())) * R_centre_) : R_centre_;
}

bool LaneZone::bears_octahedron(double force, double turning, bool errors, StaticsWork& work) const {
  const std::array<double, 3> key{force, turning, errors ? 1.0 : 0.0};
  if (const auto found = borne_.find(key); found != borne_.end()) return found->second;
  const auto loads = corners_of_loads(force, turning * model_.mechanism.length, lane_model_.at_platform());
  return borne_[key] = bears_everywhere(model_, lane_model_, *this, loads, errors, work);
}

// Most loads are borne four times over: they are all one then.
bool LaneZone::bears(double force, double moment, bool errors, StaticsWork& work) const {
  const double turning = moment / model_.mechanism.length;
  if (!(force <= largest_load && turning <= largest_load)) return false;
  const std::lock_guard lock(mutex_);
  for (const double sizes : {coarse_sizes, fine_sizes}) {
    const auto rounded_up = [sizes](double size) {
      return std::exp2(std::ceil(sizes * std::log2(std::max(size, 1.0))) / sizes);
    };
    if (bears_octahedron(rounded_up(force), moment > 0 ? rounded_up(turning) : 0, errors, work)) return true;
  }
  return false;
}

std::unique_ptr<LaneCell> LaneCell::make(const Model& model, const LaneModel& lane_model, std::shared_ptr<const LaneZone> zone,
                                         const Vector3& centre, StaticsWork& work) {
  auto cell = std::make_unique<LaneCell>();
  cell->zone_ = std::move(zone);
  LaneMemory memory(lane_model);
  for (int lane = 0; lane < lanes::width; ++lane) put_in_lane(centre, Vector6::Zero(), lane, memory.batch);
  memory.solve(cell->zone_->flat(), {.target = false, .kinematics = false, .errors = true, .go_on = false});
  if (!memory.batch.converged[0]) return nullptr;
  const Configuration reference = lane_model.configuration_of(memory.state(0).data(), cell->zone_->reference());
  if (!cell->tangents_.take(model, lane_model, reference, cell->zone_->actuators_by_position(centre), work)) return nullptr;
  cell->flat_ = cell->zone_->flat();
  cell->tangents_.bend(cell->zone_->bend_of_actuators(centre));
  cell->tangents_.enter(cell->flat_, centre);
  return cell;
}

}  // namespace counterflex
