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

/// A place on the edge: height above the tip, radius of the cutter there, sine and cosine of kappa.
struct EdgePlace {
  double z = 0, R = 0;
  double sin_kappa = 1, cos_kappa = 0;
};

/// The wrench per db at the tip, for an element at angle phi, from tangential, radial and axial force per db.
Vector6 element(double K_t, double K_r, double K_a, const EdgePlace& place, double phi) {
  const double s = std::sin(phi), c = std::cos(phi);
  const double out = K_r * place.sin_kappa + K_a * place.cos_kappa;
  const Vector3 F(-K_t * c - out * s, K_t * s - out * c, K_r * place.cos_kappa - K_a * place.sin_kappa);
  const Vector3 r(place.R * s, place.R * c, place.z);
  Vector6 wrench;
  wrench << F, r.cross(F);
  return wrench;
}

/// h^p for a feed per tooth of one.
double chip(const CuttingModel& model, const EdgePlace& place, double phi) {
  const double h = std::sin(phi) * place.sin_kappa, m_c = model.coefficients.m_c;
  return m_c == 0 ? h : std::pow(std::max(h, 0.0), 1 - m_c);
}

/// The response per db.
Response element(const CuttingModel& model, const EdgePlace& place, double phi) {
  const CuttingCoefficients& K = model.coefficients;
  Response response;
  response << chip(model, place, phi) * element(K.K_tc, K.K_rc, K.K_ac, place, phi),
      element(K.K_te, K.K_re, K.K_ae, place, phi);
  return response;
}

/// On the cylinder at height z.
EdgePlace on_cylinder(const CuttingModel& model, double z) {
  return {z, model.mill.diameter / 2};
}

/// Whether the integrands are smooth up to the ends of the cut and of the corner.
bool is_smooth(const CuttingModel& model) {
  return model.coefficients.m_c == 0 && model.mill.corner_radius == 0;
}

template <class Function>
Response integrate(const CuttingModel& model, double from, double to, const Function& f) {
  const Response zero = Response::Zero();
  return is_smooth(model) ? counterflex::integrate(from, to, zero, f)
                          : integrate_to_weak_ends(from, to, zero, f);
}

/// Angle of immersion at the radial depth of the model where the cutter has radius R.
double immersion(const CuttingModel& model, double R) {
  return std::acos(std::max(-1.0, 1 - model.radial_depth / R));
}

/// The integral over the angles of immersion at a place.
Response along_angle(const CuttingModel& model, const EdgePlace& place) {
  double entry = model.entry, exit = model.exit;
  if (model.radial_depth > 0 && model.wall == Wall::entry) exit = immersion(model, place.R);
  if (model.radial_depth > 0 && model.wall == Wall::exit) entry = pi - immersion(model, place.R);
  return integrate(model, entry, exit, [&](double phi) { return element(model, place, phi); });
}

/// The integral over the corner, up to the axial depth: db = r dkappa. Where the cutter is as wide as the
/// radial depth the angle of immersion has a corner.
Response along_corner(const CuttingModel& model) {
  const double r = model.mill.corner_radius, inner = model.mill.diameter / 2 - r;
  const double last = std::acos(std::max(0.0, 1 - model.axial_depth / r));
  const double wide = std::clamp((model.radial_depth / 2 - inner) / r, 0.0, std::sin(last));
  const auto at = [&](double kappa) -> Response {
    const double s = std::sin(kappa), c = std::cos(kappa);
    return r * along_angle(model, {r * (1 - c), inner + r * s, s, c});
  };
  return integrate(model, 0, std::asin(wide), at) + integrate(model, std::asin(wide), last, at);
}

// N / (2 pi) int_0^a int_entry^exit dF
Response mean_over_revolution(const CuttingModel& model) {
  const double r = model.mill.corner_radius;
  Response sum = Response::Zero();
  if (r > 0) sum += along_corner(model);
  if (model.axial_depth > r)
    sum += integrate(model, r, model.axial_depth,
                     [&](double z) { return along_angle(model, on_cylinder(model, z)); });
  return model.mill.flutes / (2 * pi) * sum;
}

