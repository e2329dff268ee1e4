#include <doctest/doctest.h>
#include <fmt/format.h>

#include "counterflex/machine/machine.hpp"
#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The report of a run whose program uses tools `numbers`.
RunReport with_tools(const std::map<long, Tool>& tools, const std::vector<long>& numbers) {
  MadeUpRun run;
  run.machine.tools = tools;
  Overview overview = overview_of(run.program);
  overview.tools = numbers;
  return report_prediction(run.context(overview), run.tally(made_up_waypoints()), {});
}

Tool radial(double k) {
  return {.length = 0.08, .from = ToolStiffness::radial, .yields = radial_tool(k)};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a report lists the tools in use with their stiffness, if one of them is elastic") {
  const RunReport report =
      with_tools({{1, radial(20e6)}, {2, {.length = 0.05}}, {3, radial(5e6)}}, {0, 1, 2, 7});
  REQUIRE(report.tools.size() == 2);
  CHECK(report.tools[0].number == 1);
  CHECK(report.tools[0].length_mm.value() == doctest::Approx(80));
  CHECK(report.tools[0].radial_N_per_um.value() == doctest::Approx(20));
  CHECK_FALSE(report.tools[1].radial_N_per_um.has_value());
  CHECK(report.tools_assumed ==
        "Tools in use: T1, stiffness from holder_N_per_um: 20 N/um at its tip; T2, rigid. Moves with another "
        "tool, or an unknown one, use [tool], rigid.");
  const std::string json = to_json(report);
  CHECK(contains(json, "\"radial_N_per_um\": 20.0"));
  CHECK(contains(json, "\"radial_N_per_um\": null"));
  CHECK(contains(json, "\"tools\": \"Tools in use: T1"));
  CHECK(contains(details_text(report, false), "  Tools in use: T1, stiffness from"));
}

TEST_CASE("a report does not mention tools unless a tool in use changes the machine") {
  for (const std::vector<long>& numbers : {std::vector<long>{0}, {2}, {0, 2, 9}}) {
    const RunReport report =
        with_tools({{0, radial(1e6)}, {1, radial(20e6)}, {2, {.length = 0.05}}}, numbers);
    CHECK(report.tools.empty());
    CHECK_FALSE(contains(to_json(report), "\"tools\""));
    CHECK_FALSE(contains(details_text(report, false), "Tools in use"));
  }
}

TEST_CASE("of many tools ten are in the sentence, and all are in the list") {
  std::map<long, Tool> tools;
  std::vector<long> numbers;
  for (long number = 1; number <= 13; ++number) {
    tools.emplace(number, radial(1e6 * static_cast<double>(number)));
    numbers.push_back(number);
  }
  const RunReport report = with_tools(tools, numbers);
  CHECK(report.tools.size() == 13);
  CHECK(contains(report.tools_assumed, "T10, stiffness"));
  CHECK_FALSE(contains(report.tools_assumed, "T11"));
  CHECK(report.tools_assumed.ends_with("; and 3 more."));
}
