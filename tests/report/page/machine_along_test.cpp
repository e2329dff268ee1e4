#include "counterflex/report/machine_along.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <deque>
#include <nlohmann/json.hpp>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/program_axes.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "report/page/arrays.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string source = COUNTERFLEX_SOURCE_DIR;

/// A machine and places at its tip's home and around it.
struct MachineAndPlaces {
  Machine machine;
  Model model;
  std::vector<LoadPlace> places{};

  explicit MachineAndPlaces(const std::string& file) : MachineAndPlaces(load_machine(source + file)) {}
  explicit MachineAndPlaces(const Machine& of) : machine(of), model(prepare(of)) {}

  Pose home() const { return tip(model.mechanism, model.home); }

  void add(const Vector3& p, const std::optional<Matrix3>& R = {}) {
    LoadPlace& place = places.emplace_back();
    place.at.s = 5 * mm * static_cast<double>(places.size());
    place.at.line = static_cast<int>(10 * places.size());
    place.at.R_MT = R;
    place.target = p;
    place.model = &model;
  }

  /// On a circle in the machine's xy, turned by up to `tilt` (rad) about x if it is not zero.
  void add_circle(std::size_t count, double radius, double tilt = 0) {
    const Pose X = home();
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(count);
      const Vector3 p = X.p + radius * Vector3(std::cos(angle), std::sin(angle), 0);
      add(p, tilt == 0 ? std::nullopt
                       : std::optional<Matrix3>(exp_so3(tilt * std::sin(angle) * Vector3::UnitX()) * X.R));
    }
  }

  MachineAlong along() const { return machine_along(machine, model, places, 1); }
  nlohmann::json json() const { return nlohmann::json::parse(machine_json(along())); }
};

std::deque<MachineAndPlaces> several_machines() {
  std::deque<MachineAndPlaces> machines;  // places point to models
  for (const char* arm : {"/tests/statics/data/serial6r_joints.toml", "/samples/robot-ur10/machine.toml",
                          "/samples/robot-rail/machine.toml", "/samples/hexapod/machine.toml"})
    machines.emplace_back(arm).add_circle(12, 40 * mm, 8 * deg);
  for (const char* other : {"/samples/delta/machine.toml", "/samples/orthoglide-groove/machine.toml",
                            "/samples/mill3/machine.toml"})
    machines.emplace_back(other).add_circle(12, 20 * mm);
  return machines;
}

std::size_t node_count(const nlohmann::json& skeleton) {
  std::size_t count = 0;
  for (const auto& line : skeleton["lines"]) count += line.size();
  return count;
}

}  // namespace

TEST_CASE(
    "the shown values at a place put the tip at the commanded pose, and are those of `analyze --pose`") {
  for (const MachineAndPlaces& one : several_machines()) {
    CAPTURE(one.machine.name);
    const MachineAlong along = one.along();
    REQUIRE(along.places.size() == one.places.size());
    for (std::size_t i = 0; i < along.places.size(); ++i) {
      CAPTURE(i);
      const KinematicPlace& place = along.places[i].place;
      REQUIRE(place.is_known());
      const Pose wanted{one.places[i].at.R_MT.value_or(one.home().R), one.places[i].target};
      // A machine with three axes does not control the orientation.
      const Pose reached = place_at_values(one.model, place.shown).X_MT;
      CHECK((reached.p - wanted.p).norm() < 1e-9);
      if (one.places[i].at.R_MT) CHECK(deviation(reached, wanted).norm() < 1e-9);
      CHECK((place_at_tip(one.model, wanted).shown - place.shown).norm() < 1e-8);
    }
  }
}

