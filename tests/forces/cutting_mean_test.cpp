#include <doctest/doctest.h>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double c = 0.08 * mm;

/// The model's figures under their names in the formulas.
struct Letters {
  explicit Letters(const CuttingModel& model)
      : N(model.mill.flutes),
        a(model.axial_depth),
        R(model.mill.diameter / 2),
        K(model.coefficients),
        st(model.entry),
        ex(model.exit) {}
  double N, a, R;
  CuttingCoefficients K;
  double st, ex;
};

/// The textbook's mean forces between any two angles, its axial force turned to our z, and their moments with
/// the arm a/2.
Vector6 closed_form(const CuttingModel& model) {
  const auto [N, a, R, K, st, ex] = Letters(model);
  const auto difference = [&, from = st, to = ex](auto f) { return f(to) - f(from); };
  const double sin_sq = difference([](double phi) { return (2 * phi - std::sin(2 * phi)) / 4; });
  const double sin_cos = difference([](double phi) { return -std::cos(2 * phi) / 4; });
  const double sin_ = difference([](double phi) { return -std::cos(phi); });
  const double cos_ = difference([](double phi) { return std::sin(phi); });
  const double span = ex - st;
  const double per_turn = N * a / (2 * pi);
  const double Fx = per_turn * (-K.K_tc * c * sin_cos - K.K_rc * c * sin_sq - K.K_te * cos_ - K.K_re * sin_);
  const double Fy = per_turn * (K.K_tc * c * sin_sq - K.K_rc * c * sin_cos + K.K_te * sin_ - K.K_re * cos_);
  const double Fz = -per_turn * (K.K_ac * c * sin_ + K.K_ae * span);
  const double Mx = -a / 2 * Fy - R * per_turn * (K.K_ac * c * sin_cos + K.K_ae * cos_);
  const double My = a / 2 * Fx + R * per_turn * (K.K_ac * c * sin_sq + K.K_ae * sin_);
  const double Mz = R * per_turn * (K.K_tc * c * sin_ + K.K_te * span);
  return wrench(Fx, Fy, Fz, Mx, My, Mz);
}

/// Sums the elements of all teeth over a revolution, tooth by tooth and disc by disc, as it turns.
Vector6 simulated(const CuttingModel& model, int steps, int discs) {
  const auto [N, a, R, K, st, ex] = Letters(model);
  Vector6 sum = Vector6::Zero();
  for (int step = 0; step < steps; ++step) {
    for (int disc = 0; disc < discs; ++disc) {
      for (int tooth = 0; tooth < model.mill.flutes; ++tooth) {
        const double z = (disc + 0.5) * a / discs;
        const double lag = 2 * z * std::tan(model.mill.helix) / model.mill.diameter;
        const double turned = 2 * pi * (step + 0.5) / steps + 2 * pi * tooth / N - lag;
        const double phi = turned - 2 * pi * std::floor(turned / (2 * pi));
        if (phi < st || phi > ex) continue;
        const double h = c * std::sin(phi);
        const Vector3 along(std::cos(phi), -std::sin(phi), 0), outward(std::sin(phi), std::cos(phi), 0);
        const Vector3 F = -(K.K_tc * h + K.K_te) * along - (K.K_rc * h + K.K_re) * outward -
                          (K.K_ac * h + K.K_ae) * Vector3::UnitZ();
        sum.head<3>() += F;
        sum.tail<3>() += (R * outward + z * Vector3::UnitZ()).cross(F);
      }
    }
  }
  return sum * a / discs / steps;
}

}  // namespace

TEST_CASE("mean forces in a slot equal those computed by hand") {
  for (const double helix_deg : {0.0, 30.0}) {
    CAPTURE(helix_deg);
    const CuttingModel model = with_helix(sample_cut(), helix_deg);
    const auto [N, a, R, K, st, ex] = Letters(model);
    const Vector6 F = at_feed_per_tooth(model, c);
    CHECK(F[0] == doctest::Approx(-N * a / 4 * K.K_rc * c - N * a / pi * K.K_re).epsilon(1e-12));
    CHECK(F[1] == doctest::Approx(N * a / 4 * K.K_tc * c + N * a / pi * K.K_te).epsilon(1e-12));
    CHECK(F[2] == doctest::Approx(-N * a / pi * K.K_ac * c - N * a / 2 * K.K_ae).epsilon(1e-12));
    CHECK(F[5] == doctest::Approx(R * N * a * (K.K_tc * c / pi + K.K_te / 2)).epsilon(1e-12));
    // 4 flutes, 2 mm, 0.08 mm: -2 (16.8) - 8 / pi (15), 2 (56) + 8 / pi (20), -8 / pi (11.2) - 4 (1.5)
    CHECK(F[0] == doctest::Approx(-33.6 - 120 / pi).epsilon(1e-12));
    CHECK(F[1] == doctest::Approx(112 + 160 / pi).epsilon(1e-12));
    CHECK(F[2] == doctest::Approx(-89.6 / pi - 6).epsilon(1e-12));
  }
}

