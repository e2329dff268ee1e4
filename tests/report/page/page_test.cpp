#include "counterflex/report/page.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "counterflex/files/files.hpp"
#include "counterflex/report/formats.hpp"
#include "report/made_up_run.hpp"
#include "report/page/arrays.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string page_of(const std::string& title, const std::vector<PageRun>& runs,
                    const std::string& conclusion = "", const std::string& sheet = "") {
  std::string page;
  write_page(
      title, runs, [&](std::string_view part) { page += part; }, conclusion, sheet);
  return page;
}

std::string between(const std::string& text, const std::string& begin, const std::string& end,
                    std::size_t from = 0) {
  const std::size_t first = text.find(begin, from) + begin.size();
  return text.substr(first, text.find(end, first) - first);
}

const std::string data_begins = "<script type=\"application/json\" id=\"counterflex-data\">";

/// The contents of elements that begin with `tag`.
std::vector<std::string> contents(const std::string& page, const std::string& tag, const std::string& end) {
  std::vector<std::string> found;
  for (std::size_t i = page.find(tag); i != std::string::npos; i = page.find(tag, i + 1))
    found.push_back(between(page, tag, end, i));
  return found;
}

}  // namespace

TEST_CASE("a page allows the scripts and styles that it holds, and nothing else") {
  const std::string page = page_of("part", {{"", "{}"}});
  const std::string policy = between(page, "http-equiv=\"Content-Security-Policy\" content=\"", "\"");
  CHECK(policy.starts_with("default-src 'none'; script-src 'sha256-"));
  for (const char* loose : {"unsafe", "http", "*", "'self'"}) CHECK_FALSE(contains(policy, loose));
  std::size_t scripts = 0;
  for (const std::string& script : contents(page, "<script>", "</script>")) {
    CHECK(contains(policy, "'" + integrity(script) + "'"));
    ++scripts;
  }
  CHECK(scripts >= 4);
  for (const std::string& style : contents(page, "<style>", "</style>"))
    CHECK(contains(policy, "'" + integrity(style) + "'"));
  // Our own scripts have no addresses to load from; the libraries have those of their licences.
  CHECK_FALSE(contains(page, " src="));
  CHECK_FALSE(contains(page, "<link"));
}

TEST_CASE("a sheet adds itself, its style and the hash of the style to a page, and no other byte") {
  const std::string sheet = "<article id=\"sheet\">T1</article>\n";
  const std::string plain = page_of("part", {{"", "{}"}});
  std::string page = page_of("part", {{"", "{}"}}, "", sheet);
  const std::string style = contents(page, "<style>", "</style>").back();
  CHECK(contains(style, "#sheet {"));
  CHECK_FALSE(contains(plain, "#sheet"));
  for (const std::string& added : {sheet, "<style>" + style + "</style>\n", " '" + integrity(style) + "'"}) {
    const std::size_t at = page.find(added);
    REQUIRE(at != std::string::npos);
    page.erase(at, added.size());
  }
  CHECK(page == plain);
}

TEST_CASE("a sheet has no row left empty, escapes what it quotes, and counts what it has no room for") {
  MadeUpRun run;
  run.machine.name = "Mill <1>";
  const Overview overview = overview_of(run.program);
  run.facts.proof.emplace();
  for (long tool = 1; tool <= 20; ++tool) {
    run.facts.proof->tools.push_back({tool, 100.125, {}, {}});
    run.facts.proof->restart.lines.push_back(
        {static_cast<int>(tool), tool, "T" + std::to_string(tool), "G21"});
  }
  run.facts.proof->restart.lines.back().missing.clear();
  run.facts.proof->offsets.push_back({"G54", {1, -2.5, 0}, {0, 0, 90}, {}});
  const RunReport report = report_compensation(run.context(overview), run.tally({}), {});
  const std::string sheet = proof_sheet(report);
  CHECK(contains(sheet, "Mill &lt;1&gt;"));
  CHECK_FALSE(contains(sheet, "<td></td>"));
  CHECK(contains(sheet, "data-fact=\"serial\">not stated<"));
  CHECK(contains(sheet, "<td>1, -2.5, 0</td><td>0, 0, 90</td><td>not stated</td><td>none</td>"));
  CHECK(contains(sheet, "with the offset off by 0.01 mm"));
  CHECK(contains(sheet, "<td>T7</td><td>100.125</td><td>not stated</td><td>none</td>"));
  CHECK_FALSE(contains(sheet, "<td>T8</td><td>100.125</td>"));
  CHECK(contains(sheet, "13 more tools"));
  CHECK(contains(sheet, "13 more lines"));
  CHECK(contains(sheet, "<tr><td>20</td><td>T20</td><td>yes</td></tr>\n<tr><td>1</td>"));
}

TEST_CASE("the data of a page is the report, with any characters") {
  const std::string report = R"({"what": "</script><b>&amp;\u2028"})";
  const std::string page = page_of("a < b & c", {{"A", report, "{\"k\": 1}"}, {"B", "{}"}});
  CHECK(contains(page, "<title>a &lt; b &amp; c</title>"));
  const std::string data = between(page, data_begins, "</script>");
  CHECK_FALSE(contains(data, "<"));
  const auto document = nlohmann::json::parse(data);
  CHECK(document["schema"] == "counterflex-page 1");
  REQUIRE(document["runs"].size() == 2);
  CHECK(document["runs"][0]["report"] == nlohmann::json::parse(report));
  CHECK(document["runs"][0]["curves"]["k"] == 1);
  CHECK(document["runs"][1]["name"] == "B");
  CHECK(document["runs"][1]["loads"].is_null());
}

