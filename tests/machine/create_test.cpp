#include "counterflex/machine/create.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>
#include <variant>

#include "counterflex/machine/parameters.hpp"
#include "counterflex/machine/read_machine.hpp"

using namespace counterflex;

namespace {

MachineFacts facts_of(MachineKind kind) {
  MachineFacts facts;
  facts.kind = kind;
  if (kind == MachineKind::robot6r) facts.robot = "ur10";
  return facts;
}

Machine made(const MachineFacts& facts) {
  return read_machine(machine_file(facts), "made.toml");
}

/// Directions in M of the linear actuators of a machine of one chain, errors included.
std::vector<Vector3> axes_of(const Machine& machine) {
  std::vector<Vector3> axes;
  Matrix3 R = Matrix3::Identity();
  for (const Element& element : machine.chains.at(0).elements) {
    if (const auto* error = std::get_if<AssemblyError>(&element)) R = R * error->X.R;
    if (const auto* actuator = std::get_if<Actuator>(&element)) axes.push_back(R * actuator->joint.axis);
  }
  return axes;
}

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::string refusal(const MachineFacts& facts) {
  try {
    machine_file(facts);
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::usage);
    return error.what();
  }
  return "";
}

std::string nodes_refusal(std::string_view text) {
  try {
    read_leg_nodes(text, "nodes.csv");
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    return error.what();
  }
  return "";
}

constexpr std::string_view nodes_header =
    "base_x_mm,base_y_mm,base_z_mm,platform_x_mm,platform_y_mm,platform_z_mm\n";

}  // namespace

TEST_CASE(
    "each kind makes a file that reads back, and each number that it states has a deviation and a note") {
  for (const KindOfMachine& kind : kinds_of_machine) {
    CAPTURE(kind.name);
    const Machine machine = made(facts_of(kind.kind));
    CHECK(machine.parameters.size() >= 8);
    for (const ParameterStatement& stated : machine.parameters) {
      CAPTURE(stated.name);
      CHECK(stated.sigma.value_or(0) > 0);
      CHECK_FALSE(stated.note.empty());
    }
  }
}

TEST_CASE("each compliance and each mass of a made file is stated") {
  for (const KindOfMachine& kind : kinds_of_machine) {
    CAPTURE(kind.name);
    const Machine machine = made(facts_of(kind.kind));
    std::set<std::string> stated;
    for (const ParameterStatement& statement : machine.parameters) stated.insert(statement.name);
    for (const Parameter& parameter : parameters(machine))
      if (parameter.kind == ParameterKind::compliance || parameter.kind == ParameterKind::mass) {
        CAPTURE(parameter.name);
        CHECK(stated.count(parameter.name) == 1);
      }
  }
}

TEST_CASE("a file made without measurements is unmeasured, and a measured tip stiffness changes that") {
  for (const KindOfMachine& kind : kinds_of_machine) {
    CAPTURE(kind.name);
    CHECK(is_unmeasured(made(facts_of(kind.kind))));
  }
  MachineFacts facts = facts_of(MachineKind::mill3);
  facts.tip_stiffness = Vector3(28e6, 22e6, 45e6);
  CHECK_FALSE(is_unmeasured(made(facts)));
  CHECK(numbers_phrase(made(facts)) == "8 in [parameters]: 3 measured, 0 catalogue, 5 prior");
}

TEST_CASE("a squareness that is not given stays a prior beside one that is") {
  MachineFacts facts = facts_of(MachineKind::mill3);
  facts.squareness_um_per_m = {-18, std::nullopt, std::nullopt};
  CHECK(numbers_phrase(made(facts)) == "8 in [parameters]: 1 measured, 0 catalogue, 7 prior");
}

TEST_CASE("the angles between the axes of a mill exceed 90 degrees by the given squareness") {
  for (const MachineKind kind : {MachineKind::mill3, MachineKind::mill3_table, MachineKind::gantry}) {
    MachineFacts facts = facts_of(kind);
    facts.squareness_um_per_m = {-18, 12, -2500};
    const std::vector<Vector3> axes = axes_of(made(facts));
    REQUIRE(axes.size() == 3);
    CHECK(std::abs(angle_between(axes[0], axes[1]) - pi / 2 + 18e-6) < 1e-14);
    CHECK(std::abs(angle_between(axes[1], axes[2]) - pi / 2 - 12e-6) < 1e-14);
    CHECK(std::abs(angle_between(axes[2], axes[0]) - pi / 2 + 2500e-6) < 1e-14);
  }
}

TEST_CASE("the travel of a made machine is the given one") {
  MachineFacts facts = facts_of(MachineKind::table_ac);
  facts.travel = {{'X', {-762, 0}}, {'Z', {-508, 0}}, {'A', {-120, 30}}};
  std::vector<const Actuator*> all;
  const Machine machine = made(facts);
  for (const Element& element : machine.chains.at(0).elements)
    if (const auto* actuator = std::get_if<Actuator>(&element)) all.push_back(actuator);
  REQUIRE(all.size() == 5);
  CHECK(all[1]->min == doctest::Approx(-120 * deg));
  CHECK(all[1]->max == doctest::Approx(30 * deg));
  CHECK(all[2]->min == doctest::Approx(-0.762));
  CHECK(all[2]->max == 0);
  CHECK(all[4]->min == doctest::Approx(-0.508));
}

