#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/machine/read_machine.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

bool has_note(const Machine& machine, const std::string& part) {
  const auto notes = structural_notes(machine);
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

const std::string body = R"(
name = "press"
controlled = ["z"]
[springs.head]
stiffness_diag_si = [1e6, 1e6, 0, 10, 10, 10]
preload_si = [0, 0, 1e-3, 0, 0, 0]
[branches.rod]
elements = [{ passive = "revolute", axis = [0, 3, 4], stiffness_Nm_per_rad = 50, preload = "home", min_deg = -5 }]
)";

const std::string elements =
    "{ rigid = { xyz_mm = [0, -0.0, 12.5], rpy_deg = [0, 0, 90] } }, { error = \"mount\" }, "
    "{ actuator = \"prismatic\", axis = \"z\", max_mm = 100, home_mm = 120 }, { spring = \"head\" }, "
    "{ compliance = \"prismatic\", axis = \"x\", stiffness_N_per_m = 2e7 }, { parallel = [\"rod\"] }";

Machine press() {
  return read_machine(header + body + chain_text(elements, "errors.mount = { xyz_mm = [25, 0, 0] }\n", "ram"),
                      "press.toml");
}

}  // namespace

TEST_CASE("the description of a machine shows all of its parts") {
  CHECK(describe(press()) ==
        R"(machine      press
controlled   z
home         at the platform pose of the joints' home values
tool         tip at the reference point
program      dialect auto, units not stated, a tool change moves all axes (linuxcnc, grbl: no axis)
correction   at most 1 mm
work         no offsets: programs are in the machine frame

chain ram    1 actuator, 1 passive joint, 7 elastic coordinates
   1  rigid        xyz 0 0 12.5 mm, rpy 0 0 90 deg
   2  error        mount: xyz 25 0 0 mm
   3  actuator 1   prismatic along z, below 100 mm, starts at 120 mm
   4  spring       head
   5  compliance   prismatic along x, 2e+07 N/m
   6  parallel     1 branch
        branch rod
         1  passive      revolute about (0 0.6 0.8), above -5 deg, spring of 50 N m/rad at rest at the home configuration

springs      diagonal of the stiffness, N/m and N m/rad
  head       x 1e+06       y 1e+06       z 0           rx 10          ry 10          rz 10
             preloaded: at rest at xyz 0 0 1 mm, rotation vector 0 0 0 deg

actuators    axis in the frame of its chain there, travel
   1  ram     prismatic along z        below 100 mm

errors of assembly
  ram        mount      xyz 25 0 0 mm
)");
}

TEST_CASE("work offsets are described with their datum") {
  const std::string text =
      describe(machine_with("[work.G54]\nxyz_mm = [100, 0, 0]\n[work.G55]\ndatum = { touched_at_mm = [1, 2, "
                            "3] }\n[work.G56]\ndatum = \"machine\"\n[program]\ntool_change_moves = []\n"));
  CHECK(text.find("work G54     xyz 100 0 0 mm; datum not stated\n") != std::string::npos);
  CHECK(text.find("work G56     the machine frame; datum \"machine\"\n") != std::string::npos);
  CHECK(describe(machine_with("work = \"machine\"\n"))
            .find("work         program coordinates are machine coordinates\n") != std::string::npos);
  CHECK(text.find("work G55     the machine frame; touched off with this machine at 1 2 3 mm\n") !=
        std::string::npos);
  CHECK(text.find("a tool change moves no axis") != std::string::npos);
}

TEST_CASE("notes name what is unusual in a machine") {
  const Machine machine = press();
  CHECK(has_note(machine, "spring \"head\" is only semidefinite: 1 of its 6 directions is"));
  CHECK(has_note(machine, "spring \"head\" is preloaded"));
  CHECK(has_note(machine, "actuator 1 (chain ram, prismatic along z) has one limit only"));
  CHECK(has_note(machine, "starts at 120 mm, outside its travel below 100 mm"));
  CHECK(has_note(machine, "1 passive joint with limits"));
  CHECK(has_note(machine, "parallel element with one branch, \"rod\""));
  CHECK(has_note(machine, "errors.mount of chain ram is large"));
}

