/// Noise of repeated readings, and what a fit misses beyond it.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

const std::string square_mill = R"(
format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[springs.head]
stiffness_diag_si = [2.0e7, 2.0e7, 6.0e7, 1.0e6, 1.0e6, 2.0e6]
[[chain]]
name = "axes"
errors.XY = { rpy_deg = [0, 0, %] }
elements = [
  { actuator = "prismatic", axis = "x" },
  { error = "XY" },
  { actuator = "prismatic", axis = "y" },
  { actuator = "prismatic", axis = "z" },
  { spring = "head" },
]
)";

/// A mill whose Y is out of square by an angle (deg).
Machine mill_out_of_square(const std::string& angle) {
  std::string text = square_mill;
  text.replace(text.find('%'), 1, angle);
  return read_machine(text, "mill.toml");
}

/// Readings of a tracker at `places` places, `count` at each, with `sigma` noise along each axis.
std::string repeats(int places, int count, double sigma_mm, Random& random) {
  std::string csv = "kind,session,place,x_mm,y_mm,z_mm\n";
  for (int place = 0; place < places; ++place)
    for (int i = 0; i < count; ++i)
      csv += fmt::format("repeat,tracker,P{},{:.6f},{:.6f},{:.6f}\n", place,
                         100 * place + sigma_mm * normal(random), sigma_mm * normal(random),
                         sigma_mm * normal(random));
  return csv;
}

SessionNoise noise_with(const Machine& nominal, const Machine& truth, IdentifyOptions options) {
  Random random(4);
  Measurements all;
  add_tracker(truth, {from_rpy(Vector3(0.3, -0.2, 2.0)), Vector3(1.2, -3.1, 0.4)}, Pose{}, false, 80, 0.3, 0,
              1e-5, random, all, "tracker");
  read_measurements(repeats(6, 20, 0.01, random), "repeats.csv", nominal, all);
  const Identification found = identify(nominal, all, options);
  REQUIRE(found.noise.size() == 1);
  return found.noise[0];
}

/// 80 pushes at 8 places; `more` gives further columns of a row.
std::string pushes_at_places(const std::string& columns, const std::function<std::string(int)>& more) {
  Random random(4);
  std::string csv = "kind,X_mm,Y_mm,Z_mm,fx_N,fy_N,fz_N,gx,gy,gz,reading_um" + columns + "\n";
  for (int place = 0; place < 8; ++place)
    for (int i = 0; i < 10; ++i)
      csv += fmt::format("static_push,{},0,0,400,0,0,1,0,0,{:.3f},{}\n", 10 * place, 20 + 2 * normal(random),
                         more(i));
  return csv;
}

std::vector<SessionNoise> noise_of(const std::string& csv) {
  const Machine machine = mill_out_of_square("0");
  Measurements all;
  read_measurements(csv, "pushes.csv", machine, all);
  return identify(machine, all, {}).noise;
}

