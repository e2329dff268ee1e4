#include <algorithm>
#include <cassert>
#include <cmath>

#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/geometry/types.hpp"
#include "forces/gauss_legendre.hpp"

namespace counterflex {
namespace {

using Response = Eigen::Matrix<double, 6, 2>;  ///< columns: F_c, F_e

/// Angles closer than this are equal (rad): a tooth at the border of the cut is inside.
constexpr double same_angle = 1e-9;

/// The wrench per dz at the tip, for an element dz at height z and angle phi, from tangential, radial and
/// axial force per dz.
Vector6 element(double K_t, double K_r, double K_a, double R, double phi, double z) {
  const double s = std::sin(phi), c = std::cos(phi);
  const Vector3 F(-K_t * c - K_r * s, K_t * s - K_r * c, -K_a);
  const Vector3 r(R * s, R * c, z);
  Vector6 wrench;
  wrench << F, r.cross(F);
  return wrench;
}

/// The same for a feed per tooth of one, and for the edge: h = c sin phi.
Response element(const CuttingModel& model, double phi, double z) {
  const CuttingCoefficients& K = model.coefficients;
  const double R = model.mill.diameter / 2;
  Response response;
  response << std::sin(phi) * element(K.K_tc, K.K_rc, K.K_ac, R, phi, z),
      element(K.K_te, K.K_re, K.K_ae, R, phi, z);
  return response;
}

// N / (2 pi) int_0^a int_entry^exit dF
Response mean_over_revolution(const CuttingModel& model) {
  const Response zero = Response::Zero();
  const auto along_angle = [&](double z) {
    return integrate(model.entry, model.exit, zero, [&](double phi) { return element(model, phi, z); });
  };
  return model.mill.flutes / (2 * pi) * integrate(0, model.axial_depth, zero, along_angle);
}

/// The response of one flute at `phi_0`, at the height of the wall being cut: the mean over all heights z_w
/// of the wall of the force on all heights z of the flute. It depends only on u = z_w - z, and is evaluated
/// at the middle z = (a - u) / 2 of the heights with this u:
///
///     1/a int_0^a int_0^a dF(z_w - z, z) dz dz_w = 1/a int_-a^a (a - |u|) dF(u, (a - u) / 2) du
Response flute_at_wall(const CuttingModel& model, double phi_0) {
  const double a = model.axial_depth, lag = 2 * std::tan(model.mill.helix) / model.mill.diameter;
  const Response zero = Response::Zero();
  if (lag * a < same_angle) {
    const bool engaged = phi_0 > model.entry - same_angle && phi_0 < model.exit + same_angle;
    return engaged ? Response(a * element(model, phi_0, a / 2)) : zero;
  }
  const auto at = [&](double u) -> Response {
    return (a - std::abs(u)) / a * element(model, phi_0 + lag * u, (a - u) / 2);
  };
  const double first = std::max(-a, (model.entry - phi_0) / lag);
  const double last = std::min(a, (model.exit - phi_0) / lag);
  Response sum = zero;
  if (first < std::min(last, 0.0)) sum += integrate(first, std::min(last, 0.0), zero, at);
  if (std::max(first, 0.0) < last) sum += integrate(std::max(first, 0.0), last, zero, at);
  return sum;
}

/// The flutes are numbered without limit, once per pass: a deep helix has more than one turn.
Response at_wall(const CuttingModel& model, double phi_w) {
  const double pitch = 2 * pi / model.mill.flutes;
  const double twist = 2 * model.axial_depth * std::tan(model.mill.helix) / model.mill.diameter;
  const double first = std::floor((model.entry - phi_w - twist) / pitch);
  const double last = std::ceil((model.exit - phi_w + twist) / pitch);
  Response sum = Response::Zero();
  for (double i = first; i <= last; ++i) sum += flute_at_wall(model, phi_w + i * pitch);
  return sum;
}

Response at_surface(const CuttingModel& model) {
  switch (model.wall) {
    case Wall::entry:
      return at_wall(model, 0);
    case Wall::exit:
      return at_wall(model, pi);
    case Wall::both:
      return (at_wall(model, 0) + at_wall(model, pi)) / 2;
    case Wall::none:
      break;
  }
  assert(false && "a wall");
  return Response::Zero();
}

CutForce no_force(const char* why) {
  CutForce none;
  none.why = why;
  return none;
}

}  // namespace

CutResponse respond(const CuttingModel& model) {
  const Response response = model.force_at == ForceAt::mean ? mean_over_revolution(model) : at_surface(model);
  return {response.col(0), response.col(1), model.mill.flutes, model.spindle_rpm, model.mill.diameter};
}

CutForce cutting_force(const CutResponse& response, double feed_m_s, double spindle_rpm, double slope) {
  if (slope < -steepest_ramp) return no_force("the feed is along the tool axis (plunge)");
  if (slope > steepest_ramp) return no_force("the feed is along the tool axis (retract)");
  if (!(feed_m_s > 0)) return no_force("no feed is programmed");
  const double rpm = response.spindle_rpm > 0 ? response.spindle_rpm : spindle_rpm;
  if (!(rpm > 0)) return no_force("no spindle speed is programmed");
  CutForce force;
  force.feed_per_tooth = feed_m_s * std::sqrt(1 - slope * slope) / (rpm / 60 * response.flutes);
  force.F = response.F_c * force.feed_per_tooth + response.F_e;
  return force;
}

CutForce cutting_force(const CuttingModel& model, double feed_m_s, double spindle_rpm, double slope) {
  return cutting_force(respond(model), feed_m_s, spindle_rpm, slope);
}

}  // namespace counterflex
