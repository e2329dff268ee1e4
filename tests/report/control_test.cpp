#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A report of a corrected program `text` of `original`.
RunReport report_on(const std::string& original, const std::string& text, double correction_mm = 0,
                    const std::string& dialect = "linuxcnc") {
  MadeUpRun run;
  run.job.read.dialect = dialect;
  run.read(original, "made_up.ngc");
  Compensation c;
  c.text = text;
  c.waypoints.emplace_back().segment = no_segment;
  c.waypoints[0].line = 1;
  c.waypoints[0].correction.x() = correction_mm * mm;
  return compensated(run, c);
}

/// The warnings that have `part` in them.
std::vector<std::string> warnings_with(const RunReport& report, const std::string& part) {
  std::vector<std::string> found;
  for (const Remark& warning : report.warnings.rows)
    if (warning.what.find(part) != std::string::npos) found.push_back(warning.what);
  return found;
}

const std::string start = "G21 G90 G94\nG0 X0 Y0 Z0\n";

}  // namespace

TEST_CASE("feed moves shorter in time than a control's block are counted, with the first and the shortest") {
  // 600 mm/min are 10 mm/s: 1.5 ms, 1 ms, 3 ms; rapids and moves of no length do not count
  const std::string text = start + "G1 X0.015 F600\nX0.025\nX0.055\nX0.055\nG0 X0.056\n";
  const RunReport report = report_on(start, text);
  REQUIRE(report.control.short_blocks);
  const ShortBlocks& blocks = *report.control.short_blocks;
  CHECK(blocks.count == 2);
  CHECK(blocks.first_line == 3);
  CHECK(blocks.shortest_line == 4);
  CHECK(blocks.shortest_ms == doctest::Approx(1));
  CHECK(warnings_with(report, "2 feed moves of the corrected program take less than 2 ms").size() == 1);
  CHECK(to_json(report).find("\"first_line\": 3") != std::string::npos);
}

TEST_CASE("the zones of the corrected program are those of the report") {
  const std::string original = "def a():\n movel(p[0,0,0,0,0,0])\n movel(p[0,0,1,0,0,0],r=0.002)\nend\n";
  const RunReport report = report_on(
      original, "def a():\n movel(p[0,0,0,0,0,0],r=0.001)\n movel(p[0,0,1,0,0,0],r=0.0015)\nend\n", 0, "ur");
  CHECK(zones_in_words(report.control.zones) == "round 2 targets, largest 1.5 mm, line 3");
  CHECK(
      details_text(report, false).find("  zones of the corrected program round 2 targets, largest 1.5 mm") !=
      std::string::npos);
  CHECK(to_json(report).find("\"zones\": {\n      \"count\": 2,\n      \"largest_mm\": 1.5") !=
        std::string::npos);
}

TEST_CASE("of short blocks that differ by rounding the first is the shortest") {
  const RunReport report = report_on(start, start + "G1 X0.01 F600\nX0.02\nX0.03\nX0.04\n");
  CHECK(report.control.short_blocks->count == 4);
  CHECK(report.control.short_blocks->shortest_line == 3);
}

TEST_CASE("the time of a short block is the caller's choice, and without one there is no warning") {
  MadeUpRun run;
  run.facts.min_block_ms = 0.5;
  Compensation c;
  c.text = start + "G1 X0.015 F600\n";
  const RunReport report = compensated(run, c);
  CHECK(report.control.short_blocks->count == 0);
  CHECK(warnings_with(report, "take").empty());
}

TEST_CASE("lines near the limit of the control are counted and give a warning") {
  const std::string text = start + "G1 X1 F100 (" + std::string(225, 'c') + ")\n";
  const RunReport report = report_on(start, text);
  CHECK(report.control.lines->near == 1);
  CHECK(warnings_with(report, "one line of the corrected program has more than 90 % of the 255").size() == 1);
  CHECK(warnings_with(report_on("G21\nG0 X0\n", "G21\nG0 X0\n"), "90 %").empty());
}

TEST_CASE("a path tolerance above the largest correction gives a warning with both numbers") {
  const std::string original = "G21 G90\nG64 P0.05 Q0.02\nG0 X0 Y0 Z0\n";
  const auto warned = [&](double correction_mm, const std::string& what) {
    return warnings_with(report_on(original, original, correction_mm), what).size() == 1;
  };
  CHECK(warned(0.0125, "the largest correction, 0.0125 mm, may vanish within the 0.05 mm that G64 allows"));
  CHECK(warned(0.3, "0.3000 mm, is more than the 0.05 mm that G64 allows: only smaller ones may vanish"));
  CHECK(warnings_with(report_on(original, original, 0), "largest correction").empty());
  CHECK(warnings_with(report_on("G21\nG64\nG0 X0\n", "G21\nG64\nG0 X0\n", 0.3),
                      "0.3000 mm, may vanish: the control may leave the path by any distance")
            .size() == 1);
}

TEST_CASE("path tolerances of inch programs are in mm, each different one once") {
  const RunReport report = report_on("G20 G90\nG64 P0.002\nG64 P0.002\nG64 P0.001 Q0.001\nG0 X0\n", "");
  REQUIRE(report.control.tolerances.size() == 2);
  CHECK(report.control.tolerances[0].path_mm == doctest::Approx(0.0508));
  CHECK_FALSE(report.control.tolerances[0].merge_mm.has_value());
  CHECK(report.control.tolerances[1].line == 4);
  CHECK(report.control.tolerances[1].merge_mm == doctest::Approx(0.0254));
}

TEST_CASE("more than three plunges per rapid give a warning") {
  const auto program = [](int plunges) {
    std::string text = start + "G1 F100\n";
    for (int i = 0; i < plunges; ++i) text += "Z5\nX" + std::to_string(i + 1) + "\nZ-1\n";
    return text;
  };
  const RunReport three = report_on(program(3), ""), four = report_on(program(4), "");
  CHECK(three.control.rapids == 1);
  CHECK(three.control.plunges == 3);
  CHECK(warnings_with(three, "plunges at feed").empty());
  CHECK(warnings_with(four, "4 plunges at feed, but 1 rapids").size() == 1);
}