/// The response of one flute at `phi_0`, at the height of the wall being cut: the mean over all heights z_w
/// of the wall of the force on all heights z of the flute. It depends only on u = z_w - z, and is evaluated
/// at the middle z = (a - u) / 2 of the heights with this u:
///
///     1/a int_0^a int_0^a dF(z_w - z, z) dz dz_w = 1/a int_-a^a (a - |u|) dF(u, (a - u) / 2) du
Response flute_at_wall(const CuttingModel& model, double phi_0) {
  const double a = model.axial_depth, lag = 2 * std::tan(model.mill.helix) / model.mill.diameter;
  if (lag * a < same_angle) {
    const bool engaged = phi_0 > model.entry - same_angle && phi_0 < model.exit + same_angle;
    return engaged ? Response(a * element(model, on_cylinder(model, a / 2), phi_0)) : Response::Zero();
  }
  const auto at = [&](double u) -> Response {
    return (a - std::abs(u)) / a * element(model, on_cylinder(model, (a - u) / 2), phi_0 + lag * u);
  };
  const double first = std::max(-a, (model.entry - phi_0) / lag);
  const double last = std::min(a, (model.exit - phi_0) / lag);
  Response sum = Response::Zero();
  if (first < std::min(last, 0.0)) sum += integrate(model, first, std::min(last, 0.0), at);
  if (std::max(first, 0.0) < last) sum += integrate(model, std::max(first, 0.0), last, at);
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

/// The response of a plunge: the tangential force of all edges in the middle of their length, D / 4 from the
/// axis.
Response plunge(const CuttingModel& model) {
  const CuttingCoefficients& K = model.coefficients;
  const EndMill& mill = model.mill;
  const double sin_kappa = std::sin(mill.point_angle / 2);
  const double width = mill.flutes * mill.diameter / (2 * sin_kappa);
  const Eigen::RowVector2d F_v = width * Eigen::RowVector2d(K.K_tc * std::pow(sin_kappa, 1 - K.m_c), K.K_te);
  Response response = Response::Zero();
  response.row(2) = mill.thrust_share * F_v;
  response.row(5) = mill.diameter / 4 * F_v;
  return response;
}

CutForce no_force(const char* why) {
  CutForce none;
  none.why = why;
  return none;
}

}  // namespace

double main_value(const CuttingCoefficients& coefficients) {
  return coefficients.K_tc * std::pow(mm, -coefficients.m_c);
}

CutResponse respond(const CuttingModel& model) {
  CutResponse answer{.flutes = model.mill.flutes,
                     .spindle_rpm = model.spindle_rpm,
                     .diameter = model.mill.diameter,
                     .p = 1 - model.coefficients.m_c,
                     .mills = model.axial_depth > 0,
                     .drills = model.mill.point_angle > 0};
  if (answer.mills) {
    const Response F = model.force_at == ForceAt::mean ? mean_over_revolution(model) : at_surface(model);
    answer.F_c = F.col(0);
    answer.F_e = F.col(1);
  }
  if (answer.drills) {
    const Response T = plunge(model);
    answer.T_c = T.col(0);
    answer.T_e = T.col(1);
  }
  return answer;
}

CutForce cutting_force(const CutResponse& response, double feed_m_s, double spindle_rpm, double slope) {
  const bool plunges = slope < -steepest_ramp;
  if (plunges && !response.drills) return no_force("the feed is along the tool axis (plunge)");
  if (slope > steepest_ramp) return no_force("the feed is along the tool axis (retract)");
  if (!plunges && !response.mills)
    return no_force("the cutter of its section only drills, and the feed is not along the tool axis");
  if (!(feed_m_s > 0)) return no_force("the program does not give its feed");
  const double rpm = response.spindle_rpm > 0 ? response.spindle_rpm : spindle_rpm;
  if (!(rpm > 0)) return no_force("the program does not give its spindle speed");
  CutForce force;
  const double lateral = plunges ? 1 : std::sqrt(1 - slope * slope);
  force.feed_per_tooth = feed_m_s * lateral / (rpm / 60 * response.flutes);
  const double chip = response.p == 1 ? force.feed_per_tooth : std::pow(force.feed_per_tooth, response.p);
  const Vector6 F_chip = chip * (plunges ? response.T_c : response.F_c);
  force.F = F_chip + (plunges ? response.T_e : response.F_e);
  force.chip_torque = F_chip[5];
  return force;
}

CutForce cutting_force(const CuttingModel& model, double feed_m_s, double spindle_rpm, double slope) {
  return cutting_force(respond(model), feed_m_s, spindle_rpm, slope);
}

}  // namespace counterflex
