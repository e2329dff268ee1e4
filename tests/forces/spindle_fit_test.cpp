#include "counterflex/forces/spindle_fit.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <random>

#include "counterflex/geometry/types.hpp"

using namespace counterflex;

namespace {

using Kind = SpindleMove::Kind;

constexpr double w_8000 = 2 * pi * 8000 / 60;

/// Rapids and cuts in turn, 40 times: 2 s of air, 3 s of a cut of group 0 or 1 at one of three feeds, and
/// sometimes 1 s of a plunge that the model does not know.
std::vector<SpindleMove> sample_moves() {
  std::vector<SpindleMove> moves;
  for (int i = 0; i < 40; ++i) {
    const std::size_t group = i % 3 == 0 ? 1 : 0;
    moves.push_back({.line = 3 * i + 1, .seconds = 2 + 0.1 * (i % 4), .kind = Kind::air, .rpm = 8000});
    if (i % 5 == 0) moves.push_back({.line = 3 * i + 2, .seconds = 1, .kind = Kind::unknown, .rpm = 8000});
    moves.push_back({3 * i + 3, 3, Kind::cut, 8000, group, 0.2 * (1 + i % 3), 0.05});
  }
  return moves;
}

/// The torque about the tool at time t, with the scales of the groups; a plunge has ten times the torque.
double torque(const std::vector<SpindleMove>& moves, const std::array<double, 2>& scales, double t) {
  if (t < 0) return 0;
  for (const SpindleMove& move : moves) {
    if (t < move.seconds)
      return move.kind == Kind::unknown ? 5
             : move.kind == Kind::air   ? 0
                                        : scales[move.group] * move.chip_torque + move.edge_torque;
    t -= move.seconds;
  }
  return 0;
}

struct LogOf {
  double offset = 7.3, interval = 0.05, clock = 1, noise = 30, idle = 400, bound = 1e9;
  unsigned seed = 7;
  std::array<double, 2> scales{1.2, 0.7};
  std::string settings{};
};

/// A log of power over time.
std::string log_text(const LogOf& of, const std::vector<SpindleMove>& moves) {
  std::mt19937 random(of.seed);
  std::normal_distribution<double> noise(0, of.noise);
  double T = 0;
  for (const SpindleMove& move : moves) T += move.seconds;
  std::string text = of.settings + "t_s, x_mm, power_kW\n";
  for (double t = 0; t < of.clock * T + of.offset + 5; t += of.interval) {
    const double P = of.idle + w_8000 * torque(moves, of.scales, (t - of.offset) / of.clock) + noise(random);
    text += fmt::format("{:.3f}, 0, {:.6f}\n", t, std::min(P, of.bound) / 1000);
  }
  return text;
}

SpindleFit fit_of(const LogOf& of) {
  const std::vector<SpindleMove> moves = sample_moves();
  return fit_spindle(read_spindle_log(log_text(of, moves), "power.csv"), moves, 2);
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_SUITE("long") {
  TEST_CASE(
      "a log of the model with noise gives back scales and idle power within three of their deviations") {
    int within = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
      CAPTURE(seed);
      const SpindleFit fit = fit_of({.offset = 3.1 * seed - 12, .seed = seed});
      REQUIRE(fit.scales.size() == 2);
      REQUIRE(fit.idle.size() == 1);
      CHECK(std::abs(fit.offset - (3.1 * seed - 12)) < 0.05);
      CHECK(fit.drift < 0.1);
      CHECK(fit.residual == doctest::Approx(30).epsilon(0.1));
      CHECK(std::abs(fit.scales[0].value - 1.2) < 3.5 * fit.scales[0].sigma);
      CHECK(std::abs(fit.scales[1].value - 0.7) < 3.5 * fit.scales[1].sigma);
      CHECK(std::abs(fit.idle[0].value.value - 400) < 3.5 * fit.idle[0].value.sigma);
      CHECK(fit.scales[0].sigma < 0.006);
      within += std::abs(fit.scales[0].value - 1.2) < fit.scales[0].sigma;
      within += std::abs(fit.scales[1].value - 0.7) < fit.scales[1].sigma;
    }
    // 68 % of 40, with four standard deviations
    CHECK(within >= 15);
    CHECK(within <= 39);
  }
}

TEST_CASE("one log of the model with noise gives back its scales") {
  const SpindleFit fit = fit_of({});
  CHECK(std::abs(fit.offset - 7.3) < 0.05);
  CHECK(std::abs(fit.scales[0].value - 1.2) < 3.5 * fit.scales[0].sigma);
  CHECK(std::abs(fit.scales[1].value - 0.7) < 3.5 * fit.scales[1].sigma);
  CHECK(fit.scales[0].sigma < 0.006);
}

TEST_CASE("without noise the scales are exact") {
  const SpindleFit fit = fit_of({.noise = 0});
  CHECK(fit.scales[0].value == doctest::Approx(1.2).epsilon(1e-4));
  CHECK(fit.scales[1].value == doctest::Approx(0.7).epsilon(1e-4));
  CHECK(fit.idle[0].value.value == doctest::Approx(400).epsilon(1e-4));
}

TEST_CASE("correlated noise makes larger deviations than white noise of the same size") {
  const std::vector<SpindleMove> moves = sample_moves();
  SpindleLog log = read_spindle_log(log_text({.noise = 0}, moves), "power.csv");
  std::mt19937 random(3);
  std::normal_distribution<double> unit(0, 1);
  double state = 0;
  for (SpindleSample& sample : log.samples) {
    state = 0.9 * state + std::sqrt(1 - 0.81) * unit(random);
    sample.value += 30 * state;
  }
  const SpindleFit fit = fit_spindle(log, moves, 2);
  CHECK(fit.correlation == doctest::Approx(0.9).epsilon(0.05));
  CHECK(fit.scales[0].sigma > 3 * fit_of({}).scales[0].sigma);
  CHECK(std::abs(fit.scales[0].value - 1.2) < 3.5 * fit.scales[0].sigma);
}

TEST_CASE("a log of torque by line needs no time") {
  const std::vector<SpindleMove> moves = sample_moves();
  std::string text = "line,torque_Nm\n";
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  for (const SpindleMove& move : moves)
    for (int i = 0; i < 12; ++i) {
      const double cut = move.kind == Kind::cut ? 1.3 * move.chip_torque + move.edge_torque : 0;
      text += fmt::format("{},{:.5f}\n", move.line, 0.6 + cut + noise(random));
    }
  const SpindleFit fit = fit_spindle(read_spindle_log(text, "torque.csv"), moves, 2);
  CHECK(fit.offset == 0);
  for (const int g : {0, 1}) {
    const SpindleFit::Value& scale = fit.scales[static_cast<std::size_t>(g)];
    CHECK(std::abs(scale.value - 1.3) < 3.5 * scale.sigma);
    CHECK(scale.sigma < 0.01);
  }
}

TEST_CASE("the edge's torque is subtracted, not scaled") {
  std::vector<SpindleMove> moves = sample_moves();
  for (SpindleMove& move : moves) move.edge_torque = move.kind == Kind::cut ? 0.5 : 0;
  const SpindleFit fit = fit_spindle(read_spindle_log(log_text({.noise = 0}, moves), "power.csv"), moves, 2);
  CHECK(fit.scales[0].value == doctest::Approx(1.2).epsilon(1e-4));
}

TEST_CASE("a log without air cuts is refused") {
  std::vector<SpindleMove> moves = sample_moves();
  const std::string text = log_text({}, moves);
  for (SpindleMove& move : moves)
    if (move.kind == Kind::air) move.kind = Kind::unknown;
  const std::string why = refusal([&] { fit_spindle(read_spindle_log(text, "power.csv"), moves, 2); });
  CHECK(
      why.find(
          "error: the log has no air cuts at 8000 1/min: 0 samples in rapid moves or above "
          "--air-above, 0.10 s or more from a change, and the idle power needs 10; state the speed of rapid "
          "moves in # rapid_mm_min, or add a longer move above the part, and state --air-above") !=
      std::string::npos);
  CHECK(why.starts_with("power.csv:"));
}

TEST_CASE("a drifting clock is refused, and a slow one within a percent is left out at the changes") {
  for (const double clock : {0.96, 1.015}) {
    CAPTURE(clock);
    const std::string why = refusal([&] { fit_of({.clock = clock}); });
    CAPTURE(why);
    CHECK(why.find("error: the clock of the log drifts") != std::string::npos);
  }
  const SpindleFit fit = fit_of({.clock = 1.002});
  CHECK(fit.drift > 0.1);
  CHECK(std::abs(fit.scales[0].value - 1.2) < 3.5 * fit.scales[0].sigma);
}

TEST_CASE(
    "a saturated channel is refused at its first row, by its repeated largest value or by its full scale") {
  const std::string repeated = refusal([&] { fit_of({.bound = 750}); });
  CHECK(repeated.find("error: the channel is saturated: ") != std::string::npos);
  CHECK(repeated.find("rows in a row have its largest value, 0.75; limit the cut or the range") !=
        std::string::npos);
  const std::string stated = refusal([&] { fit_of({.bound = 2000, .settings = "# full_scale = 0.9\n"}); });
  CHECK(stated.find("error: the channel is saturated: the value is ") != std::string::npos);
  CHECK(refusal([&] { fit_of({.settings = "# full_scale = 9\n"}); }) == "none");
}

TEST_CASE("a log of another program is refused") {
  const std::vector<SpindleMove> moves = sample_moves();
  SpindleLog log = read_spindle_log(log_text({}, moves), "power.csv");
  std::mt19937 random(1);
  std::normal_distribution<double> unit(0, 1);
  for (SpindleSample& sample : log.samples) sample.value = 500 + 100 * unit(random);
  const std::string why = refusal([&] { fit_spindle(log, moves, 2); });
  const bool named = why.find("does not follow the program") != std::string::npos ||
                     why.find("the clock of the log drifts") != std::string::npos;
  CHECK(named);
}

TEST_CASE("a log of a few rows is refused") {
  const std::vector<SpindleMove> moves = sample_moves();
  CHECK(refusal([&] { fit_spindle(read_spindle_log("t_s,power_W\n0,1\n", "l.csv"), moves, 2); }) ==
        "l.csv:2:1: error: the log has 1 rows; a fit needs at least 20");
}

TEST_CASE("rows of a log that cannot be read are refused at their place") {
  const auto why = [](const std::string& text) { return refusal([&] { read_spindle_log(text, "l.csv"); }); };
  CHECK(why("t_s,power_W\n0,1\n0,2\n") ==
        "l.csv:3:1: error: t_s is 0; it must be greater than 0, that of the row before");
  CHECK(why("t_s,power_W\n0,x\n") == "l.csv:2:3: error: the channel is 'x'; it must be a finite number");
  CHECK(why("t_s,power_W\n0\n") == "l.csv:2:1: error: the channel is missing");
  CHECK(why("time,power_W\n0,1\n") ==
        "l.csv:1:1: error: no column t_s or line; rows need a time in s or a line of the program");
  CHECK(why("t_s,load\n0,1\n") == "l.csv:1:1: error: no column power_W, power_kW or torque_Nm");
  CHECK(why("t_s,power_W,torque_Nm\n0,1,1\n") ==
        "l.csv:1:13: error: a second channel; the log must have one of power_W, power_kW and torque_Nm");
  CHECK(why("# rapid_mm_min = fast\nt_s,power_W\n") ==
        "l.csv:1:1: error: rapid_mm_min is 'fast'; it must be a number greater than 0");
  CHECK(why("t_s,power_W\n") == "l.csv:1:1: error: no rows");
  CHECK(why("") ==
        "l.csv: error: no header row; it must have t_s or line, and power_W, power_kW or torque_Nm");
}

TEST_CASE("fitted materials are tables of their own, which the sections of the cutter name") {
  const std::string text =
      "format = \"counterflex-forces 1\"\n[cutters.T1]\ndiameter_mm = 10\nflutes = 3\nhelix_deg = 35\n"
      "[cutters.T2]\ndiameter_mm = 8\nflutes = 2\nhelix_deg = 30\n"
      "[[section]]  # roughing\ntool = \"T1\"\ncutter = \"T1\"\nmaterial = \"C45\"  # as bought\n"
      "radial_share = 0.3\naxial_share = 0.1\naxial_depth_mm = 2\nside = \"slot\"\n"
      "[[section]]\ntool = \"T2\"\ncutter = \"T2\"\nmaterial = 'al6082-t6'\naxial_depth_mm = 2\nside = "
      "\"slot\"\n"
      "[[section]]\ntool = \"T3\"\ncutter = \"T2\"\nmaterial = \"C45\"\nradial_share = 0.3\naxial_share = "
      "0.1\n"
      "axial_depth_mm = 2\nside = \"slot\"\n";
  std::vector<FittedMaterial> fitted;
  const auto sections = read_cutting_model(text, "cuts.toml");
  for (const int s : {0, 1}) {
    const CutSection& section = sections[static_cast<std::size_t>(s)];
    CuttingCoefficients K = section.model.coefficients;
    for (double* chip : {&K.K_tc, &K.K_rc, &K.K_ac}) *chip *= 1.25;
    fitted.push_back({section.cutter, section.material, K, "of a test"});
  }
  const std::string out = with_fitted_materials(text, "cuts.toml", fitted);
  CHECK(out.find("material = \"C45 of T1\"  # as bought") != std::string::npos);
  const auto read = read_cutting_model(out, "fitted.toml");
  REQUIRE(read.size() == 3);
  CHECK(main_value(read[0].model.coefficients) == doctest::Approx(1.25 * 1500e6));
  CHECK(read[0].model.coefficients.m_c == 0.22);
  CHECK(read[0].model.coefficients.K_rc == doctest::Approx(0.3 * read[0].model.coefficients.K_tc));
  CHECK(read[1].material == "al6082-t6 of T2");
  CHECK(read[1].model.coefficients.K_tc == doctest::Approx(1.25 * 631e6));
  CHECK(read[1].model.coefficients.K_te == doctest::Approx(13e3));
  CHECK(main_value(read[2].model.coefficients) == doctest::Approx(1500e6));
  // A second fit replaces the tables of the first.
  std::vector<FittedMaterial> again;
  for (const FittedMaterial& first : fitted)
    again.push_back(
        {first.cutter, first.material + " of " + first.cutter, first.coefficients, "of a second test"});
  again[0].coefficients.K_tc *= 0.5;
  const std::string twice = with_fitted_materials(out, "fitted.toml", again);
  CHECK(main_value(read_cutting_model(twice, "twice.toml")[0].model.coefficients) ==
        doctest::Approx(0.5 * 1.25 * 1500e6));
  CHECK(twice.find("of a test") == std::string::npos);
  CHECK(with_fitted_materials(twice, "twice.toml", again) == twice);
}
