#include <doctest/doctest.h>

#include "counterflex/machine/read_machine.hpp"
#include "counterflex/report/analysis.hpp"
#include "counterflex/report/formats.hpp"
#include "counterflex/report/path_curves.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

ChainLoads made_up_loads(const std::string& name, double force, double turn_deg) {
  ChainLoads loads;
  loads.name = name;
  loads[LoadKind::spring_force] = force;
  loads[LoadKind::spring_rotation] = turn_deg * deg;
  return loads;
}

/// Three places, two chains.
LoadsAlong made_up_along() {
  LoadsAlong along;
  along.unsolved = 2;
  along.places = {
      {0, 3, {made_up_loads("left", 100, 0.5), made_up_loads("right", 30, 0)}},
      {12.5 * mm, 4, {made_up_loads("left", 430.25, 0.25), made_up_loads("right", 40, 0)}},
      {20 * mm, 5, {made_up_loads("left", 430.25 * (1 + 1e-9), 0), made_up_loads("right", 20, 0)}},
  };
  return along;
}

Machine limited(double left_N, double right_N) {
  Machine machine;
  machine.load_limits.resize(2);
  machine.load_limits[0][LoadKind::spring_force] = left_N;
  machine.load_limits[0][LoadKind::spring_rotation] = 2 * deg;
  machine.load_limits[1][LoadKind::spring_force] = right_N;
  return machine;
}

RunReport with_loads(const Machine& machine, const LoadsAlong& along = made_up_along()) {
  const MadeUpRun run;
  RunReport report = predicted(run, made_up_waypoints());
  add_loads(report, along, machine);
  return report;
}

std::size_t warnings_of_limits(const RunReport& report) {
  std::size_t count = 0;
  for (const Remark& warning : report.warnings.rows) count += contains(warning.what, "its limit of");
  return count;
}

}  // namespace

TEST_CASE(
    "the largest load of every chain is named with the first line where it is, in the unit of its key") {
  const auto loads = path_loads(made_up_along(), limited(500, 60));
  REQUIRE(loads.has_value());
  REQUIRE(loads->chains.size() == 2);
  const LoadsOfChain &left = loads->chains[0], &right = loads->chains[1];
  CHECK(left.name == "left");
  CHECK(left[LoadKind::spring_force].value == doctest::Approx(430.25));
  CHECK(left[LoadKind::spring_force].line == 4);  // line 5 has the same load to within rounding
  CHECK(left[LoadKind::spring_force].limit == 500);
  CHECK(left[LoadKind::spring_rotation].value == doctest::Approx(0.5));
  CHECK(left[LoadKind::spring_rotation].line == 3);
  CHECK(*left[LoadKind::spring_rotation].limit == doctest::Approx(2));
  CHECK(right[LoadKind::spring_force].line == 4);
  CHECK(right[LoadKind::spring_force].limit == 60);
  CHECK_FALSE(right[LoadKind::spring_rotation].limit.has_value());
  CHECK(right[LoadKind::spring_rotation].line == 0);
}

TEST_CASE("exceeding a limit is a warning at its line, reaching it is not") {
  const RunReport above = with_loads(limited(400, 39.9));
  CHECK(warnings_of_limits(above) == 2);
  const std::string text = details_text(above, false);
  CHECK(contains(text, "line 4: chain left: spring force 430.3 N is above its limit of 400 N\n"));
  CHECK(contains(text, "line 4: chain right: spring force 40.00 N is above its limit of 39.9 N\n"));
  CHECK_FALSE(above.failure.has_value());
  CHECK(warnings_of_limits(with_loads(limited(430.25 * (1 + 1e-9), 40))) == 0);
  CHECK(warnings_of_limits(with_loads(Machine{})) == 0);
}

TEST_CASE(
    "the summary has what comes nearest to a limit in every chain, and nothing where no limit is given") {
  CHECK(contains(details_text(with_loads(limited(500, 60)), false),
                 "\nLoads nearest to their limits, at 3 places of the path\n"
                 "  chain left: spring force 430.3 N, 86 % of its limit of 500 N, line 4\n"
                 "  chain right: spring force 40.00 N, 67 % of its limit of 60 N, line 4\n  unknown at 2 "
                 "places more\n"));
  CHECK(contains(details_text(with_loads(limited(5000, 60)), false),
                 "  chain left: spring rotation 0.5000 deg, 25 % of its limit of 2 deg, line 3\n"));
  CHECK_FALSE(contains(details_text(with_loads(Machine{}), false), "Loads"));
}

TEST_CASE("a report without loads has null, and loads are unknown without solved places") {
  const MadeUpRun run;
  RunReport report = predicted(run, made_up_waypoints());
  CHECK(contains(to_json(report), "\n  \"loads\": null,\n"));
  add_loads(report, {{}, 7}, limited(1, 1));
  CHECK_FALSE(report.loads.has_value());
  CHECK(contains(to_json(report), "\n  \"loads\": null,\n"));
  CHECK(loads_json(report.loads) == "null");
}