TEST_CASE("mean forces of half-immersion up milling equal those computed by hand") {
  for (const double helix_deg : {0.0, 30.0}) {
    CAPTURE(helix_deg);
    const CuttingModel model = between(with_helix(sample_cut(), helix_deg), 0, 90);
    const auto [N, a, R, K, st, ex] = Letters(model);
    const double chip = N * a * c / (8 * pi), edge = N * a / (2 * pi);
    const Vector6 F = at_feed_per_tooth(model, c);
    CHECK(F[0] ==
          doctest::Approx(-chip * (2 * K.K_tc + pi * K.K_rc) - edge * (K.K_te + K.K_re)).epsilon(1e-12));
    CHECK(F[1] ==
          doctest::Approx(chip * (pi * K.K_tc - 2 * K.K_rc) + edge * (K.K_te - K.K_re)).epsilon(1e-12));
    CHECK(F[2] == doctest::Approx(-edge * (K.K_ac * c + K.K_ae * pi / 2)).epsilon(1e-12));
    CHECK(F[5] == doctest::Approx(R * edge * (K.K_tc * c + K.K_te * pi / 2)).epsilon(1e-12));
  }
}

TEST_CASE("mean forces of half-immersion down milling equal those computed by hand") {
  for (const double helix_deg : {0.0, 30.0}) {
    CAPTURE(helix_deg);
    const CuttingModel model = between(with_helix(sample_cut(), helix_deg), 90, 180);
    const auto [N, a, R, K, st, ex] = Letters(model);
    const double chip = N * a * c / (8 * pi), edge = N * a / (2 * pi);
    const Vector6 F = at_feed_per_tooth(model, c);
    CHECK(F[0] ==
          doctest::Approx(chip * (2 * K.K_tc - pi * K.K_rc) + edge * (K.K_te - K.K_re)).epsilon(1e-12));
    CHECK(F[1] ==
          doctest::Approx(chip * (pi * K.K_tc + 2 * K.K_rc) + edge * (K.K_te + K.K_re)).epsilon(1e-12));
    CHECK(F[2] == doctest::Approx(-edge * (K.K_ac * c + K.K_ae * pi / 2)).epsilon(1e-12));
  }
}

TEST_CASE("mean wrenches between any two angles equal the textbook's integrals, for any helix") {
  for (const double helix_deg : {0.0, 12.0, 45.0, 60.0}) {
    for (const auto& [entry, exit] : {std::pair(0.0, 1.0), {0.0, 53.13}, {20.0, 160.0}, {126.9, 180.0}}) {
      CAPTURE(helix_deg);
      const auto& shown = entry;
      CAPTURE(shown);
      const CuttingModel model = between(with_helix(sample_cut(), helix_deg), entry, exit);
      CHECK(agree(at_feed_per_tooth(model, c), closed_form(model), 1e-12));
    }
  }
}

TEST_CASE("without axial forces the mean acts at half the depth of the cut") {
  CuttingModel model = between(with_helix(sample_cut(), 30), 0, 70);
  model.coefficients.K_ac = model.coefficients.K_ae = 0;
  const Vector6 F = at_feed_per_tooth(model, c);
  const Vector3 arm(0, 0, model.axial_depth / 2), M = arm.cross(Vector3(F.head<3>()));
  CHECK(F[3] == doctest::Approx(M.x()).epsilon(1e-12));
  CHECK(F[4] == doctest::Approx(M.y()).epsilon(1e-12));
}

TEST_CASE("the mean is that of a revolution simulated in time, straight and helical") {
  for (const double helix_deg : {0.0, 38.0}) {
    for (const auto& [entry, exit] : {std::pair(0.0, 180.0), {0.0, 60.0}, {110.0, 180.0}}) {
      CAPTURE(helix_deg);
      const auto& shown = exit;
      CAPTURE(shown);
      CuttingModel model = between(with_helix(sample_cut(), helix_deg), entry, exit);
      model.mill.flutes = 3;
      model.axial_depth = 12 * mm;
      CHECK(agree(at_feed_per_tooth(model, c), simulated(model, 1440, 60), 2e-3));
    }
  }
}

TEST_CASE("an up-milling cut pushes the tool back, a down-milling cut draws it on, both out of the spindle") {
  const Vector6 up = at_feed_per_tooth(between(sample_cut(), 0, 30), c);
  const Vector6 down = at_feed_per_tooth(between(sample_cut(), 150, 180), c);
  CHECK(up[0] < 0);
  CHECK(down[0] > 0);
  CHECK(up[2] < 0);
  CHECK(down[2] == doctest::Approx(up[2]));
  CHECK(up[5] > 0);
}
