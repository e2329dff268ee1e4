/// Machines without a measured stiffness in reports.
#include <doctest/doctest.h>

#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

RunReport with_source(NumberSource source) {
  MadeUpRun run;
  run.machine.chains.push_back({"arm", {Compliance{Joint{}, 1e6, "X"}}});
  run.machine.parameters.push_back({"X.compliance_m_per_N", source, 1e-8, "a note"});
  return predicted(run, made_up_waypoints(), {});
}

}  // namespace

TEST_CASE("a report calls a machine without a measured stiffness UNMEASURED") {
  const RunReport report = with_source(NumberSource::catalogue);
  CHECK(report.unmeasured == "UNMEASURED: no stiffness in the machine file is measured");
  CHECK(to_json(report).find("\"unmeasured\": \"UNMEASURED: no stiffness") != std::string::npos);
  CHECK(details_text(report, false).find("  UNMEASURED: no stiffness") != std::string::npos);
  CHECK(summary_text(report, {}, false).find("  machine     UNMEASURED: no stiffness") != std::string::npos);
}

TEST_CASE("a report does not mention it for a measured machine, or for a file without sources") {
  for (const RunReport& report :
       {with_source(NumberSource::measured), predicted({}, made_up_waypoints(), {})}) {
    CHECK(report.unmeasured.empty());
    CHECK(to_json(report).find("nmeasured") == std::string::npos);
    CHECK(details_text(report, false).find("UNMEASURED") == std::string::npos);
    CHECK(summary_text(report, {}, false).find("UNMEASURED") == std::string::npos);
  }
}