TEST_CASE("a hexapod of given nodes has them as the ends of its legs") {
  const std::vector<LegNodes> nodes = read_leg_nodes(std::string(nodes_header) +
                                                         "500,-100,0,200,-150,10\n500,100,0,200,150,10\n"
                                                         "-200,450,0,30,240,10\n-300,350,0,-200,130,10\n"
                                                         "-300,-350,0,-200,-130,10\n-200,-450,0,30,-240,10\n",
                                                     "nodes.csv");
  REQUIRE(nodes.size() == 6);
  CHECK(nodes[2].platform_mm == Vector3(30, 240, 10));
  MachineFacts facts = facts_of(MachineKind::hexapod);
  facts.nodes = nodes;
  facts.home_mm = Vector3(10, -20, 700);
  const Machine machine = made(facts);
  REQUIRE(machine.chains.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    Pose X;  // at home: all joints are zero
    for (const Element& element : machine.chains[i].elements)
      if (const auto* rigid = std::get_if<Rigid>(&element)) X = X * rigid->X;
    CHECK((X.p - *facts.home_mm * mm).norm() < 1e-14);
    CHECK((X.R - Matrix3::Identity()).norm() < 1e-14);
  }
}

TEST_CASE("facts that make no machine are refused with what is allowed") {
  MachineFacts robot = facts_of(MachineKind::robot6r);
  robot.robot = "ur1";
  CHECK(refusal(robot).find("--robot is 'ur1', must be one of ur10, kuka-kr270-r2700-ultra") !=
        std::string::npos);
  CHECK(refusal(robot).ends_with("; did you mean ur10?"));
  robot.robot.clear();
  CHECK(refusal(robot).starts_with("error: robot6r needs --robot NAME, one of ur10, "));
  MachineFacts delta = facts_of(MachineKind::delta);
  delta.arm_mm = 300;
  delta.radius_mm = 300;
  CHECK(refusal(delta) == "error: --radius-mm is 300, must be above 0 and below the arm, 300 mm");
  MachineFacts hexapod = facts_of(MachineKind::hexapod);
  hexapod.nodes.resize(6);
  hexapod.home_mm = Vector3(0, 0, 0);
  CHECK(refusal(hexapod) == "error: leg 1 has no length at the home of the platform");
}

TEST_CASE("a table of nodes with semicolons may have decimal commas") {
  const std::vector<LegNodes> nodes = read_leg_nodes(
      "base_x_mm;base_y_mm;base_z_mm;platform_x_mm;platform_y_mm;platform_z_mm\n"
      "1,5;2;3;4;5;6\n1;2;3;4;5;6,25\n1;2;3;4;5;6\n1;2;3;4;5;6\n1;2;3;4;5;6\n1.5;2;3;4;5;6\n",
      "nodes.csv");
  REQUIRE(nodes.size() == 6);
  CHECK(nodes[0].base_mm == Vector3(1.5, 2, 3));
  CHECK(nodes[1].platform_mm == Vector3(4, 5, 6.25));
  CHECK(nodes[5].base_mm == Vector3(1.5, 2, 3));
}

TEST_CASE("a bad table of nodes is refused at its place") {
  CHECK(nodes_refusal("").starts_with("nodes.csv:1:1: error: the table has 0 legs, must have six"));
  CHECK(nodes_refusal("base_x_mm,base_y\n")
            .starts_with("nodes.csv:1:1: error: the first line must name the columns"));
  const std::string header(nodes_header);
  CHECK(nodes_refusal(header + "1,2,3,4,5\n") == "nodes.csv:2:1: error: the line has 5 cells, must have 6");
  CHECK(nodes_refusal(header + "1,2,x,4,5,6\n") ==
        "nodes.csv:2:5: error: base_z_mm is 'x', must be a finite number in mm");
  CHECK(nodes_refusal(header + "1,2,nan,4,5,6\n").find("must be a finite number") != std::string::npos);
  std::string seven = header;
  for (int i = 0; i < 7; ++i) seven += "1,2,3,4,5,6\n";
  CHECK(nodes_refusal(seven) == "nodes.csv:8:1: error: the table has more than six legs");
}

TEST_CASE("each robot has six joints and the sources of its data") {
  CHECK(known_robots().size() >= 6);
  for (const KnownRobot& robot : known_robots()) {
    CAPTURE(robot.name);
    CHECK_FALSE(robot.lengths.empty());
    MachineFacts facts = facts_of(MachineKind::robot6r);
    facts.robot = robot.name;
    const Machine machine = made(facts);
    CHECK(actuators(machine).size() == 6);
    const std::string text = machine_file(facts);
    CHECK(text.find("name = \"A6\"") != std::string::npos);
    CHECK((total_mass(machine) > 0) == !robot.masses.empty());
  }
}
