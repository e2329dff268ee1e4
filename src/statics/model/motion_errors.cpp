#include "statics/model/motion_errors.hpp"

#include <algorithm>
#include <cmath>

#include "statics/model/part.hpp"

namespace counterflex {
namespace {

// Of the parabolas through three points: linear in the values.
double parabola_slope(double h0, double h1, double d0, double d1) {
  return (h1 * d0 + h0 * d1) / (h0 + h1);
}
double parabola_end_slope(double h0, double h1, double d0, double d1) {
  return ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
}

double inner_slope(double h0, double h1, double d0, double d1) {
  if (!(d0 * d1 > 0)) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// Of the parabola through the three points at an end, limited where it would not be monotone.
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = parabola_end_slope(h0, h1, d0, d1);
  if (!(slope * d0 > 0)) return 0;
  return d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0) ? 3 * d0 : slope;
}

void set_slopes(bool is_linear, MotionErrors& errors) {
  const auto inner = is_linear ? parabola_slope : inner_slope;
  const auto end = is_linear ? parabola_end_slope : end_slope;
  const std::size_t n = errors.rho.size();
  errors.slope.resize(n);
  const auto h = [&](std::size_t k) { return errors.rho[k + 1] - errors.rho[k]; };
  for (std::size_t i = 0; i < 6; ++i) {
    const auto d = [&](std::size_t k) { return (errors.value[k + 1][i] - errors.value[k][i]) / h(k); };
    if (n == 2) {
      errors.slope[0][i] = errors.slope[1][i] = d(0);
      continue;
    }
    errors.slope[0][i] = end(h(0), h(1), d(0), d(1));
    errors.slope[n - 1][i] = end(h(n - 2), h(n - 3), d(n - 2), d(n - 3));
    for (std::size_t k = 1; k + 1 < n; ++k) errors.slope[k][i] = inner(h(k - 1), h(k), d(k - 1), d(k));
  }
}

struct Sixfold {
  Vector6 value, slope;
};

Vector6 six(const MotionErrors::Six& numbers) {
  return Eigen::Map<const Vector6>(numbers.data());
}

/// About the axis: the sum of an sin n rho + bn cos n rho.
Sixfold harmonics_at(const Joint& joint, const MotionErrors& errors, double rho) {
  double error = 0, slope = 0;
  for (std::size_t k = 0; k + 1 < errors.harmonics.size(); k += 2) {
    const double n = static_cast<double>(k / 2 + 1), a = errors.harmonics[k], b = errors.harmonics[k + 1];
    error += a * std::sin(n * rho) + b * std::cos(n * rho);
    slope += n * (a * std::cos(n * rho) - b * std::sin(n * rho));
  }
  Vector6 axis;
  axis << Vector3::Zero(), joint.axis;
  return {error * axis, slope * axis};
}

Sixfold at(const Joint& joint, const MotionErrors& errors, double rho) {
  if (!errors.harmonics.empty()) return harmonics_at(joint, errors, rho);
  const std::vector<double>& knots = errors.rho;
  if (!(rho > knots.front())) return {six(errors.value.front()), Vector6::Zero()};
  if (!(rho < knots.back())) return {six(errors.value.back()), Vector6::Zero()};
  const auto after = std::upper_bound(knots.begin(), knots.end(), rho);
  const auto k = static_cast<std::size_t>(after - knots.begin()) - 1;
  const double h = knots[k + 1] - knots[k], t = (rho - knots[k]) / h;
  const Vector6 first = six(errors.value[k]), step = six(errors.value[k + 1]) - first;
  const Vector6 a = h * six(errors.slope[k]) - step, b = step - h * six(errors.slope[k + 1]);
  // y0 + t step + t (1 - t) ((1 - t) a + t b)
  const Vector6 c = (1 - t) * a + t * b;
  return {first + t * step + t * (1 - t) * c, (step + (1 - 2 * t) * c + t * (1 - t) * (b - a)) / h};
}

}  // namespace

MotionErrors motion_errors(const ErrorTable& table, const ShownValue& shown) {
  MotionErrors errors;
  for (const double position : table.positions) errors.rho.push_back(shown.sign * (position - shown.zero));
  for (const Vector6& e : table.errors) errors.value.push_back({e[0], e[1], e[2], e[3], e[4], e[5]});
  if (shown.sign < 0) {
    std::reverse(errors.rho.begin(), errors.rho.end());
    std::reverse(errors.value.begin(), errors.value.end());
  }
  set_slopes(table.sigma.has_value(), errors);
  return errors;
}

MotionErrors motion_errors(const Actuator& actuator) {
  if (actuator.errors) return motion_errors(*actuator.errors, actuator.shown);
  MotionErrors errors;
  const auto is_zero = [](double h) { return h == 0; };
  if (std::all_of(actuator.harmonics.begin(), actuator.harmonics.end(), is_zero)) return errors;
  // The joint turns by sign times what is shown, less the zero: sin n (sign rho + zero) expanded.
  for (std::size_t k = 0; k + 1 < actuator.harmonics.size(); k += 2) {
    const double phase = static_cast<double>(k / 2 + 1) * actuator.shown.zero, sign = actuator.shown.sign;
    const double a = actuator.harmonics[k], b = actuator.harmonics[k + 1];
    errors.harmonics.push_back(a * std::cos(phase) - b * std::sin(phase));
    errors.harmonics.push_back(sign * (a * std::sin(phase) + b * std::cos(phase)));
  }
  return errors;
}

AxisErrorAt error_along(const Joint& joint, const MotionErrors& errors, double value) {
  const Sixfold e = at(joint, errors, value);
  const auto along = [&](const Vector6& six) {
    return joint.axis.dot(joint.kind == JointKind::prismatic ? Vector3(six.head<3>())
                                                             : Vector3(six.tail<3>()));
  };
  return {along(e.value), along(e.slope)};
}

JointMotion joint_motion(const Joint& joint, const MotionErrors& errors, double value, double commanded,
                         double s) {
  const auto [e, slope] = at(joint, errors, commanded);
  const Pose X = displacement(joint, value);
  const Vector3 phi = s * e.tail<3>();
  const Matrix3 R = exp_so3(phi);
  JointMotion motion{
      {R * X.R, X.p + s * e.head<3>()}, s * slope.head<3>(), s * (left_jacobian(phi) * slope.tail<3>())};
  if (joint.kind == JointKind::prismatic)
    motion.v += joint.axis;
  else
    motion.w += R * joint.axis;
  return motion;
}

}  // namespace counterflex