TEST_CASE("the page has the conclusion of a comparison, if any") {
  const auto data = [](const std::string& conclusion) {
    return nlohmann::json::parse(
        between(page_of("both", {{"A", "{}"}, {"B", "{}"}}, conclusion), data_begins, "</script>"));
  };
  CHECK(data("\"A\" </script> leaves less.")["conclusion"] == "\"A\" </script> leaves less.");
  CHECK(data("A leaves less.")["runs"].size() == 2);
  CHECK_FALSE(data("").contains("conclusion"));
}

TEST_CASE("curves are written as the bytes of their numbers") {
  PathCurves curves(true);
  std::vector<Waypoint> path = made_up_waypoints();
  path[1].s = 75 * mm;  // away from the rapid's end
  for (const Waypoint& w : path) curves.add(w, 2);
  curves.add_force_step(12.5);
  const auto document = nlohmann::json::parse(curves_json(curves));
  const std::size_t n = curves.stretches().size();
  CHECK(document["stretches"] == n);
  CHECK(document["force_steps"]["s_mm"][0] == 12.5);
  CHECK(array_of<std::int32_t>(document["operation"]) == std::vector<std::int32_t>(n, 2));
  REQUIRE(array_of<double>(document["s_mm"]).size() == n);
  const auto after = array_of<float>(document["quantities"]["after_mm"]["largest"]);
  REQUIRE(after.size() == n);
  CHECK(after[0] == doctest::Approx(0.006));
  CHECK(std::isnan(array_of<float>(document["quantities"]["before_mm"]["largest"])[0]));
  CHECK_FALSE(document["quantities"]["after_mm"].contains("least"));
  CHECK(array_of<float>(document["place_mm"]).size() == 3 * n);
  CHECK(std::isnan(array_of<float>(document["place_before_mm"])[0]));  // unknown, not 0
}

TEST_CASE("directions are written while each stretch has one waypoint") {
  PathCurves curves(true);
  for (const Waypoint& w : made_up_waypoints()) curves.add(w, 0);
  const auto document = nlohmann::json::parse(curves_json(curves));
  CHECK(array_of<float>(document["direction"]).size() == 3 * curves.stretches().size());
  PathCurves merged(true);
  for (std::size_t i = 0; i <= PathCurves::most_stretches; ++i) merged.add(made_up_waypoints().back(), 0);
  CHECK_FALSE(nlohmann::json::parse(curves_json(merged)).contains("direction"));
}

TEST_CASE("the page has the whole program, unless it is too long, and the full path of the written one") {
  const MadeUpRun run;
  RunReport report = predicted(run, made_up_waypoints());
  const auto source = [&](const std::string& text) {
    FileReader program = FileReader::of_bytes(text);
    return nlohmann::json::parse(source_json(program, report));
  };
  CHECK(source("%\r\nG1 X1\xFF\n")["text"] == "%\nG1 X1\uFFFD\n");
  CHECK_FALSE(contains(source("(\033[31m)\n")["text"].get<std::string>(), "\033"));
  CHECK(source(std::string(longest_program_text, ' '))["text"].is_string());
  CHECK(source(std::string(longest_program_text + 1, ' '))["text"].is_null());
  CHECK(source("")["output"].is_null());
  report.facts.output = "out/part.nc";
  const std::string output = source("")["output"];
  CHECK(output.starts_with('/'));
  CHECK(output.ends_with("/out/part.nc"));
}

TEST_CASE("a quantity without known values has no array") {
  PathCurves curves(false);
  Waypoint w = cut(1, 4, 75, Vector3(0, 0.3, 0));
  w.causes.reset();
  curves.add(w, 0);
  const auto quantities = nlohmann::json::parse(curves_json(curves))["quantities"];
  CHECK(quantities.contains("before_mm"));
  for (const char* name : {"after_mm", "geometry_mm", "air_mm", "correction_mm"})
    CHECK_FALSE(quantities.contains(name));
}

TEST_CASE("a page is named after program and machine") {
  const MadeUpRun run;
  CHECK(page_title(predicted(run, made_up_waypoints())) == "made_up.ngc on Mill");
}

TEST_CASE("a page shows the same files as the summary, without folders") {
  MadeUpRun run;
  run.facts.inputs[0].path = "-";
  CHECK(page_title(predicted(run, made_up_waypoints())) == "standard input on Mill");
  run.facts.inputs[0].path = "in/made_up.ngc";
  run.facts.inputs.push_back({"corrected", "out/made_up.comp.ngc", ""});
  const RunReport report = verified(run, run.program, made_up_waypoints());
  CHECK(page_title(report) == "made_up.comp.ngc for made_up.ngc on Mill");
  CHECK(contains(details_text(report, false), "verify out/made_up.comp.ngc for in/made_up.ngc\n"));
}
