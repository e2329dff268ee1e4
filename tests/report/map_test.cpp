#include "counterflex/report/map.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/report/analysis.hpp"
#include "counterflex/statics/tip_stiffness.hpp"

using namespace counterflex;

namespace {

Model model_of_file(const std::string& path) {
  return prepare(load_machine(std::string(COUNTERFLEX_SOURCE_DIR) + "/" + path));
}

const Model& mapped_mill() {
  static const Model model = model_of_file("samples/mill3/machine.toml");
  return model;
}

const Model& mapped_arm() {
  static const Model model = model_of_file("samples/robot-spindle/machine.toml");
  return model;
}

const Model& mapped_orthoglide() {
  static const Model model = model_of_file("tests/statics/data/orthoglide_case_b.toml");
  return model;
}

MapBox box_mm(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {Vector3(x0, y0, z0) * mm, Vector3(x1, y1, z1) * mm};
}

Load milling_load() {
  return {(Vector6() << -150, 80, -60, 2, 0, -1).finished()};
}

PoseAnalysis analysis_of(const Model& model, const MapRequest& request, std::size_t place) {
  const Pose X_MT{request.R_turn * tip(model.mechanism, model.home).R, request.grid.place(place)};
  return analyze_pose(model, X_MT, request.load, Method::direct);
}

/// All places of the map have the status and the value of the analysis there. Returns how many have a value.
std::size_t check_against_analysis(const Model& model, const MapRequest& request) {
  const std::vector<MapPlace> places = map_places(model, request);
  REQUIRE(places.size() == request.grid.size());
  std::size_t solved = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PoseAnalysis there = analysis_of(model, request, i);
    CAPTURE(i);
    CAPTURE(to_string(there.status));
    CHECK(places[i].status == there.status);
    if (places[i].status != Status::converged || there.status != Status::converged) continue;
    ++solved;
    if (request.quantity == MapQuantity::deviation) {
      CHECK((places[i].vector - there.deviation.head<3>()).norm() < 1e-9);
      CHECK(places[i].value == doctest::Approx(places[i].vector.norm()).epsilon(1e-12));
      continue;
    }
    REQUIRE(there.tip_compliance);
    const double expected = request.direction ? stiffness_along(*there.tip_compliance, *request.direction)
                                              : there.softest_stiffness;
    CHECK(places[i].value == doctest::Approx(expected).epsilon(1e-7));
    if (!request.direction) CHECK((places[i].vector - there.softest).norm() < 1e-4);
  }
  return solved;
}

WorkspaceMap map_of(const Model& model, const MapRequest& request) {
  WorkspaceMap map{.version = "0", .machine = "a < b"};
  map.request = request;
  map.places = map_places(model, request);
  return map;
}

/// A map of places without a machine: the value at a place is `value` (um) of its position (mm).
struct MadeUpMap {
  MapRequest request;
  std::vector<MapPlace> places;

  template <typename Value>
  MadeUpMap(const MapGrid& grid, const Value& value) {
    request.quantity = MapQuantity::deviation;
    request.grid = grid;
    for (std::size_t i = 0; i < grid.size(); ++i)
      places.push_back({Status::converged, value(Vector3(grid.place(i) / mm)) * um, Vector3::Zero()});
  }
};

