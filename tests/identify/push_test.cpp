/// Pushes whose force and gauge are not at the tip, and friction that makes readings differ.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "counterflex/files/input_error.hpp"
#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

constexpr double friction = 30 * um;
const Vector3 gauge(0.02, -0.03, 0.15), force_arm(-0.04, 0.01, 0.1);  // from the tip, in its frame

Machine robot() {
  MachineFacts facts;
  facts.kind = MachineKind::robot6r;
  facts.robot = "kuka-kr270-r2700-ultra";
  return read_machine(machine_file(facts), "robot.toml");
}

Machine softer(const Machine& nominal) {
  std::vector<double> values = values_of(nominal);
  const std::vector<Parameter> all = parameters(nominal);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].kind == ParameterKind::compliance) values[i] *= 1.3;
  return with_parameters(nominal, values);
}

/// Pushes on `truth`, in turns while the force grows and falls.
std::string pushes_on(const Machine& truth, const Machine& nominal) {
  Random random(4);
  Tips tips(truth), stiff(nominal);
  std::string text =
      "kind,A1_deg,A2_deg,A3_deg,A4_deg,A5_deg,A6_deg,fx_N,fy_N,fz_N,force_x_mm,force_y_mm,force_z_mm,gx,gy,"
      "gz,gauge_x_mm,gauge_y_mm,gauge_z_mm,reading_um,sigma_um,phase\n";
  for (int i = 0; i < 24; ++i) {
    CommandedState state = random_state(truth, 0, 0.4, random), loaded = state;
    const Vector3 direction = Vector3::Unit(i % 3), F = 600 * direction;
    loaded.F << F, (stiff(state).R * force_arm).cross(F);
    const double moved =
        direction.dot(tips(loaded) * gauge - tips(state) * gauge) + (i % 2 == 0 ? -friction : friction);
    text += "static_push";
    for (const double q : state.shown) text += fmt::format(",{:.12g}", q / deg);
    for (const double f : F) text += fmt::format(",{}", f);
    for (const double x : force_arm) text += fmt::format(",{}", x / mm);
    for (const double g : direction) text += fmt::format(",{}", g);
    for (const double x : gauge) text += fmt::format(",{}", x / mm);
    text += fmt::format(",{:.9g},0.1,{}\n", moved / um, i % 2 == 0 ? "loading" : "unloading");
  }
  return text;
}

Identification identified(const std::string& text, const Machine& nominal) {
  Measurements all;
  read_measurements(text, "pushes.csv", nominal, all);
  IdentifyOptions options;
  options.ladder = false;
  options.sets = {ParameterSet::compliance};
  return identify(nominal, all, options);
}

std::string error_of(const std::string& text, const Machine& machine) {
  try {
    identified(text, machine);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace

TEST_CASE("pushes off the tip with friction give back the compliances") {
  const Machine nominal = robot();
  const std::string text = pushes_on(softer(nominal), nominal);
  const Identification found = identified(text, nominal);
  CHECK(found.lack_of_fit.value() < 0.1 * um);
  int identified_count = 0;
  for (const IdentifiedParameter& parameter : found.parameters)
    if (parameter.is_identified) {
      CAPTURE(parameter.name);
      ++identified_count;
      CHECK(parameter.value / parameter.before == doctest::Approx(1.3).epsilon(0.01));
    }
  CHECK(identified_count >= 5);

  // Each of the three is needed.
  CHECK(identified(replaced(text, "gauge_z_mm", "torque_Nm"), nominal).lack_of_fit.value() > um);
  CHECK(identified(replaced(text, "force_z_mm", "torque_Nm"), nominal).lack_of_fit.value() > um);
  CHECK(identified(replaced(replaced(text, "unloading", ""), "loading", ""), nominal).lack_of_fit.value() >
        10 * um);
}

TEST_CASE("a phase is loading or unloading, and a session has both or none") {
  const Machine nominal = robot();
  const std::string text = pushes_on(nominal, nominal);
  CHECK(error_of(replaced(text, ",unloading", ",up"), nominal)
            .find(": error: phase is \"up\"; it must be loading or unloading") != std::string::npos);
  CHECK(error_of(replaced(text, ",unloading", ",loading"), nominal) ==
        "pushes.csv:2:1: error: session \"pushes\" has rows of phase loading alone; friction shows in the "
        "difference: add rows of phase unloading, or leave the column out");
}