std::string error_of_repeats(const std::string& rows) {
  const Machine machine = mill_out_of_square("0");
  Measurements all;
  try {
    read_measurements(rows, "r.csv", machine, all);
    Random random(4);
    add_tracker(machine, Pose{}, Pose{}, false, 12, 0.3, 0, 1e-5, random, all, "tracker");
    identify(machine, all, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("repeats give the noise of their session, which is all that a complete model misses") {
  const SessionNoise noise = noise_with(mill_out_of_square("0"), mill_out_of_square("0.01"), {});
  CHECK(noise.session == "tracker");
  CHECK(noise.freedoms == 6 * 19);
  // A distance in space has three components; the estimate is good to 1 / sqrt(2 * 3 * 114) = 4 %.
  CHECK(noise.noise == doctest::Approx(std::sqrt(3.0) * 1e-5).epsilon(0.1));
  CHECK(noise.misfit == doctest::Approx(noise.noise_of_means).epsilon(0.15));
  CHECK_FALSE(noise.is_lacking);
}

TEST_CASE("an error of the machine that the fit must not change is lack of fit") {
  Machine nominal = mill_out_of_square("0");
  for (const Parameter& parameter : parameters(nominal))
    if (parameter.name.starts_with("XY"))
      nominal.parameters.push_back({parameter.name, NumberSource::measured, 0, ""});
  const SessionNoise noise = noise_with(nominal, mill_out_of_square("0.03"), {});
  CHECK(noise.is_lacking);
  CHECK(noise.lack_of_fit > 2 * noise.noise);
  CHECK(noise.lack_of_fit * noise.lack_of_fit + noise.noise_of_means * noise.noise_of_means ==
        doctest::Approx(noise.misfit * noise.misfit));
}

TEST_CASE("equal readings do not show the noise, and so no lack of fit") {
  const Machine machine = mill_out_of_square("0");
  std::string csv = "kind,X_mm,Y_mm,Z_mm,fx_N,fy_N,fz_N,gx,gy,gz,reading_um,sigma_um\n";
  for (int place = 0; place < 8; ++place)
    for (int i = 0; i < 3; ++i)
      csv += fmt::format("static_push,{},0,0,400,0,0,1,0,0,{},5\n", 10 * place, 20 + place % 2);
  Measurements all;
  read_measurements(csv, "pushes.csv", machine, all);
  const Identification found = identify(machine, all, {});
  CHECK(found.noise.empty());
  CHECK_FALSE(found.repeatability.has_value());
}

TEST_CASE("rows at nearly equal states are repeats, too") {
  const Machine machine = mill_out_of_square("0");
  Random random(4);
  std::string csv = "kind,X_mm,Y_mm,Z_mm,fx_N,fy_N,fz_N,gx,gy,gz,reading_um\n";
  for (int place = 0; place < 8; ++place)
    for (int i = 0; i < 10; ++i)
      csv += fmt::format("static_push,{:.4f},0,0,400,0,0,1,0,0,{:.3f}\n",
                         10 * place + uniform(random, -0.004, 0.004), 20 + 2 * normal(random));
  Measurements all;
  read_measurements(csv, "pushes.csv", machine, all);
  const Identification found = identify(machine, all, {});
  REQUIRE(found.noise.size() == 1);
  CHECK(found.noise[0].freedoms == 72);
  CHECK(found.noise[0].noise == doctest::Approx(2e-6).epsilon(0.2));
  CHECK(found.noise[0].noise_of_means == doctest::Approx(found.noise[0].noise / std::sqrt(10.0)));
  CHECK(*found.repeatability == doctest::Approx(found.noise[0].noise));
}

TEST_CASE("pushes that a gauge reads elsewhere, or in another phase, are not repeats") {
  const auto heights = [](int i) { return fmt::format("{}", 30 * i); };
  CHECK(noise_of(pushes_at_places(",gauge_z_mm", heights)).empty());
  const auto phases = [](int i) { return std::string(i % 2 == 0 ? "loading" : "unloading"); };
  const std::vector<SessionNoise> noise = noise_of(pushes_at_places(",phase", phases));
  REQUIRE(noise.size() == 1);
  CHECK(noise[0].freedoms == 8 * 2 * 4);
}

TEST_CASE("repeats that show nothing are refused at their place") {
  const std::string head = "kind,session,place,x_mm,y_mm,z_mm,reading_um\n";
  CHECK(error_of_repeats("kind,x_mm,y_mm,z_mm\nrepeat,1,2,3\n") ==
        "r.csv:2:1: error: rows of kind repeat need a column \"place\"");
  CHECK(error_of_repeats(head + "repeat,tracker,,1,2,3,\n") ==
        "r.csv:2:16: error: the row has no place; give readings at the same place the same name");
  CHECK(error_of_repeats(head + "repeat,tracker,P1,1,2,3,4\n") ==
        "r.csv:2:1: error: a repeat needs either x, y, z of a tracker or a reading of a gauge");
  CHECK(error_of_repeats(head + "repeat,tracker,P1,1,2,,\n").starts_with("r.csv:2:23: error: "));
  CHECK(error_of_repeats(head +
                         "repeat,tracker,P1,1,2,3,\nrepeat,tracker,P2,1,2,3,\nrepeat,tracker,P2,1,2,3,\n") ==
        "r.csv:2:1: error: place \"P1\" has one reading; repeats need two or more at the same place");
  CHECK(error_of_repeats(head + "repeat,tracker,P1,,,,4\nrepeat,tracker,P1,,,,5\n") ==
        "r.csv:2:1: error: no session \"tracker\" has rows of a gauge; give repeats the session of the rows "
        "whose noise they show");
}