std::size_t occurrences(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("the stiffness at a place of a map is that of the analysis there") {
  MapRequest request;
  request.load = milling_load();
  request.grid = grid_of(box_mm(10, 20, -350, 390, 240, -150), {4, 3, 3});
  CHECK(check_against_analysis(mapped_mill(), request) == 36);
  request.direction = Vector3(1, 2, -2).normalized();
  CHECK(check_against_analysis(mapped_mill(), request) == 36);
  MapRequest parallel;
  parallel.grid = grid_of(box_mm(-60, -50, -40, 100, 90, 80), {2, 2, 2});
  CHECK(check_against_analysis(mapped_orthoglide(), parallel) == 8);
}

TEST_CASE("the deviation at a place of a map is that of the analysis there") {
  MapRequest request;
  request.quantity = MapQuantity::deviation;
  request.load = milling_load();
  request.grid = grid_of(box_mm(10, 20, -350, 390, 240, -150), {4, 3, 3});
  CHECK(check_against_analysis(mapped_mill(), request) == 36);
  request.grid = grid_of(box_mm(-60, -60, -60, 100, 100, 100), {2, 2, 2});
  CHECK(check_against_analysis(mapped_orthoglide(), request) == 8);
}

TEST_CASE(
    "places that a robot does not reach have a status, in the orientation of home and in a turned one") {
  MapRequest request;
  request.load = milling_load();
  request.grid = grid_of(box_mm(900, -1800, 200, 3300, 1800, 1400), {5, 5, 2});
  for (const Matrix3& R : {Matrix3(Matrix3::Identity()), from_rpy(Vector3(10, -15, 30) * deg)}) {
    request.R_turn = R;
    for (const MapQuantity quantity : {MapQuantity::stiffness, MapQuantity::deviation}) {
      request.quantity = quantity;
      const std::size_t solved = check_against_analysis(mapped_arm(), request);
      CHECK(solved > 5);
      CHECK(solved < 45);
    }
  }
}

TEST_CASE("a place without a value has empty cells, never a zero") {
  MapRequest request;
  request.grid = grid_of(box_mm(-100, 100, -200, 100, 100, -200), {3, 5, 5});
  const WorkspaceMap map = map_of(mapped_mill(), request);
  REQUIRE(map.places.size() == 3);
  CHECK(map.places[0].status == Status::outside_travel);
  CHECK(map.places[1].status == Status::converged);  // on the border of travel
  const std::string table = to_csv(map);
  CHECK(table.starts_with("x_mm,y_mm,z_mm,status,stiffness_N_per_um,direction_x,direction_y,direction_z\n"));
  CHECK(table.find("\n-100.0000,100.0000,-200.0000,outside_travel,,,,\n") != std::string::npos);
  CHECK(table.find("\n0.0000,100.0000,-200.0000,converged,") != std::string::npos);
  const auto json = nlohmann::json::parse(to_json(map));
  CHECK(json["schema"] == "counterflex-map 1");
  CHECK(json["solved"] == 2);
  CHECK(json["places"][0]["value"].is_null());
  CHECK(json["places"][2]["value"].get<double>() > 0);
}

TEST_CASE("a machine without a compliance is rigid, not infinitely good") {
  MapRequest request;
  request.grid = grid_of(box_mm(0, 0, -300, 10, 10, -200), {2, 2, 1});
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml");
  std::erase_if(machine.chains[0].elements,
                [](const Element& element) { return std::holds_alternative<Spring>(element); });
  const WorkspaceMap map = map_of(prepare(machine), request);
  CHECK(range_of(map).solved == 4);
  CHECK(range_of(map).rigid == 4);
  CHECK(to_csv(map).find(",rigid,,,,\n") != std::string::npos);
  CHECK(to_text(map).find("4 of the solved ones are rigid") != std::string::npos);
  CHECK(to_text(map).find("best") == std::string::npos);
}

TEST_CASE("a map does not depend on the number of threads") {
  MapRequest request;
  request.load = milling_load();
  request.grid = grid_of(box_mm(900, -1800, 200, 3300, 1800, 1400), {6, 6, 2});
  for (const MapQuantity quantity : {MapQuantity::stiffness, MapQuantity::deviation}) {
    request.quantity = quantity;
    request.threads = 1;
    const WorkspaceMap one = map_of(mapped_arm(), request);
    request.threads = 3;
    const WorkspaceMap three = map_of(mapped_arm(), request);
    for (std::size_t i = 0; i < one.places.size(); ++i) {
      CHECK(one.places[i].status == three.places[i].status);
      CHECK(one.places[i].value == three.places[i].value);
      CHECK(one.places[i].vector == three.places[i].vector);
    }
    CHECK(map_picture(one) == map_picture(three));
  }
}

TEST_CASE("a grid has the faces of its box, x running fastest, and single places in the middle") {
  const MapGrid grid = grid_of(box_mm(0, -10, 5, 30, 10, 5), {4, 1, 7});
  CHECK(grid.size() == 4);
  CHECK((grid.place(0) - Vector3(0, 0, 5) * mm).norm() < 1e-15);
  CHECK((grid.place(1) - Vector3(10, 0, 5) * mm).norm() < 1e-15);
  CHECK((grid.place(3) - Vector3(30, 0, 5) * mm).norm() < 1e-15);
  const MapGrid two = grid_of(box_mm(0, 0, 0, 1, 1, 1), {2, 2, 2});
  CHECK((two.place(2) - Vector3(0, 1, 0) * mm).norm() < 1e-15);
  CHECK((two.place(4) - Vector3(0, 0, 1) * mm).norm() < 1e-15);
}

TEST_CASE("the box of a mill is its travel, moved to the tip") {
  const auto box = reached_box(mapped_mill());
  REQUIRE(box);
  CHECK((box->least - Vector3(0, 0, -440) * mm).norm() < 1e-12);
  CHECK((box->most - Vector3(400, 250, -140) * mm).norm() < 1e-12);
}

TEST_CASE("the corners of the box of another machine are reached, and those of a larger box are not") {
  const auto unreached = [](const Model& model, const MapBox& box) {
    int count = 0;
    const MapGrid corners{box, {2, 2, 2}};
    for (std::size_t i = 0; i < 8; ++i)
      if (analyze_pose(model, {tip(model.mechanism, model.home).R, corners.place(i)}, {}, Method::direct)
              .status != Status::converged)
        ++count;
    return count;
  };
  for (const Model* model : {&mapped_arm(), &mapped_orthoglide()}) {
    const auto box = reached_box(*model);
    REQUIRE(box);
    CHECK(unreached(*model, *box) == 0);
    const Vector3 home = tip(model->mechanism, model->home).p;
    const double larger = 1.4;
    CHECK(unreached(*model, {home + larger * (box->least - home), home + larger * (box->most - home)}) > 0);
    CHECK((box->most - box->least).minCoeff() > 50 * mm);
  }
}

TEST_CASE("a machine without limits has no box") {
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml");
  for (Element& element : machine.chains[0].elements)
    if (auto* actuator = std::get_if<Actuator>(&element))
      actuator->max = std::numeric_limits<double>::infinity();
  CHECK_FALSE(reached_box(prepare(machine)));
}

TEST_CASE("best and worst are the largest and the least stiffness, of a deviation the other way round") {
  const MadeUpMap made(grid_of(box_mm(0, 0, 0, 40, 0, 0), {5, 1, 1}),
                       [](const Vector3& p) { return 1 + std::abs(p.x() - 10); });
  WorkspaceMap map;
  map.request = made.request;
  map.places = made.places;
  map.places[2].status = Status::unreachable;
  CHECK(range_of(map).solved == 4);
  CHECK(range_of(map).best == 1);
  CHECK(range_of(map).worst == 4);
  CHECK(range_of(map).median == doctest::Approx(21 * um));  // of 1, 11, 21, 31, the upper middle
  map.request.quantity = MapQuantity::stiffness;
  CHECK(range_of(map).best == 4);
  CHECK(range_of(map).worst == 1);
}

TEST_CASE("small stiffnesses have significant digits, small deviations do not") {
  MadeUpMap made_up(grid_of(box_mm(0, 0, 0, 30, 0, 0), {3, 1, 1}),
                    [](const Vector3& p) { return 4e-4 + p.x() / 1e6; });
  WorkspaceMap map{.version = "0", .machine = "soft"};
  map.request = made_up.request;
  map.places = made_up.places;
  CHECK(to_text(map).find("0.000 um at ") != std::string::npos);
  map.request.quantity = MapQuantity::stiffness;
  for (MapPlace& place : map.places) place.value *= N_per_um / um;
  CHECK(to_text(map).find("median       0.000415 N/um\n") != std::string::npos);
}

TEST_CASE("the shift of a part makes the mean over its box least") {
  // |x - 60| + 2 |y - 20| + z: the middle of a box of 20 x 10 mm has to be at 60, 20; z as low as possible.
  const MadeUpMap made(grid_of(box_mm(0, 0, 0, 100, 100, 20), {21, 21, 3}), [](const Vector3& p) {
    return std::abs(p.x() - 60) + 2 * std::abs(p.y() - 20) + p.z();
  });
  const MapBox part = box_mm(0, 40, 10, 20, 50, 10);
  const MappedProgram placed = place_program(made.request, made.places, "part", part);
  REQUIRE(placed.present);
  CHECK(*placed.present ==
        doctest::Approx((50 + 2 * 25 + 10) * um));  // linear there: the value of the middle
  REQUIRE(placed.in_plane);
  CHECK((placed.in_plane->shift - Vector3(50, -25, 0) * mm).norm() < 1e-12);
  REQUIRE(placed.best);
  CHECK((placed.best->shift - Vector3(50, -25, -10) * mm).norm() < 1e-12);
  CHECK(placed.in_plane->value - placed.best->value == doctest::Approx(10 * um));
}

TEST_CASE("the mean of stiffnesses is force over mean motion") {
  MadeUpMap made(grid_of(box_mm(0, 0, 0, 10, 0, 0), {2, 1, 1}), [](const Vector3&) { return 0; });
  made.request.quantity = MapQuantity::stiffness;
  made.places[0].value = 10 * N_per_um;
  made.places[1].value = 30 * N_per_um;
  const MappedProgram placed = place_program(made.request, made.places, "", box_mm(0, 0, 0, 10, 0, 0));
  REQUIRE(placed.present);
  CHECK(*placed.present / N_per_um == doctest::Approx(15));  // 1 / mean(1/10, 1/30)
}

TEST_CASE("a part is not placed where a place of its box has no value, nor outside the map") {
  MadeUpMap made(grid_of(box_mm(0, 0, 0, 100, 0, 0), {11, 1, 1}), [](const Vector3& p) { return p.x(); });
  made.places[1].status = Status::unreachable;
  const MappedProgram placed = place_program(made.request, made.places, "", box_mm(0, 0, 0, 20, 0, 0));
  CHECK_FALSE(placed.present);
  REQUIRE(placed.best);
  CHECK((placed.best->shift - Vector3(20, 0, 0) * mm).norm() <
        1e-12);  // from x = 20 on, no neighbour of x = 10
  const MappedProgram large = place_program(made.request, made.places, "", box_mm(0, 0, 0, 101, 0, 0));
  CHECK_FALSE(large.present);
  CHECK_FALSE(large.best);
}

TEST_CASE("the picture has a panel for each layer, a cell for each place, and legends of what occurs") {
  MapRequest request;
  request.grid = grid_of(box_mm(-100, 0, -400, 400, 250, -200), {6, 3, 4});
  const WorkspaceMap map = map_of(mapped_mill(), request);
  const std::string svg = map_picture(map);
  CHECK(svg.find("<title id=\"title\">Map of the workspace: a &lt; b</title>") != std::string::npos);
  CHECK(occurrences(svg, ">z -") == 4);
  CHECK(svg.find(">z -400 mm<") != std::string::npos);
  CHECK(svg.find("stiffness, N/um") != std::string::npos);
  CHECK(svg.find("outside travel") != std::string::npos);
  CHECK(svg.find("not reachable") == std::string::npos);
  CHECK(occurrences(svg, "fill=\"#c4c4c4\"") == 3 * 4 + 1);  // the column of x = -100, and the legend
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
}
