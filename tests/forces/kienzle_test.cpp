#include <doctest/doctest.h>

#include <cmath>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double c_kienzle = 0.08 * mm;

/// kc1.1 = 1500 N/mm2, mc = 0.22, radial share 0.35, axial share 0.2.
CuttingModel kienzle_cut(double entry_deg, double exit_deg) {
  CuttingModel model = between(with_helix(sample_cut(), 30), entry_deg, exit_deg);
  const double K = 1500 * N_per_mm2 * std::pow(mm, 0.22);
  model.coefficients = {K, 0.35 * K, 0.2 * K, 0, 0, 0, 0.22};
  return model;
}

/// int_0^pi sin^q, by the gamma function.
double slot_integral(double q) {
  return std::sqrt(pi) * std::tgamma((q + 1) / 2) / std::tgamma(q / 2 + 1);
}

/// N a / (2 pi) kc1.1 (c / mm)^p mm: the factor of the integrals over phi (N).
double factor(const CuttingModel& model) {
  const double N = model.mill.flutes, a = model.axial_depth, p = 1 - model.coefficients.m_c;
  return N * a / (2 * pi) * 1500 * N_per_mm2 * std::pow(c_kienzle / mm, p) * mm;
}

/// Sums the teeth at every step of a revolution, with kc of the chip thickness there.
Vector6 turned(const CuttingModel& model, int steps) {
  Vector6 sum = Vector6::Zero();
  const double a = model.axial_depth, R = model.mill.diameter / 2;
  for (int step = 0; step < steps; ++step) {
    const double phi = 2 * pi * (step + 0.5) / steps, h_mm = c_kienzle / mm * std::sin(phi);
    if (phi < model.entry || phi > model.exit || h_mm <= 0) continue;
    const double kc = 1500 * N_per_mm2 * std::pow(h_mm, -0.22);
    const double F_t = kc * h_mm * mm * a, F_r = 0.35 * F_t, F_a = 0.2 * F_t;
    const Vector3 along(std::cos(phi), -std::sin(phi), 0), out(std::sin(phi), std::cos(phi), 0);
    const Vector3 F = -F_t * along - F_r * out - F_a * Vector3::UnitZ();
    sum.head<3>() += F;
    sum.tail<3>() += (R * out + a / 2 * Vector3::UnitZ()).cross(F);
  }
  return model.mill.flutes * sum / steps;
}

}  // namespace

TEST_CASE("Kienzle's mean forces in a slot equal those computed by hand") {
  const CuttingModel slot = kienzle_cut(0, 180);
  const double q = 0.78, f = factor(slot), R = slot.mill.diameter / 2;
  const Vector6 F = cutting_force(slot, c_kienzle * 4 * 100, 6000, 0).F;
  CHECK(F[0] == doctest::Approx(-0.35 * f * slot_integral(q + 1)).epsilon(1e-9));
  CHECK(F[1] == doctest::Approx(f * slot_integral(q + 1)).epsilon(1e-9));
  CHECK(F[2] == doctest::Approx(-0.2 * f * slot_integral(q)).epsilon(1e-9));
  CHECK(F[5] == doctest::Approx(R * f * slot_integral(q)).epsilon(1e-9));
  // In numbers: 4 teeth, 2 mm, 0.08 mm: 8 / (2 pi) 1500 0.08^0.78 = 266.325 N.
  CHECK(f == doctest::Approx(266.325).epsilon(1e-5));
  CHECK(F[1] == doctest::Approx(266.325 * slot_integral(1.78)).epsilon(1e-5));
}

TEST_CASE("Kienzle's mean forces of half-immersion up and down milling equal those computed by hand") {
  const double q = 0.78, half = slot_integral(q + 1) / 2;
  for (const bool up : {true, false}) {
    CAPTURE(up);
    const CuttingModel cut = up ? kienzle_cut(0, 90) : kienzle_cut(90, 180);
    const double f = factor(cut), R = cut.mill.diameter / 2, side = up ? 1 : -1;
    const Vector6 F = cutting_force(cut, c_kienzle * 4 * 100, 6000, 0).F;
    // int_0^(pi/2) sin^q cos = 1 / (q + 1)
    CHECK(F[0] == doctest::Approx(f * (-side / (q + 1) - 0.35 * half)).epsilon(1e-9));
    CHECK(F[1] == doctest::Approx(f * (half - side * 0.35 / (q + 1))).epsilon(1e-9));
    CHECK(F[2] == doctest::Approx(-0.2 * f * slot_integral(q) / 2).epsilon(1e-9));
    CHECK(F[5] == doctest::Approx(R * f * slot_integral(q) / 2).epsilon(1e-9));
  }
}

TEST_CASE("Kienzle's mean forces are those of a revolution turned step by step") {
  for (const auto& [entry, exit] : {std::pair(0.0, 180.0), {0.0, 90.0}, {130.0, 180.0}, {20.0, 70.0}}) {
    const auto& shown = entry;
    CAPTURE(shown);
    const CuttingModel cut = kienzle_cut(entry, exit);
    CHECK(agree(cutting_force(cut, c_kienzle * 4 * 100, 6000, 0).F, turned(cut, 200000), 2e-4));
  }
}

TEST_CASE("with mc = 0 Kienzle's law is the linear one") {
  CuttingModel linear = kienzle_cut(0, 110), small = linear;
  linear.coefficients.m_c = 0;
  small.coefficients.m_c = 1e-9;
  const Vector6 F = cutting_force(linear, 0.03, 6000, 0).F;
  CHECK(agree(cutting_force(small, 0.03, 6000, 0).F, F, 1e-7));
}

TEST_CASE("half of the feed has 2^-(1 - mc) of Kienzle's force") {
  const CuttingModel cut = kienzle_cut(0, 70);
  const Vector6 whole = cutting_force(cut, 0.03, 6000, 0).F, half = cutting_force(cut, 0.015, 6000, 0).F;
  CHECK(agree(half, std::pow(2, -0.78) * whole, 1e-12));
}

TEST_CASE("Kienzle's force at the surface has no chip at the wall, and that of the teeth inside the cut") {
  CuttingModel up = at_wall(kienzle_cut(0, 60), Wall::entry);
  up.mill.helix = 0;
  CHECK(cutting_force(up, 0.03, 6000, 0).F.norm() < 1e-9);
  CuttingModel deep = at_wall(kienzle_cut(0, 130), Wall::entry);
  deep.mill.helix = 0;  // four flutes: the next tooth is at 90 degrees
  const double c = 0.03 / 400, F_t = 1500 * N_per_mm2 * std::pow(c / mm, 0.78) * mm * deep.axial_depth;
  const Vector6 F = cutting_force(deep, 0.03, 6000, 0).F;
  CHECK(F[1] == doctest::Approx(F_t).epsilon(1e-9));
  CHECK(F[0] == doctest::Approx(-0.35 * F_t).epsilon(1e-9));
  const CuttingModel twisted = with_helix(deep, 1e-3);
  CHECK(agree(cutting_force(twisted, 0.03, 6000, 0).F, F, 1e-3));
}
