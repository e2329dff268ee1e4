#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/sanity/checks.hpp"

using namespace counterflex;

namespace {

/// A mill whose head is a spring of `N_per_m`; `head` is the text before the chain.
Machine mill(const std::string& head = "", double N_per_m = 2e7, const std::string& elements = "") {
  return read_machine(
      fmt::format(
          "format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\", \"z\"]\n{}\n[springs.head]\n"
          "stiffness_diag_si = [{}, {}, {}, 1e7, 1e7, 1e7]\n[[chain]]\nname = \"axes\"\nelements = [\n"
          "{{ actuator = \"prismatic\", axis = \"x\", min_mm = 0, max_mm = 400 }},\n"
          "{{ actuator = \"prismatic\", axis = \"y\", min_mm = 0, max_mm = 250 }},\n"
          "{{ actuator = \"prismatic\", axis = \"z\", min_mm = -300, max_mm = 0 }},\n{}\n"
          "{{ spring = \"head\" }}]\n",
          head, N_per_m, 2 * N_per_m, 4 * N_per_m, elements),
      "mill.toml");
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

SanityCheck axis_of(const Machine& machine, const std::vector<WorkFrame>& frames = {}) {
  const Model model = prepare(machine);
  return check_tool_axis({&model}, frames, turns_joints(machine), machine.allows_inverted_tool);
}

/// The doubts about sizes that name `part`.
long doubts(const Machine& machine, const std::string& part) {
  const SanityChecks checks = check_magnitudes(machine);
  return std::count_if(checks.begin(), checks.end(), [&](const SanityCheck& check) {
    return check.state == SanityState::doubtful && contains(check.text, part);
  });
}

bool is_usual(const Machine& machine) {
  const SanityChecks checks = check_magnitudes(machine);
  return checks.size() == 1 && checks[0].state == SanityState::ok;
}

}  // namespace

TEST_CASE("an error of assembly that is larger than any machine's is doubted") {
  const auto with_error = [](const std::string& error) {
    return read_machine(
        "format = \"counterflex-machine 1\"\ncontrolled = [\"x\"]\n[[chain]]\nname = \"c\"\nelements = [\n"
        "{ actuator = \"prismatic\", axis = \"x\", min_mm = 0, max_mm = 500 },\n{ error = \"e\" "
        "},\n]\nerrors.e = { " +
            error + " }\n",
        "machine.toml");
  };
  CHECK(is_usual(with_error("rpy_deg = [0, 0, 1]")));
  CHECK(doubts(with_error("rpy_deg = [0, 0, 40]"), "errors.e of chain c turns by 40 deg") == 1);
  CHECK(is_usual(with_error("xyz_mm = [5, 0, 0]")));
  CHECK(doubts(with_error("xyz_mm = [300, 0, 0]"), "errors.e of chain c is 300 mm long") == 1);
}

TEST_CASE("a tool that points into the work is wrong unless the machine file allows it") {
  CHECK(axis_of(mill()).state == SanityState::ok);
  CHECK(contains(axis_of(mill()).text, "machine z to the tool's z is 0.0 deg"));
  const SanityCheck inverted = axis_of(mill("[tool]\nxyz_mm = [0, 0, -80]\nrpy_deg = [180, 0, 0]"));
  CHECK(inverted.state == SanityState::wrong);
  CHECK(contains(inverted.text, "180.0 deg"));
  CHECK(axis_of(mill("[tool]\nrpy_deg = [180, 0, 0]\nallow_inverted = true")).state == SanityState::ok);
}

TEST_CASE("the tool is compared with the z of each work offset") {
  const WorkFrame upright{"G54", Pose{}}, upside_down{"G55", Pose{from_rpy({pi, 0, 0}), Vector3::Zero()}};
  CHECK(axis_of(mill(), {upright}).state == SanityState::ok);
  const SanityCheck check = axis_of(mill(), {upright, upside_down});
  CHECK(check.state == SanityState::wrong);
  CHECK(contains(check.text, "G55 z"));
}

TEST_CASE("a horizontal tool is doubtful on linear axes, not on machines with rotary axes") {
  const std::string lying = "[tool]\nrpy_deg = [60, 0, 0]";
  CHECK(axis_of(mill(lying)).state == SanityState::doubtful);
  const Model model = prepare(mill(lying));
  CHECK(check_tool_axis({&model}, {}, true, false).state == SanityState::ok);
  CHECK(axis_of(mill("[tool]\nrpy_deg = [90, 0, 0]")).state == SanityState::doubtful);
}

TEST_CASE("the stiffness at the tip is that of the spring without a lever, and less below it") {
  const auto direct = tip_stiffness(prepare(mill()), {});
  REQUIRE(direct);
  CHECK((*direct - Vector3(2e7, 4e7, 8e7)).norm() < 1);
  const auto below = tip_stiffness(prepare(mill("[tool]\nxyz_mm = [0, 0, -100]")), Vector3(0.2, 0.1, -0.2));
  REQUIRE(below);
  CHECK((*below)[0] == doctest::Approx(1 / (1 / 2e7 + 0.1 * 0.1 / 1e7)));
  CHECK((*below)[2] == doctest::Approx(8e7));
}

TEST_CASE("a tip that is a thousand times too soft or too stiff is doubtful, a rigid one is not") {
  const auto check = [](double N_per_m) {
    return check_tip_stiffness(tip_stiffness(prepare(mill("", N_per_m)), {}), "at home");
  };
  CHECK(check(2e7).state == SanityState::ok);
  CHECK(contains(check(2e7).text, "20, 40, 80 N/um along x, y, z at home"));
  CHECK(check(2e4).state == SanityState::doubtful);
  CHECK(contains(check(2e4).text, "N/mm"));
  CHECK(check(2e10).state == SanityState::doubtful);
  const Machine rigid = read_machine(
      "format = \"counterflex-machine 1\"\ncontrolled = [\"x\"]\n[[chain]]\nname = \"x\"\nelements = [{ "
      "actuator "
      "= \"prismatic\", axis = \"x\" }]\n",
      "rigid.toml");
  const SanityCheck stiff = check_tip_stiffness(tip_stiffness(prepare(rigid), {}), "at home");
  CHECK(stiff.state == SanityState::ok);
  CHECK(contains(stiff.text, "rigid"));
  CHECK(check_tip_stiffness(std::nullopt, "at home").state == SanityState::unknown);
}

TEST_CASE("a length without [spindle] is doubtful, and one that is missing with it") {
  const SanityCheck unused = check_tool_lengths({{1, 300}}, {1}, false);
  CHECK(unused.state == SanityState::doubtful);
  CHECK(contains(unused.text, "T1 = 300 mm is known, but without [spindle]"));
  CHECK(check_tool_lengths({{1, 300}}, {1}, true).state == SanityState::ok);
  CHECK(check_tool_lengths({{2, 300}}, {1}, false).state == SanityState::ok);
  CHECK(check_tool_lengths({}, {1}, false).state == SanityState::ok);
  const SanityCheck missing = check_tool_lengths({{1, 300}}, {0, 1, 2}, true);
  CHECK(missing.state == SanityState::doubtful);
  CHECK(contains(missing.text, "--tool-length T2=MM"));
}

TEST_CASE("a selected offset without a pose is doubtful") {
  CHECK(check_work_offset({"G54"}, true).state == SanityState::ok);
  CHECK(check_work_offset({""}, false).state == SanityState::ok);
  const SanityCheck unknown = check_work_offset({"", "G55"}, false);
  CHECK(unknown.state == SanityState::doubtful);
  CHECK(contains(unknown.text, "--work 'G55=X,Y,Z'"));
  CHECK(contains(unknown.text, "--work machine"));
  CHECK(contains(check_work_offset({"G54", "G54", "G55", "G54"}, false).text, "selects G54, G55, but"));
}

TEST_CASE("sizes that hardly any machine has are doubtful, each by its own name") {
  CHECK(is_usual(mill("[tool]\nxyz_mm = [0, 0, -80]\nrpy_deg = [0, 0, 90]")));
  CHECK(doubts(mill("", 2e4), "spring \"head\" of chain axes has at most 80000 N/m") == 1);
  CHECK(doubts(mill("[tool]\nrpy_deg = [0, 0, 1.5708]"), "[tool] turns by 1.5708 deg") == 1);
  CHECK(doubts(mill("[work.G55]\nrpy_deg = [0, 0, -3.14]"), "[work.G55] turns by -3.14 deg") == 1);
  CHECK(doubts(mill("", 2e7, "{ rigid = { xyz_mm = [0, 0, 1] }, mass = { kg = 35000 } },"), "35000 kg") == 1);
  CHECK(doubts(mill("[spindle]\nxyz_mm = [0, 0, -80]\n[tools.T1]\nlength_mm = 4.7"),
               "tool T1 is 4.7 mm long") == 1);
  CHECK(doubts(mill("[tools.T1]\nlength_mm = 0.12"), "tool T1 is 0.12 mm long") == 1);
}

TEST_CASE("travels in m and in rad are doubtful") {
  const auto machine = [](const char* actuator) {
    return read_machine(
        std::string("format = \"counterflex-machine 1\"\n[[chain]]\nname = \"a\"\nelements = [") + actuator +
            ", { rigid = { xyz_mm = [0, 0, 300] } }]\n",
        "a.toml");
  };
  CHECK(doubts(machine("{ actuator = \"revolute\", axis = \"z\", min_deg = -3.14, max_deg = 3.14 }"),
               "from -3.14 to 3.14 deg") == 1);
  CHECK(doubts(machine("{ actuator = \"prismatic\", axis = \"z\", min_mm = 0, max_mm = 0.4 }"),
               "a travel of 0.4 mm") == 1);
  CHECK(is_usual(machine("{ actuator = \"revolute\", axis = \"z\", min_deg = -180, max_deg = 180 }")));
}