TEST_CASE("the report's document has the largest loads with their lines and limits") {
  const std::string json = to_json(with_loads(limited(500, 60)));
  CHECK(contains(json, "\"places\": 3,\n    \"unsolved\": 2,\n    \"chains\": [\n"));
  CHECK(contains(json,
                 "\"spring_force_max_N\": {\n          \"largest\": 430.25,\n          \"line\": 4,\n"
                 "          \"limit\": 500.0\n        }"));
  CHECK(contains(json,
                 "\"group_moment_max_Nm\": {\n          \"largest\": 0.0,\n          \"line\": 0,\n"
                 "          \"limit\": null\n        }"));
}

TEST_CASE("small loads and limits keep their digits in the report's document") {
  LoadsAlong along;
  along.places = {{0, 3, {made_up_loads("left", 1.25e-8, 0), made_up_loads("right", 123456.789012, 0)}}};
  const std::string json = to_json(with_loads(limited(1e-7 / 3, 1e-8), along));
  CHECK(contains(json, "\"largest\": 1.25e-08,\n"));
  CHECK(contains(json, "\"limit\": 3.333333333e-08\n"));
  CHECK(contains(json, "\"largest\": 123456.8,\n"));
  CHECK(contains(json, "\"limit\": 1e-08\n"));
}

TEST_CASE("what rounding leaves of zero is no load, and has no line") {
  LoadsAlong along;
  along.places = {{0, 3, {made_up_loads("left", 3e-10, 0), made_up_loads("right", 2e-9, 0)}}};
  const auto loads = path_loads(along, limited(500, 60));
  CHECK(loads->chains[0][LoadKind::spring_force].value == 0);
  CHECK(loads->chains[0][LoadKind::spring_force].line == 0);
  CHECK(loads->chains[1][LoadKind::spring_force].value == 2e-9);
}

TEST_CASE("the loads over the path are lists of equal length with seven digits per number") {
  LoadsAlong along = made_up_along();
  along.places[0].chains[1][LoadKind::spring_force] = 1.0 / 3e4;
  along.places[2].chains[1][LoadKind::spring_force] = 123456.789;
  const std::string json = loads_json(path_loads(along, {}));
  CHECK(contains(json, "{\"s_mm\":[0.0,12.5,20.0],\"line\":[3,4,5],\"chains\":[{\"name\":\"left\","));
  CHECK(contains(json, "\"spring_force_max_N\":[3.333333e-05,40.0,123456.8]"));
  CHECK(contains(json, "\"spring_rotation_max_deg\":[0.5,0.25,0.0]"));
  for (const LoadKind kind : load_kinds)
    CHECK(contains(json, "\"" + std::string(name_of(kind).key) + "\":["));
}

TEST_CASE("loads along a path equal those of analyze at the commanded targets") {
  const Model model =
      prepare(load_machine(COUNTERFLEX_SOURCE_DIR "/tests/statics/data/orthoglide_case_b.toml"));
  const Load load{(Vector6() << 215, -10, -25, 1, 21.5, 0).finished(), false};
  std::vector<LoadPlace> places;
  for (std::size_t i = 0; i < 8; ++i)
    places.push_back({.number = i,
                      .target = static_cast<double>(i) * Vector3(12, -9, 5) * mm,
                      .load = load,
                      .model = &model});
  const LoadsAlong along = solve_loads(model, places, 1);
  REQUIRE(along.places.size() == places.size());
  const Matrix3 R = tip(model.mechanism, model.home).R;
  for (std::size_t i = 0; i < places.size(); ++i) {
    CAPTURE(i);
    const PoseAnalysis pose = analyze_pose(model, {R, places[i].target}, load, Method::direct);
    REQUIRE(pose.status == Status::converged);
    REQUIRE(along.places[i].chains.size() == pose.chains.size());
    for (std::size_t c = 0; c < pose.chains.size(); ++c)
      for (const LoadKind kind : load_kinds)
        CHECK(along.places[i].chains[c][kind] == doctest::Approx(pose.chains[c][kind]).epsilon(1e-7));
  }
}

TEST_CASE("loads have four digits, for any size") {
  LoadsOfChain chain;
  chain.name = "arm";
  for (const auto& [value, text] : {std::pair{99.99999, "100.0"},
                                    {123456.7, "123457"},
                                    {0.00123456, "0.001235"},
                                    {0.0, "0.000"},
                                    {9.5, "9.500"},
                                    {1000.0, "1000"}}) {
    chain[LoadKind::group_moment].value = value;
    CHECK(load_in_words(chain, LoadKind::group_moment) ==
          "chain arm: group moment " + std::string(text) + " N m");
  }
}