TEST_CASE("notes distinguish rigid from elastic machines, and perfect from imperfect ones") {
  CHECK(has_note(machine_with(""), "there is nothing to compensate"));
  CHECK(has_note(machine_with(""), "controlled is empty"));
  const std::string sprung =
      x_axis + ", { compliance = \"prismatic\", axis = \"x\", stiffness_N_per_m = 1e7 }";
  CHECK(has_note(machine_of(sprung), "no errors of assembly are given"));
  CHECK(has_note(machine_of(sprung),
                 "chain arm has 1 elastic coordinate and no passive joints: its end cannot deflect"));
  const std::string two = "home = {}\n" + chain_text(x_axis, "", "stiff");
  CHECK(has_note(machine_of(sprung, two), "chain stiff has no elastic elements"));
  const Machine crooked =
      read_machine(header + chain_text(x_axis + ", { error = \"e\" }", "errors.e = { xyz_mm = [1, 0, 0] }\n"),
                   "machine.toml");
  CHECK(has_note(crooked, "the machine does not deflect under forces"));
}

TEST_CASE("a passive joint whose spring rests elsewhere than at home is noted") {
  const std::string joint = "{ passive = \"revolute\", axis = \"y\", stiffness_Nm_per_rad = 5, ";
  CHECK(has_note(machine_of(joint + "preload_deg = 3 }"), "1 passive joint with a spring whose rest"));
  CHECK_FALSE(has_note(machine_of(joint + "preload_deg = 3, home_deg = 3 }"), "whose rest"));
  CHECK_FALSE(has_note(machine_of(joint + "preload = \"home\" }"), "whose rest"));
}

TEST_CASE("the only note for an ordinary machine is about its missing errors") {
  const Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/tests/machine/data/orthoglide.toml");
  CHECK(structural_notes(machine) ==
        std::vector<std::string>{"no errors of assembly are given: the geometry is assumed perfect"});
}

TEST_CASE("limits of loads are described once where chains have the same, else by chain") {
  const auto two_arms = [](const std::string& of_left) {
    return describe(read_machine(header +
                                     "home.xyz_mm = [0, 0, 0]\nlimits.spring_translation_max_mm = 0.25\n" +
                                     chain_text(x_axis, of_left, "left") + chain_text(x_axis, "", "right"),
                                 "machine.toml"));
  };
  CHECK(two_arms("").find("\nloads        at most spring deflection 0.25 mm\n") != std::string::npos);
  const std::string differing = two_arms("limits.moment_max_Nm = 12.5\n");
  CHECK(differing.find("\nloads left   at most moment at the end 12.5 N m, spring deflection 0.25 mm\n"
                       "loads right  at most spring deflection 0.25 mm\n") != std::string::npos);
}

TEST_CASE("a limit of a load that no chain has is noted, as another one was probably meant") {
  const auto noted = [](const std::string& element, const std::string& key) {
    return has_note(machine_of(element, "limits." + key + " = 1\n"),
                    key + " limits a load that no chain has: it has no effect");
  };
  const std::string slides = "{ compliance = \"prismatic\", axis = \"x\", stiffness_N_per_m = 1e6 }",
                    turns = "{ compliance = \"revolute\", axis = \"x\", stiffness_Nm_per_rad = 1e6 }";
  CHECK_FALSE(noted(x_axis, "moment_max_Nm"));
  CHECK(noted(x_axis, "group_moment_max_Nm"));
  CHECK(noted(x_axis, "spring_force_max_N"));
  CHECK_FALSE(noted(slides, "spring_force_max_N"));
  CHECK_FALSE(noted(slides, "spring_translation_max_mm"));
  CHECK(noted(turns, "spring_translation_max_mm"));
  CHECK_FALSE(noted(turns, "spring_torque_max_Nm"));
  CHECK(noted(slides, "spring_rotation_max_deg"));
  CHECK(noted("{ passive = \"prismatic\", axis = \"x\" }", "passive_change_max_deg"));
  CHECK_FALSE(noted("{ passive = \"revolute\", axis = \"x\" }", "passive_change_max_deg"));
}
