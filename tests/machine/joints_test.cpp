#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

TEST_CASE("an axis is a letter or a vector, normalised, also if it is tiny or huge") {
  CHECK(read_part<Actuator>("{ actuator = \"revolute\", axis = \"y\" }").joint.axis == Vector3::UnitY());
  const Vector3 expected(0, 0.6, -0.8);
  for (const char* axis : {"[0, 3, -4]", "[0, 3e-200, -4e-200]", "[0, 3e200, -4e200]"}) {
    CAPTURE(std::string(axis));
    const auto joint =
        read_part<Actuator>(std::string("{ actuator = \"revolute\", axis = ") + axis + " }").joint;
    CHECK((joint.axis - expected).norm() < 1e-15);
  }
}

TEST_CASE("an actuator without limits is free, and starts at 0") {
  const auto a = read_part<Actuator>("{ actuator = \"revolute\", axis = \"x\" }");
  CHECK(a.joint.kind == JointKind::revolute);
  CHECK(a.min == -INFINITY);
  CHECK(a.max == INFINITY);
  CHECK(a.home == 0);
}

TEST_CASE("prismatic values are in mm and revolute ones in degrees") {
  const auto p =
      read_part<Actuator>("{ actuator = \"prismatic\", axis = \"x\", min_mm = -5, max_mm = 7, home_mm = 2 }");
  CHECK(p.min == doctest::Approx(-5e-3));
  CHECK(p.max == doctest::Approx(7e-3));
  CHECK(p.home == doctest::Approx(2e-3));
  const auto r = read_part<Actuator>(
      "{ actuator = \"revolute\", axis = \"x\", min_deg = -90, max_deg = 180, home_deg = 30 }");
  CHECK(r.min == doctest::Approx(-pi / 2));
  CHECK(r.max == doctest::Approx(pi));
  CHECK(r.home == doctest::Approx(pi / 6));
}

TEST_CASE("a passive joint may have a spring with a rest value or one that is relaxed at home") {
  const auto free = read_part<Passive>("{ passive = \"prismatic\", axis = \"z\", home_mm = 3 }");
  CHECK(free.stiffness == 0);
  CHECK(free.home == doctest::Approx(3e-3));
  const auto p = read_part<Passive>(
      "{ passive = \"prismatic\", axis = \"z\", stiffness_N_per_m = 2e5, preload_mm = -4 }");
  CHECK(p.stiffness == 2e5);
  CHECK(p.rest == doctest::Approx(-4e-3));
  CHECK_FALSE(p.rest_at_home);
  const auto r = read_part<Passive>(
      "{ passive = \"revolute\", axis = \"z\", stiffness_Nm_per_rad = 250, preload = \"home\" }");
  CHECK(r.stiffness == 250);
  CHECK(r.rest_at_home);
  const auto d = read_part<Passive>(
      "{ passive = \"revolute\", axis = \"z\", stiffness_Nm_per_rad = 250, preload_deg = 90 }");
  CHECK(d.rest == doctest::Approx(pi / 2));
}

TEST_CASE("a passive joint keeps the limits that the file gives it") {
  const auto p = read_part<Passive>("{ passive = \"revolute\", axis = \"z\", min_deg = -45, max_deg = 45 }");
  CHECK(p.min == doctest::Approx(-pi / 4));
  CHECK(p.max == doctest::Approx(pi / 4));
}

TEST_CASE("a compliance is given as stiffness or as compliance") {
  CHECK(read_part<Compliance>("{ compliance = \"revolute\", axis = \"y\", stiffness_Nm_per_rad = 2.5e6 }")
            .stiffness == 2.5e6);
  CHECK(read_part<Compliance>("{ compliance = \"revolute\", axis = \"y\", compliance_rad_per_Nm = 4e-7 }")
            .stiffness == doctest::Approx(2.5e6));
  CHECK(read_part<Compliance>("{ compliance = \"prismatic\", axis = \"y\", stiffness_N_per_m = 1e7 }")
            .stiffness == 1e7);
  CHECK(read_part<Compliance>(
            "{ compliance = \"prismatic\", axis = \"y\", compliance_m_per_N = 1e-7, preload = \"home\" }")
            .stiffness == doctest::Approx(1e7));
}

TEST_CASE("a machine turns joints where one of its actuators does, in a branch, too") {
  const Element slide = Actuator{{JointKind::prismatic, Vector3::UnitX()}};
  const Element turn = Actuator{{JointKind::revolute, Vector3::UnitZ()}};
  const Element free = Passive{{JointKind::revolute, Vector3::UnitZ()}};
  const auto machine_of = [](std::vector<Element> elements) {
    Machine machine;
    machine.chains = {{"arm", std::move(elements)}};
    return machine;
  };
  CHECK_FALSE(turns_joints(machine_of({slide, free})));
  CHECK(turns_joints(machine_of({slide, turn})));
  CHECK(turns_joints(machine_of({slide, Group{{{"bar", {turn}}}}})));
}
