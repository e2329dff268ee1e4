#include <doctest/doctest.h>

#include <cmath>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double c_corner = 0.08 * mm;

CuttingModel with_corner(CuttingModel model, double radius_mm) {
  model.mill.corner_radius = radius_mm * mm;
  return model;
}

Vector6 mean_of(const CuttingModel& model) {
  return cutting_force(model, c_corner * model.mill.flutes * 100, 6000, 0).F;
}

/// The section of a cutter with a corner in discs, each with its radius, normal and stock: the pass before
/// was `radial_depth` aside, with the same cutter. Angles by a fine walk around the disc.
Vector6 in_discs(const CuttingModel& model, int discs, int steps) {
  const CuttingCoefficients& K = model.coefficients;
  const double D = model.mill.diameter, r = model.mill.corner_radius, p = 1 - K.m_c;
  Vector6 sum = Vector6::Zero();
  for (int disc = 0; disc < discs; ++disc) {
    // Discs crowd at the tip, where the profile is flat.
    const double t0 = static_cast<double>(disc) / discs, t1 = static_cast<double>(disc + 1) / discs;
    const double z0 = model.axial_depth * t0 * t0, z1 = model.axial_depth * t1 * t1, z = (z0 + z1) / 2;
    const double sin_k = z < r ? std::sqrt(r * r - (r - z) * (r - z)) / r : 1,
                 cos_k = z < r ? (r - z) / r : 0;
    const double R = D / 2 - r + r * sin_k, db = (z1 - z0) / sin_k;
    for (int step = 0; step < steps; ++step) {
      const double phi = pi * (step + 0.5) / steps, h = c_corner * std::sin(phi) * sin_k;
      const double y = R * std::cos(phi);  // to the left of the feed
      if (model.radial_depth > 0 && model.wall == Wall::entry && y < R - model.radial_depth) continue;
      if (model.radial_depth > 0 && model.wall == Wall::exit && -y < R - model.radial_depth) continue;
      if (model.radial_depth == 0 && (phi < model.entry || phi > model.exit)) continue;
      const double chip = std::pow(h, p);
      const Vector3 along(std::cos(phi), -std::sin(phi), 0), out(std::sin(phi), std::cos(phi), 0);
      const Vector3 n = sin_k * out - cos_k * Vector3::UnitZ(), m = cos_k * out + sin_k * Vector3::UnitZ();
      const Vector3 F = db * (-(K.K_tc * chip + K.K_te) * along - (K.K_rc * chip + K.K_re) * n -
                              (K.K_ac * chip + K.K_ae) * m);
      sum.head<3>() += F;
      sum.tail<3>() += (R * out + z * Vector3::UnitZ()).cross(F);
    }
  }
  return model.mill.flutes * sum / (2.0 * steps);
}

CuttingModel kienzle_of(CuttingModel model) {
  const double K = 1500 * N_per_mm2 * std::pow(mm, 0.25);
  model.coefficients = {K, 0.3 * K, 0.1 * K, 0, 0, 0, 0.25};
  return model;
}

}  // namespace

TEST_CASE("a corner radius that vanishes gives the forces of the flat end") {
  for (const bool kienzle : {false, true}) {
    CAPTURE(kienzle);
    const CuttingModel cut = between(kienzle ? kienzle_of(sample_cut()) : sample_cut(), 0, 110);
    const Vector6 flat = mean_of(cut);
    CHECK(mean_of(with_corner(cut, 0)) == flat);
    double before = 1;
    for (const double radius_mm : {0.1, 0.01, 0.001}) {
      const double away =
          (mean_of(with_corner(cut, radius_mm)) - flat).head<3>().norm() / flat.head<3>().norm();
      CHECK(away < before / 5);
      before = away;
    }
    CHECK(before < 2e-3);
  }
}

TEST_CASE("a ball in a slot as deep as its radius has the closed forms of the linear law") {
  CuttingModel ball = with_corner(sample_cut(), 5);
  ball.axial_depth = 5 * mm;
  const double N = 4, R = 5 * mm, c = c_corner;
  const CuttingCoefficients K = ball.coefficients;
  const Vector6 F = mean_of(ball);
  // N / (2 pi) int int (.) R dkappa dphi, kappa over a quarter and phi over half of a turn
  CHECK(F[1] == doctest::Approx(N * R / 4 * K.K_tc * c + N * R / 2 * K.K_te).epsilon(1e-9));
  CHECK(F[0] == doctest::Approx(-N * R / (2 * pi) *
                                (K.K_rc * c * pi * pi / 8 + 2 * K.K_re + K.K_ac * c * pi / 4 + 2 * K.K_ae))
                    .epsilon(1e-9));
  CHECK(F[2] ==
        doctest::Approx(N * R / (2 * pi) * (K.K_rc * c + K.K_re * pi - K.K_ac * c * pi / 2 - K.K_ae * pi))
            .epsilon(1e-9));
  CHECK(F[5] == doctest::Approx(N * R / (2 * pi) * R * (K.K_tc * c * pi / 2 + K.K_te * pi)).epsilon(1e-9));
}

TEST_CASE("the bottom of a ball is pushed up by the radial force, which a flat end does not feel") {
  CuttingModel ball = with_corner(sample_cut(), 5), flat = sample_cut();
  ball.axial_depth = flat.axial_depth = 0.5 * mm;
  ball.coefficients.K_ac = flat.coefficients.K_ac = 0;
  ball.coefficients.K_ae = flat.coefficients.K_ae = 0;
  CHECK(mean_of(flat)[2] == 0);
  CHECK(mean_of(ball)[2] > 0);
  // At 0.5 mm of a radius of 5 mm the normal is steep: most of the radial force is axial.
  CHECK(mean_of(ball)[2] > 2 * std::abs(mean_of(ball)[0]));
}

TEST_SUITE("long") {
  TEST_CASE("ball and bull noses equal a quadrature over discs, in slots and beside the pass before") {
    for (const bool kienzle : {false, true}) {
      for (const double radius_mm : {1.5, 5.0}) {
        for (const double depth_mm : {0.6, 4.0, 7.0}) {
          for (const double radial_mm : {0.0, 0.8, 4.0}) {
            CAPTURE(kienzle);
            CAPTURE(radius_mm);
            CAPTURE(depth_mm);
            CAPTURE(radial_mm);
            for (const Wall wall : {Wall::entry, Wall::exit}) {
              CuttingModel cut = with_corner(kienzle ? kienzle_of(sample_cut()) : sample_cut(), radius_mm);
              cut.axial_depth = depth_mm * mm;
              cut.radial_depth = radial_mm * mm;
              cut.wall = wall;
              CHECK(agree(mean_of(cut), in_discs(cut, 250, 700), 4e-3));
            }
          }
        }
      }
    }
  }
}

TEST_CASE("a ball beside the pass before equals a quadrature over discs") {
  CuttingModel cut = with_corner(kienzle_of(sample_cut()), 5);
  cut.axial_depth = 4 * mm;
  cut.radial_depth = 0.8 * mm;
  cut.wall = Wall::exit;
  CHECK(agree(mean_of(cut), in_discs(cut, 250, 700), 4e-3));
}

TEST_CASE("where a ball is narrower than the radial depth it cuts a slot") {
  CuttingModel shallow = with_corner(sample_cut(), 5);
  shallow.axial_depth = 0.1 * mm;  // 2 mm wide
  CuttingModel beside = shallow;
  beside.radial_depth = 2 * mm;
  beside.wall = Wall::entry;
  CHECK(agree(mean_of(beside), mean_of(shallow), 1e-9));
}
