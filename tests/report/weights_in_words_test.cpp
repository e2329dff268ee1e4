/// The machine's own weight in reports.
#include <doctest/doctest.h>

#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

RunReport with_weight(double kg, const Gravity& gravity) {
  MadeUpRun run;
  run.machine.chains.push_back({"arm", {PointMass{kg, Vector3::Zero()}}});
  run.machine.gravity = gravity;
  return predicted(run, made_up_waypoints(), {});
}

}  // namespace

TEST_CASE("a report states which weights act and when the control's zero was set") {
  const Vector3 g(0, 0, -9.81);
  CHECK(with_weight(755, {.g = g, .true_at_home = true}).gravity ==
        "The machine's 755 kg weigh on it, with and without a cut; the control's zero was set under this "
        "weight "
        "at home, where the perfect machine has no deviation.");
  const RunReport unloaded = with_weight(40, {.g = g});
  CHECK(unloaded.gravity.ends_with("the control's zero was set unloaded."));
  CHECK(to_json(unloaded).find("\"gravity\": \"The machine's 40 kg") != std::string::npos);
  CHECK(details_text(unloaded, false).find("  The machine's 40 kg weigh") != std::string::npos);
}

TEST_CASE("without a force weight is named beside the geometry") {
  MadeUpRun run;
  std::vector<Waypoint> waypoints = made_up_waypoints();
  for (Waypoint& w : waypoints) w.wrench.setZero();
  CHECK(details_text(predicted(run, waypoints, {}), false)
            .find("no cutting force given: only geometric errors count") != std::string::npos);
  run.machine.chains.push_back({"arm", {PointMass{40, Vector3::Zero()}}});
  run.machine.gravity.g = {0, 0, -9.81};
  CHECK(details_text(predicted(run, waypoints, {}), false)
            .find("no cutting force given: only geometric errors and weight count") != std::string::npos);
}

TEST_CASE("masses without gravity have no weight, and a report does not mention them") {
  const RunReport report = with_weight(40, {});
  CHECK(report.gravity.empty());
  CHECK(to_json(report).find("kg") == std::string::npos);
}
