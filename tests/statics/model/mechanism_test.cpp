/// Machines made ready for computing: columns, numbers of actuators, and the state that belongs to them.
#include "counterflex/statics/mechanism.hpp"

#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

const char* const every_kind = R"(controlled = ["z", "x", "rz"]
[springs.s]
stiffness_diag_si = [1, 2, 3, 4, 5, 6]
preload_si = [1, 0, 0, 0, 0, 0]
[branches.driven]
elements = [{ actuator = "revolute", axis = "z", home_deg = 5 }, { spring = "s" }]
[branches.free]
elements = [{ passive = "revolute", axis = "z" }]
[[chain]]
name = "first"
errors.e = { rpy_deg = [0, 0, 1] }
elements = [
  { rigid = { xyz_mm = [1, 2, 3] } },
  { actuator = "prismatic", axis = "x", min_mm = -10, max_mm = 20 },
  { error = "e" },
  { parallel = ["driven", "free"] },
  { compliance = "prismatic", axis = "y", stiffness_N_per_m = 9 },
  { actuator = "prismatic", axis = "y" },
])";

}  // namespace

TEST_CASE("columns run from start to end: one a joint, six a spring or a group, none for what is fixed") {
  const Mechanism mechanism = model_of_text(every_kind).mechanism;
  const Series& series = mechanism.chains.at(0);
  CHECK(series.name == "first");
  CHECK(series.columns == 1 + 6 + 1 + 1);
  CHECK(series.free == std::vector<int>{1, 2, 3, 4, 5, 6, 7});
  CHECK(series.commanded == std::vector<int>{0, 8});
  CHECK(series.angular == std::vector<bool>{false, false, false, false, true, true, true, false, false});
  REQUIRE(series.parts.size() == 6);
  CHECK(series.parts[0].column == -1);
  CHECK(series.parts[2].kind == PartKind::error);
  CHECK((series.parts[2].log_R - Vector3(0, 0, 1 * deg)).norm() < 1e-15);
  CHECK(series.parts[3].group == 0);
  const Series& driven = series.groups.at(0).branches.at(0);
  CHECK(driven.columns == 7);
  CHECK(driven.parts[1].theta_0 == unit(0));
}

TEST_CASE("mechanism: what it controls, and whether its actuators go straight where the tip does") {
  const Mechanism mechanism = model_of_text(every_kind).mechanism;
  for (const Component c : {Component::x, Component::z, Component::rz}) CHECK(controls(mechanism, c));
  for (const Component c : {Component::y, Component::rx, Component::ry}) CHECK_FALSE(controls(mechanism, c));
  const auto slides_with = [](const std::string& element) {
    return only_slides(model_of_text("controlled = []\n[[chain]]\nname = \"c\"\nelements = [" + element +
                                     "{ actuator = \"prismatic\", axis = \"x\" }]\n")
                           .mechanism);
  };
  CHECK(slides_with(""));
  CHECK(slides_with("{ compliance = \"revolute\", axis = \"z\", stiffness_Nm_per_rad = 9 }, "));
  CHECK_FALSE(slides_with("{ actuator = \"revolute\", axis = \"z\" }, "));
  CHECK_FALSE(slides_with("{ passive = \"prismatic\", axis = \"y\", stiffness_N_per_m = 9 }, "));
  CHECK_FALSE(only_slides(mechanism));  // for its group
  CHECK_FALSE(only_slides(model_of("orthoglide_perfect").mechanism));
}

TEST_CASE("actuators are numbered in the order of elements, a group's at the place of the group") {
  const Model model = model_of_text(every_kind);
  const Series& series = model.mechanism.chains.at(0);
  CHECK(series.actuators == std::vector<int>{0, 1, 2});
  CHECK(series.groups[0].branches[0].actuators == std::vector<int>{1});
  CHECK(series.groups[0].branches[1].actuators.empty());
  REQUIRE(model.mechanism.travel.size() == 3);
  CHECK(model.mechanism.travel[0].max == doctest::Approx(0.02));
  CHECK(model.mechanism.travel[1].kind == JointKind::revolute);
  CHECK(std::isinf(model.mechanism.travel[2].max));
  CHECK(model.mechanism.controlled == std::vector{Component::x, Component::z, Component::rz});
}

TEST_CASE("actuator values are read and written by their numbers, inside groups too") {
  const Model model = model_of_text(every_kind);
  Configuration configuration = zero_configuration(model.mechanism);
  CHECK(actuator_values(model.mechanism, configuration).isZero(0));
  const Eigen::Vector3d rho(0.1, 0.2, 0.3);
  set_actuator_values(model.mechanism, rho, configuration);
  CHECK(actuator_values(model.mechanism, configuration) == rho);
  CHECK(configuration.chains[0].x[0] == 0.1);
  CHECK(configuration.chains[0].groups[0].branches[0].x[0] == 0.2);
  CHECK(configuration.chains[0].x[8] == 0.3);
}

TEST_CASE("a configuration of zeros has room for every coordinate of chains and branches") {
  const Mechanism mechanism = model_of_text(every_kind).mechanism;
  const Configuration configuration = zero_configuration(mechanism);
  REQUIRE(configuration.chains.size() == 1);
  CHECK(configuration.chains[0].x.size() == 9);
  CHECK(configuration.chains[0].x_nominal.size() == 9);
  REQUIRE(configuration.chains[0].groups.size() == 1);
  REQUIRE(configuration.chains[0].groups[0].branches.size() == 2);
  CHECK(configuration.chains[0].groups[0].branches[0].x.size() == 7);
  CHECK(configuration.chains[0].F.isZero(0));
}

TEST_CASE("mechanism: preloads are found in chains and in the branches of groups") {
  CHECK(!has_preload(model_of("orthoglide_case_b").mechanism));
  CHECK(has_preload(model_of("hexapod_joint_springs").mechanism));  // springs of its joints
  const std::string head =
      "[[chain]]\nname = \"c\"\nelements = [{ actuator = \"prismatic\", axis = \"x\" }, ";
  const std::string spring = "[springs.s]\nstiffness_diag_si = [1e6, 1e6, 1e6, 1e4, 1e4, 1e4]\n";
  CHECK(!has_preload(model_of_text(spring + head + "{ spring = \"s\" }]\n").mechanism));
  const std::string preloaded = spring + "preload_si = [1e-6, 0, 0, 0, 0, 0]\n";
  CHECK(has_preload(model_of_text(preloaded + head + "{ spring = \"s\" }]\n").mechanism));
  const std::string branch = "[branches.b]\nelements = [{ spring = \"s\" }]\n",
                    in_group = head + "{ parallel = [\"b\"] }]\n";
  CHECK(has_preload(model_of_text(preloaded + branch + in_group).mechanism));
  CHECK(!has_preload(model_of_text(spring + branch + in_group).mechanism));
}
