#include <doctest/doctest.h>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double c_surface = 0.08 * mm;

/// The wrench of a straight tooth of depth a at an angle, from its parts.
Vector6 tooth_at(const CuttingModel& model, double phi_deg) {
  const CuttingCoefficients& K = model.coefficients;
  const double phi = phi_deg * deg, h = c_surface * std::sin(phi), a = model.axial_depth;
  const double R = model.mill.diameter / 2;
  const double F_t = (K.K_tc * h + K.K_te) * a, F_r = (K.K_rc * h + K.K_re) * a,
               F_a = (K.K_ac * h + K.K_ae) * a;
  const double Fx = -F_t * std::cos(phi) - F_r * std::sin(phi),
               Fy = F_t * std::sin(phi) - F_r * std::cos(phi);
  return wrench(Fx, Fy, -F_a, -R * std::cos(phi) * F_a - a / 2 * Fy, a / 2 * Fx + R * std::sin(phi) * F_a,
                R * F_t);
}

/// The force of all teeth when the wall at `phi_w_deg` is cut, height by height of the wall and disc by disc.
Vector6 simulated_at_wall(const CuttingModel& model, double phi_w_deg, int discs) {
  Vector6 sum = Vector6::Zero();
  CuttingModel disc = model;
  disc.axial_depth = model.axial_depth / discs;
  const double twist = 2 * std::tan(model.mill.helix) / model.mill.diameter;
  const double entry_deg = model.entry / deg, exit_deg = model.exit / deg;
  for (int made = 0; made < discs; ++made) {
    for (int k = 0; k < discs; ++k) {
      for (int tooth = 0; tooth < model.mill.flutes; ++tooth) {
        // The wall is cut between the middles of discs, so that no disc is at its angle.
        const double ahead = (made + 0.5 - k - (made % 2 == 0 ? 0.25 : 0.75)) * disc.axial_depth * twist;
        const double turned = phi_w_deg + ahead / deg + 360.0 * tooth / model.mill.flutes;
        const double phi = turned - 360 * std::floor(turned / 360);
        if (phi < entry_deg || phi > exit_deg) continue;
        Vector6 F = tooth_at(disc, phi);
        F.tail<3>() += Vector3(0, 0, k * disc.axial_depth).cross(Vector3(F.head<3>()));
        sum += F / discs;
      }
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("the surface force of one straight tooth in the cut is that of its edge") {
  const CuttingModel up = at_wall(between(sample_cut(), 0, 60), Wall::entry);
  const CuttingModel down = at_wall(between(sample_cut(), 120, 180), Wall::exit);
  const CuttingCoefficients& K = up.coefficients;
  const double a = up.axial_depth, R = up.mill.diameter / 2;
  const Vector6 F_up = at_feed_per_tooth(up, c_surface), F_down = at_feed_per_tooth(down, c_surface);
  CHECK(agree(F_up,
              a * wrench(-K.K_te, -K.K_re, -K.K_ae, a / 2 * K.K_re - R * K.K_ae, -a / 2 * K.K_te, R * K.K_te),
              1e-12));
  CHECK(agree(F_down,
              a * wrench(K.K_te, K.K_re, -K.K_ae, -a / 2 * K.K_re + R * K.K_ae, a / 2 * K.K_te, R * K.K_te),
              1e-12));
}

TEST_CASE("the surface force of straight flutes is the sum of the teeth that cut while the wall is made") {
  CuttingModel up = at_wall(between(sample_cut(), 0, 130), Wall::entry);
  CHECK(agree(at_feed_per_tooth(up, c_surface), tooth_at(up, 0) + tooth_at(up, 90), 1e-12));
  up.mill.flutes = 6;
  CHECK(
      agree(at_feed_per_tooth(up, c_surface), tooth_at(up, 0) + tooth_at(up, 60) + tooth_at(up, 120), 1e-12));
  CuttingModel down = at_wall(between(sample_cut(), 45, 180), Wall::exit);
  down.mill.flutes = 3;
  CHECK(agree(at_feed_per_tooth(down, c_surface), tooth_at(down, 180) + tooth_at(down, 60), 1e-12));
  down.mill.flutes = 2;
  CHECK(agree(at_feed_per_tooth(down, c_surface), tooth_at(down, 180), 1e-12));
}

TEST_CASE("a tooth at the other end of the cut counts, for any rounding of its angle") {
  for (int flutes = 3; flutes <= 12; ++flutes) {
    CAPTURE(flutes);
    CuttingModel up = at_wall(between(sample_cut(), 0, 120), Wall::entry);
    up.mill.flutes = flutes;
    up.exit = std::acos(1 - 2 * (up.mill.diameter * (1 - std::cos(2 * pi / flutes)) / 2) / up.mill.diameter);
    const CuttingModel beyond = between(up, 0, up.exit / deg + 1e-3);
    CHECK(agree(at_feed_per_tooth(up, c_surface), at_feed_per_tooth(beyond, c_surface), 1e-9));
  }
}

TEST_CASE("in a slot the surface force is the mean of those at both walls") {
  CuttingModel slot = sample_cut();
  slot.mill.flutes = 3;
  const Vector6 entry = tooth_at(slot, 0) + tooth_at(slot, 120),
                exit = tooth_at(slot, 180) + tooth_at(slot, 60);
  CHECK(agree(at_feed_per_tooth(at_wall(slot, Wall::both), c_surface), (entry + exit) / 2, 1e-12));
}

TEST_CASE("the surface force of a helical cutter is that of its discs, made height by height") {
  for (const double helix_deg : {10.0, 45.0}) {
    for (const double depth_mm : {2.0, 15.0}) {
      CAPTURE(helix_deg);
      CAPTURE(depth_mm);
      CuttingModel up = at_wall(between(with_helix(sample_cut(), helix_deg), 0, 75), Wall::entry);
      CuttingModel down = at_wall(between(with_helix(sample_cut(), helix_deg), 105, 180), Wall::exit);
      up.axial_depth = down.axial_depth = depth_mm * mm;
      CHECK(agree(at_feed_per_tooth(up, c_surface), simulated_at_wall(up, 0, 600), 5e-3));
      CHECK(agree(at_feed_per_tooth(down, c_surface), simulated_at_wall(down, 180, 600), 5e-3));
    }
  }
}

TEST_CASE("where the twist of the flutes is a whole pitch, force and torque at the wall are the mean ones") {
  for (const int flutes : {2, 3, 4}) {
    CAPTURE(flutes);
    CuttingModel model = between(with_helix(sample_cut(), 40), 0, 80);
    model.mill.flutes = flutes;
    model.axial_depth = 2 * pi / flutes * model.mill.diameter / (2 * std::tan(model.mill.helix));
    const Vector6 mean = at_feed_per_tooth(model, c_surface);
    const Vector6 wall = at_feed_per_tooth(at_wall(model, Wall::entry), c_surface);
    for (const int i : {0, 1, 2, 5}) CHECK(wall[i] == doctest::Approx(mean[i]).epsilon(1e-10));
  }
}

TEST_CASE(
    "with a vanishing helix the teeth inside the cut act as straight ones, that at the wall with half its "
    "edge") {
  const CuttingModel straight = at_wall(between(sample_cut(), 0, 130), Wall::entry);
  const Vector6 limit = tooth_at(straight, 90) + tooth_at(straight, 0) / 2;
  double before = 1;
  for (const double helix_deg : {1.0, 0.1, 0.01, 0.001}) {
    CAPTURE(helix_deg);
    const Vector6 F = at_feed_per_tooth(with_helix(straight, helix_deg), c_surface);
    const double away = (F - limit).head<3>().norm() / limit.head<3>().norm();
    CHECK(away < before / 5);
    before = away;
  }
  CuttingModel sharp = straight;
  sharp.coefficients.K_te = sharp.coefficients.K_re = sharp.coefficients.K_ae = 0;
  CHECK(agree(at_feed_per_tooth(with_helix(sharp, 1e-4), c_surface), at_feed_per_tooth(sharp, c_surface),
              1e-5));
}