TEST_CASE("the machine along a path does not depend on threads, nor on cells but for rounding") {
  for (const MachineAndPlaces& one : several_machines()) {
    CAPTURE(one.machine.name);
    const StartTables starts;
    const MachineAlong alone = one.along(),
                       cells = machine_along(one.machine, one.model, one.places, 1, &starts),
                       threads = machine_along(one.machine, one.model, one.places, 3, &starts);
    for (std::size_t i = 0; i < one.places.size(); ++i) {
      CAPTURE(i);
      REQUIRE(cells.places[i].place.is_known());
      CHECK(threads.places[i].place.shown == cells.places[i].place.shown);
      CHECK(threads.places[i].conditioning == cells.places[i].conditioning);
      CHECK((alone.places[i].place.shown - cells.places[i].place.shown).norm() < 1e-8);
      CHECK(alone.places[i].conditioning == doctest::Approx(cells.places[i].conditioning).epsilon(1e-6));
      CHECK((alone.places[i].lines.back().back() - cells.places[i].lines.back().back()).norm() < 1e-9);
    }
  }
}

TEST_CASE("the data of a page has shown values, and the limits of the machine file") {
  MachineAndPlaces robot("/samples/robot-rail/machine.toml");
  robot.add_circle(7, 40 * mm, 5 * deg);
  const nlohmann::json json = robot.json();
  const MachineAlong along = robot.along();
  REQUIRE(json["axes"].size() == 6);
  CHECK(json["axes"][0]["name"] == "axis A1");
  CHECK(json["axes"][0]["unit"] == "deg");
  CHECK(json["axes"][1]["min"] == -140);
  CHECK(json["axes"][1]["max"] == -5);
  const auto values = array_of<float>(json["axes"][1]["values"]);
  REQUIRE(values.size() == 7);
  CHECK(values[3] == doctest::Approx(along.places[3].place.shown[1] / deg));
  CHECK(array_of<double>(json["s_mm"])[2] == doctest::Approx(15));
  CHECK(array_of<std::int32_t>(json["line"])[2] == 30);
  MachineAndPlaces delta("/samples/delta/machine.toml");
  delta.add_circle(3, 20 * mm);
  CHECK(delta.json()["axes"][0]["unit"] == "mm");
  CHECK(delta.json()["axes"][0]["min"] == -250);
}

TEST_CASE("a machine without limits shows none") {
  MachineAndPlaces arm("/tests/statics/data/serial6r_joints.toml");
  arm.add_circle(3, 20 * mm, 5 * deg);
  const nlohmann::json json = arm.json();  // outlives the loop, which a temporary in its head does not
  for (const auto& axis : json["axes"]) {
    CHECK(axis["min"].is_null());
    CHECK(axis["max"].is_null());
  }
}

TEST_CASE("a place that the machine does not reach is not known, and the next one is") {
  MachineAndPlaces robot("/samples/robot-ur10/machine.toml");
  robot.add_circle(2, 20 * mm);
  robot.add(robot.home().p + Vector3(0, 0, 9));
  robot.add(robot.home().p);
  const nlohmann::json json = robot.json();
  const auto values = array_of<float>(json["axes"][0]["values"]);
  REQUIRE(values.size() == 4);
  CHECK(std::isfinite(values[1]));
  CHECK(std::isnan(values[2]));
  CHECK(std::isfinite(values[3]));
}

TEST_CASE("rotary axes count on over full turns") {
  MachineAndPlaces arm("/tests/statics/data/serial6r_joints.toml");
  const Pose X = arm.home();
  for (int i = 0; i <= 9; ++i)  // about the tool axis of a tool in line with axis A6
    arm.add(X.p, Matrix3(X.R * exp_so3(i * 50 * deg * Vector3::UnitX())));
  arm.model.mechanism.X_PT.p = Vector3(0.25, 0, 0);
  const MachineAlong along = arm.along();
  const auto a6 = [&](std::size_t i) { return along.places[i].place.shown[5]; };
  for (std::size_t i = 1; i < along.places.size(); ++i) CHECK(a6(i) - a6(i - 1) == doctest::Approx(50 * deg));
}

