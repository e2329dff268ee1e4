
#include <console_bridge/console.h>
#include <doctest/doctest.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/jntarray.hpp>

#include "counterflex/files/files.hpp"
#include "counterflex/import/import.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/statics/nominal.hpp"
#include "import/arm_poses.hpp"

namespace counterflex::import_urdf_test {
namespace {

/// Six joints of all kinds, a camera on the flange, a branch that another joint moves, and shapes that the
/// library would refuse.
const std::string arm = R"(<?xml version="1.0"?>
<robot name="six">
  <link name="world"/>
  <joint name="mount" type="fixed">
    <parent link="world"/> <child link="base"/>
    <origin xyz="-2.5 0.1 0.3" rpy="0.01 0 1.5"/>
  </joint>
  <link name="base"> <visual><geometry><mesh filename="nan.stl" scale="x"/></geometry></visual> </link>
  <joint name="a1" type="revolute">
    <parent link="base"/> <child link="l1"/> <origin xyz="0 0 0.4" rpy="0 1.5708 0"/> <axis xyz="0 0 1"/>
    <limit lower="-2.9" upper="2.9" effort="0" velocity="1"/>
  </joint>
  <link name="l1"> <inertial> <origin xyz="0.01 0 0.1"/> <mass value="10"/> <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>
  <joint name="a2" type="revolute">
    <parent link="l1"/> <child link="l2"/> <origin xyz="0.15 0.02 0.1" rpy="1.2 -1.5707 0.3"/> <axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="2" effort="0" velocity="1"/>
  </joint>
  <link name="l2"> <inertial> <mass value="5"/> <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/> </inertial> </link>
  <joint name="a3" type="prismatic">
    <parent link="l2"/> <child link="l3"/> <origin xyz="0 0 0.6"/> <axis xyz="0.2 0 2"/>
    <limit lower="0" upper="0.4" effort="0" velocity="1"/>
  </joint>
  <link name="l3"/>
  <joint name="a4" type="continuous">
    <parent link="l3"/> <child link="l4"/> <origin xyz="0.3 0 0.1" rpy="0 0 0.2"/> <axis xyz="1 0 0"/>
  </joint>
  <link name="l4"/>
  <joint name="a5" type="revolute">
    <parent link="l4"/> <child link="l5"/> <origin xyz="0.25 0 0"/> <axis xyz="0 -1 0"/>
    <limit lower="-2" upper="2" effort="0" velocity="1"/>
  </joint>
  <link name="l5"/>
  <joint name="a6" type="continuous">
    <parent link="l5"/> <child link="l6"/> <origin xyz="0.1 0 0"/> <axis xyz="1 0 0"/>
  </joint>
  <link name="l6"> <inertial> <origin xyz="0.02 0 0"/> <mass value="1"/> <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>
  <joint name="flange" type="fixed">
    <parent link="l6"/> <child link="tool0"/> <origin xyz="0.05 0 0" rpy="0 1.57079632679 0"/>
  </joint>
  <link name="tool0"/>
  <joint name="camera" type="fixed"> <parent link="l6"/> <child link="eye"/> <origin xyz="0 0.3 0" rpy="0 0 1"/> </joint>
  <link name="eye"> <inertial> <origin xyz="0.1 0 0"/> <mass value="3"/> <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>
  <joint name="rod" type="revolute">
    <parent link="l1"/> <child link="piston"/> <axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="0" velocity="1"/> <mimic joint="a2" multiplier="-0.25"/>
  </joint>
  <link name="piston"/>
  <joint name="loose" type="floating"> <parent link="piston"/> <child link="chip"/> </joint>
  <link name="chip"/>
</robot>
)";

KDL::Frame frame_of(const urdf::Pose& pose) {
  return {KDL::Rotation::Quaternion(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

KDL::Joint joint_of(const urdf::Joint& joint) {
  const KDL::Frame X = frame_of(joint.parent_to_joint_origin_transform);
  const KDL::Vector axis = X.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
  if (joint.type == urdf::Joint::FIXED) return KDL::Joint(joint.name, KDL::Joint::None);
  return {joint.name, X.p, axis,
          joint.type == urdf::Joint::PRISMATIC ? KDL::Joint::TransAxis : KDL::Joint::RotAxis};
}

/// The path of a URDF as a chain of KDL.
KDL::Chain kdl_chain(const std::string& text, const std::string& base, const std::string& tip) {
  console_bridge::noOutputHandler();
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  console_bridge::restorePreviousOutputHandler();
  REQUIRE(model != nullptr);
  std::vector<urdf::JointSharedPtr> path;
  for (auto link = model->getLink(tip); link->name != base; link = link->getParent())
    path.push_back(link->parent_joint);
  KDL::Chain chain;
  for (auto joint = path.rbegin(); joint != path.rend(); ++joint)
    chain.addSegment(KDL::Segment((*joint)->child_link_name, joint_of(**joint),
                                  frame_of((*joint)->parent_to_joint_origin_transform)));
  return chain;
}

Pose kdl_pose(const KDL::Chain& chain, const std::vector<double>& q) {
  KDL::JntArray joints(static_cast<unsigned>(q.size()));
  REQUIRE(chain.getNrOfJoints() == q.size());
  for (std::size_t i = 0; i < q.size(); ++i) joints(static_cast<unsigned>(i)) = q[i];
  KDL::Frame frame;
  REQUIRE(KDL::ChainFkSolverPos_recursive(chain).JntToCart(joints, frame) >= 0);
  Pose X;
  for (int r = 0; r < 3; ++r) {
    X.p[r] = frame.p(r);
    for (int c = 0; c < 3; ++c) X.R(r, c) = frame.M(r, c);
  }
  return X;
}

/// The machine that the file gives, whose poses are those of KDL and whose home is regular.
Machine check_import(const std::string& text, const std::string& base, const std::string& tip) {
  const std::string machine_text = import_urdf(text, "arm.urdf", base, tip);
  const KDL::Chain chain = kdl_chain(text, base, tip);
  check_poses(machine_text, [&](const std::vector<double>& q) { return kdl_pose(chain, q); });
  const Machine machine = read_machine(machine_text, "m.toml");
  const Model model = prepare(machine);
  CHECK(model.home_status == Status::converged);
  CHECK(model.gravity_status == Status::converged);
  CHECK(actuator_jacobian(model, model.home).condition < 1e3);
  return machine;
}

std::string message_of(const std::string& text, const std::string& base = "base",
                       const std::string& tip = "tool0") {
  return diagnostic([&] { import_urdf(text, "arm.urdf", base, tip); });
}

const PointMass* mass_named(const Machine& machine, const std::string& name) {
  for (const Element& element : machine.chains[0].elements)
    if (const auto* mass = std::get_if<PointMass>(&element); mass != nullptr && mass->name == name)
      return mass;
  return nullptr;
}

}  // namespace

TEST_CASE("an imported URDF has the poses of KDL at 1000 random joint vectors") {
  check_import(arm, "base", "tool0");
  check_import(arm, "world", "eye");
}

TEST_CASE("travel, home and names of a URDF are in the machine file") {
  const Machine machine = check_import(arm, "base", "tool0");
  const std::vector<Actuator> all = actuators(machine);
  REQUIRE(all.size() == 6);
  CHECK(all[0].min == doctest::Approx(-2.9));
  CHECK(all[2].max == doctest::Approx(0.4));
  CHECK(all[3].max == std::numeric_limits<double>::infinity());
  for (const Actuator& actuator : all)
    CHECK((actuator.home >= actuator.min && actuator.home <= actuator.max));
  CHECK(machine.name == "six");
  CHECK(controls_pose(machine));
  const std::string text = import_urdf(arm, "folder/arm.urdf", "base", "tool0");
  CHECK(text.starts_with("# counterflex import urdf: arm.urdf, from base to tool0\n"));
  CHECK(text.find("# Left out, with everything behind them, because other joints move them: piston.") !=
        text.npos);
  CHECK(text.find("travel: the source does not state it") != text.npos);
}

TEST_CASE("masses of a URDF act at the centre of all links that are fixed together; stubs are placeholders") {
  const Machine machine = check_import(arm, "base", "tool0");
  CHECK(total_mass(machine) == doctest::Approx(19));
  const PointMass* last = mass_named(machine, "l6");
  REQUIRE(last != nullptr);
  CHECK(last->kg == doctest::Approx(4));
  const Vector3 eye = Vector3(0, 0.3, 0) + from_rpy({0, 0, 1}) * Vector3(0.1, 0, 0);
  CHECK((last->at - (1 * Vector3(0.02, 0, 0) + 3 * eye) / 4).norm() < 1e-12);
  CHECK(machine.gravity.true_at_home);
  const NumberSources sources = number_sources(machine);
  CHECK(sources.catalogue == 2);
  CHECK(sources.prior == 6 * 7 + 1);
}

TEST_CASE("a URDF robot without a name is named by its file, and equal names of masses get numbers") {
  const auto everywhere = [](std::string text, std::string_view old, std::string_view by) {
    for (std::size_t at = 0; (at = text.find(old, at)) != text.npos; at += by.size())
      text.replace(at, old.size(), by);
    return text;
  };
  CHECK(read_machine(import_urdf(everywhere(arm, "\"six\"", "\"\""), "folder/arm.urdf", "base", "tool0"),
                     "m.toml")
            .name == "arm");
  const std::string alike = everywhere(everywhere(arm, "\"l1\"", "\"a b\""), "\"l2\"", "\"a.b\"");
  const Machine machine = check_import(alike, "base", "tool0");
  CHECK(mass_named(machine, "a_b") != nullptr);
  CHECK(mass_named(machine, "a_b_2") != nullptr);
}

TEST_CASE("an arm with masses whose controlled components are not known can be read") {
  std::string text = "<robot name=\"snake\"><link name=\"l0\"/>";
  for (int i = 1; i <= 7; ++i)
    text += "<joint name=\"j" + std::to_string(i) + "\" type=\"continuous\"><parent link=\"l" +
            std::to_string(i - 1) + "\"/><child link=\"l" + std::to_string(i) +
            "\"/><origin xyz=\"0.1 0 0\"/><axis xyz=\"0 0 1\"/></joint><link name=\"l" + std::to_string(i) +
            "\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
            "izz=\"1\"/></inertial></link>";
  const std::string file = import_urdf(text + "</robot>", "snake.urdf", "", "");
  const Machine machine = read_machine(file, "m.toml");
  CHECK(machine.controlled.empty());
  CHECK(total_mass(machine) == doctest::Approx(14));
  CHECK_FALSE(machine.gravity.true_at_home);
  CHECK(file.find("# when controlled has components: gravity_reference = \"home\"") != file.npos);
}

TEST_CASE("base and tip of a URDF may be left out if there is one end") {
  std::string chain = arm;
  for (const char* name : {"camera", "rod", "loose", "eye", "piston", "chip"}) {
    const std::size_t at = chain.find("name=\"" + std::string(name) + "\"");
    const std::size_t begin = chain.rfind('<', at);
    const bool is_joint = chain.compare(begin, 6, "<joint") == 0;
    const std::size_t slash = chain.find(is_joint ? "</joint>" : ">", begin);
    const bool has_inertial = !is_joint && std::string(name) == "eye";
    const std::size_t end = is_joint       ? slash + 8
                            : has_inertial ? chain.find("</link>", begin) + 7
                                           : slash + 1;
    chain.erase(begin, end - begin);
  }
  CHECK(import_urdf(chain, "arm.urdf", "", "")
            .starts_with("# counterflex import urdf: arm.urdf, from world to tool0\n"));
  CHECK(
      message_of(arm, "", "") ==
      "arm.urdf:2:1: error: the robot has several ends below world: chip, eye, tool0; choose one with --tip");
}

TEST_CASE("bad URDF files are refused at their place, and the library prints nothing") {
  CHECK(
      message_of(
          "<robot name=\"r\">\n<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/><link name=\"d\"/>\n"
          "<joint name=\"1\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n"
          "<joint name=\"2\" type=\"fixed\"><parent link=\"c\"/><child link=\"d\"/></joint>\n"
          "<joint name=\"3\" type=\"fixed\"><parent link=\"d\"/><child link=\"c\"/></joint>\n</robot>",
          "", "d") ==
      "arm.urdf:4:1: error: the links above the joint 2 form a loop; the joints of a robot must form a tree");
  CHECK(
      message_of("<robot name=\"r\">\n<link name=\"a\"/><link name=\"b\"/>\n"
                 "<joint name=\"1\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n"
                 "<joint name=\"2\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>",
                 "", "b") ==
      "arm.urdf:4:1: error: the link b is the child of two joints; the joints of a robot must form a tree");
  CHECK(message_of("<robot name=\"r\">\n  <link name=\"a\"\n</robot>")
            .starts_with("arm.urdf:3:1: error: not XML: "));
  CHECK(message_of("") == "arm.urdf:1:1: error: not XML: Error document empty.");
  CHECK(message_of("<model/>") ==
        "arm.urdf:1:1: error: the outer element is <model>; that of a URDF is <robot>");
  CHECK(message_of("<robot name=\"r\">\n <xacro:arm n=\"1\"/>\n</robot>") ==
        "arm.urdf:2:2: error: <xacro:arm> is a macro of xacro; expand the file first: xacro FILE.xacro > "
        "FILE.urdf");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  CHECK(message_of(deep) == "arm.urdf:1:1: error: elements are nested more than 200 deep");
  CHECK(message_of(arm, "base", "tool") ==
        "arm.urdf:2:1: error: --tip is 'tool', which is not a link of the robot; did you mean tool0?; links: "
        "base, chip, eye, "
        "l1, l2, l3, l4, l5, l6, piston, tool0, world");
  CHECK(message_of(arm, "bse") ==
        "arm.urdf:2:1: error: --base is 'bse', which is not a link of the robot; did you mean base?; links: "
        "base, chip, eye, "
        "l1, l2, l3, l4, l5, l6, piston, tool0, world");
  CHECK(message_of(arm, "eye", "tool0") ==
        "arm.urdf:40:3: error: no path leads from the base eye to the tip tool0; the links "
        "above the tip are l6, l5, l4, l3, l2, l1, base, world");
  CHECK(message_of(arm, "base", "world") ==
        "arm.urdf:3:3: error: the tip world is the root of the robot; no joint leads to it");
  CHECK(message_of(arm, "l6", "tool0") ==
        "arm.urdf:2:1: error: the path from l6 to tool0 has no joint that moves");
  CHECK(message_of(arm, "base", "piston") ==
        "arm.urdf:43:3: error: the joint rod follows a2 (mimic); an imported machine has one actuator per "
        "joint. Choose --base "
        "and --tip so that the path does not contain it");
  CHECK(message_of(arm, "piston", "chip") ==
        "arm.urdf:48:3: error: the joint loose is floating; joints of the path must be "
        "revolute, continuous, prismatic or fixed");
  CHECK(message_of(replaced(arm, "0 0 0.6\"", "0 nan 0.6\"")) ==
        "arm.urdf:20:44: error: xyz of <origin> is \"0 nan 0.6\"; it must be 3 finite numbers");
  CHECK(message_of(replaced(arm, "<mass value=\"10\"", "<mass value=\"-10\"")) ==
        "arm.urdf:13:58: error: the mass is -10 kg; it must not be negative");
  CHECK(message_of(replaced(arm, "<axis xyz=\"1 0 0\"/>", "<axis xyz=\"0 0 0\"/>")) ==
        "arm.urdf:24:3: error: the axis of the joint a4 is a zero vector; it must have a direction");
  CHECK(message_of(replaced(arm, "lower=\"-1.5\" upper=\"2\"", "lower=\"2\" upper=\"-1.5\"")) ==
        "arm.urdf:14:3: error: the upper limit of the joint a2, -1.5, is not above the lower, 2");
  CHECK(message_of(replaced(arm, "<link name=\"l3\"/>", "<link name=\"l2\"/>")) ==
        "arm.urdf:23:3: error: the name of link \"l2\" is that of line 18, too");
  CHECK(message_of(replaced(arm, "<link name=\"l3\"/>", "<link/>")) ==
        "arm.urdf:23:3: error: a <link> has no name");
  CHECK(message_of(replaced(arm, "<link name=\"l3\"/>", ""))
            .starts_with("arm.urdf:19:3: error: the URDF library refuses the file: "));
  CHECK(message_of(replaced(arm, "<limit lower=\"-2.9\" upper=\"2.9\" effort=\"0\" velocity=\"1\"/>", ""))
            .starts_with("arm.urdf:9:3: error: the URDF library refuses the file: "));
  CHECK(message_of(replaced(arm, "upper=\"2\" effort=\"0\"", "upper=\"2\"")) ==
        "arm.urdf:14:3: error: the URDF library refuses the file: joint limit: no effort");
}

TEST_CASE("real robots of a folder have the poses of KDL") {
  const char* folder = std::getenv("COUNTERFLEX_URDF");
  if (folder == nullptr) {
    MESSAGE("skipped: COUNTERFLEX_URDF names no folder");
    return;
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".urdf") continue;
    CAPTURE(entry.path().string());
    const std::string text = read_file(entry.path().string());
    check_import(text, "base_link", "tool0");
    ++files;
  }
  CHECK(files > 0);
}

}  // namespace counterflex::import_urdf_test