TEST_CASE("an arm has three margins, and a limit for them only if the program turns the tool") {
  MachineAndPlaces arm("/tests/statics/data/serial6r_joints.toml");
  arm.add_circle(4, 20 * mm);
  CHECK(arm.json()["refused_below_deg"].is_null());
  arm.add(arm.home().p, arm.home().R);
  const nlohmann::json json = arm.json();
  CHECK(json["refused_below_deg"] == 1);
  CHECK(json["conditioning"].is_null());
  REQUIRE(json["margins"].size() == 3);
  const auto margins = arm.along().places[2].place.margins;
  REQUIRE(margins);
  CHECK(array_of<float>(json["margins"][1]["values"])[2] == doctest::Approx((*margins)[1].angle / deg));
}

TEST_CASE("a machine without margins shows how evenly its actuators move the tip, if that changes") {
  MachineAndPlaces hexapod("/samples/hexapod/machine.toml");
  hexapod.add_circle(5, 40 * mm, 5 * deg);
  const nlohmann::json json = hexapod.json();
  CHECK(json["margins"].empty());
  CHECK(json["refused_below_deg"].is_null());
  const auto values = array_of<float>(json["conditioning"]);
  const NominalResult at =
      follow(hexapod.model, hexapod.model.home, {*hexapod.places[2].at.R_MT, hexapod.places[2].target});
  CHECK(values[2] == doctest::Approx(1 / actuator_jacobian(hexapod.model, at.configuration).condition));
  MachineAndPlaces mill("/samples/mill3/machine.toml");
  mill.add_circle(5, 20 * mm);
  CHECK(mill.json()["conditioning"].is_null());
}

TEST_CASE("lines of the machine end at the tip, and links keep their length") {
  for (const MachineAndPlaces& one : several_machines()) {
    CAPTURE(one.machine.name);
    const MachineAlong along = one.along();
    const auto& first = along.places[0].lines;
    for (std::size_t i = 0; i < along.places.size(); ++i) {
      const auto& lines = along.places[i].lines;
      CHECK((lines.back().back() - one.places[i].target).norm() < 1e-9);
      REQUIRE(lines.size() == first.size());
      for (std::size_t l = 0; l < lines.size(); ++l) CHECK(lines[l].size() == first[l].size());
    }
  }
  MachineAndPlaces delta("/samples/delta/machine.toml");
  delta.add_circle(4, 50 * mm);
  for (const MachinePlace& at : delta.along().places) {
    REQUIRE(at.lines.size() == 13);  // of each leg: the rail, two bars, the platform; and the tool
    for (std::size_t leg = 0; leg < 3; ++leg)
      for (const std::size_t bar : {1u, 2u}) {
        const SkeletonLine& line = at.lines[4 * leg + bar];
        CHECK((line[2] - line[1]).norm() == doctest::Approx(0.5));
      }
  }
}

TEST_CASE("a rail is drawn at the value that the program commands, and named") {
  const Machine machine = load_machine(source + "/samples/robot-rail/machine.toml");
  MachineAndPlaces robot(at_program_axes(machine, {2350.0}));
  robot.add_circle(3, 20 * mm);
  const nlohmann::json json = robot.json();
  CHECK(json["constant"] == nlohmann::json::parse(R"([{"name": "E1", "unit": "mm", "value": 2350}])"));
  CHECK(json["skeleton"]["lines"][0][0] == nlohmann::json({0, 0, 0}));
  CHECK(json["skeleton"]["lines"][0][1] == nlohmann::json({2350, 0, 0}));
}

TEST_CASE("a long path has fewer positions of the machine's lines") {
  MachineAndPlaces delta("/samples/delta/machine.toml");
  delta.add_circle(LoadPlaces::most, 60 * mm);
  const std::string text = machine_json(delta.along());
  const nlohmann::json json = nlohmann::json::parse(text);
  CHECK(json["skeleton"]["every"] > 1);
  CHECK(node_count(json["skeleton"]) > 20);
  CHECK(text.size() < 250000);
}
