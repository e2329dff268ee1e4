#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/files/text.hpp"
#include "counterflex/report/page.hpp"
#include "made_up_run.hpp"
#include "report/plot/plot_points.hpp"
#include "report/plot/plot_ticks.hpp"
#include "report/plot/svg.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// `count` feed waypoints, 1 mm apart, whose deviation before in x is `value_mm(i)`.
template <typename Value>
PathCurves path_with(std::size_t count, const Value& value_mm) {
  PathCurves curves(true);
  for (std::size_t i = 0; i < count; ++i) {
    Waypoint w = cut(i, static_cast<int>(i + 1), 1, Vector3(value_mm(i), 0, 0));
    w.s = static_cast<double>(i + 1) * mm;
    curves.add(w, -1);
  }
  return curves;
}

RunReport report_of_made_up() {
  const MadeUpRun run;
  Compensation c;
  c.text = "G21 G0 X1\n";
  c.waypoints = made_up_waypoints();
  RunReport report = compensated(run, c);
  report.tolerance_mm = 0.005;
  return report;
}

std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::vector<PlotPoint> before_x(const PathCurves& curves, std::size_t most) {
  return plot_points(curves, plot_columns(curves, most), Quantity::before_x);
}

}  // namespace

TEST_CASE("ticks are multiples of 1, 2 or 5 times a power of ten, within the range, no more than wanted") {
  for (const auto& [least, largest] : {std::pair{0.0, 1.0},
                                       {-0.96, 0.41},
                                       {0.0, 220.0},
                                       {-1e-7, 3e-7},
                                       {-1709.0, 12.0},
                                       {0.0, 0.00499},
                                       {3.0, 1e6}})
    for (const int most : {2, 4, 5, 8}) {
      const auto& to = largest;
      CAPTURE(to);
      CAPTURE(most);
      const PlotTicks ticks = ticks_within(least, largest, most);
      REQUIRE_FALSE(ticks.values.empty());
      CHECK(ticks.values.size() <= static_cast<std::size_t>(most) + 1);
      CHECK(ticks.values.front() >= least - 1e-6 * largest);
      CHECK(ticks.values.back() <= largest * (1 + 1e-6));
      if (ticks.values.size() < 2) continue;
      const double step = ticks.values[1] - ticks.values[0];
      const double leading = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
      CHECK(std::min({std::abs(leading - 1), std::abs(leading - 2), std::abs(leading - 5)}) < 1e-6);
      CHECK(std::abs(std::stod(format_fixed(step, ticks.decimals)) - step) < 1e-6 * step);
    }
}

TEST_CASE("ticks around a range hold it between the first and the last, no more of them than wanted") {
  for (const auto& [least, largest] : {std::pair{-0.96, 0.41},
                                       {0.0, 4.13},
                                       {0.0, 0.0},
                                       {3.0, 3.0},
                                       {-2.0, -2.0},
                                       {0.0, std::numeric_limits<double>::quiet_NaN()},
                                       {-2.08, 0.25},
                                       {-4.9, 4.9},
                                       {-1.0, 1.0},
                                       {0.9e-9, 1.1e-9}})
    for (const int most : {2, 4, 5}) {
      const auto& from = least;
      CAPTURE(from);
      const auto& to = largest;
      CAPTURE(to);
      CAPTURE(most);
      const PlotTicks ticks = ticks_around(least, largest, most);
      REQUIRE(ticks.values.size() >= 2);
      CHECK(ticks.values.size() <= static_cast<std::size_t>(most) + 1);
      const double slack = 1e-6 * (ticks.values.back() - ticks.values.front());
      CHECK_FALSE(ticks.values.front() > least + slack);
      CHECK_FALSE(ticks.values.back() < largest - slack);
      for (std::size_t i = 1; i < ticks.values.size(); ++i) CHECK(ticks.values[i] > ticks.values[i - 1]);
    }
}

TEST_CASE("text in XML is escaped, and bytes that are invalid there are replaced") {
  CHECK(xml_escaped("a<b & \"c\">") == "a&lt;b &amp; &quot;c&quot;&gt;");
  CHECK(xml_escaped("\u00b5m \u20ac \U0001F600") == "\u00b5m \u20ac \U0001F600");
  const std::string bad = "\uFFFD";
  for (const std::string text : {"\xFF", "\xC3", "\x01", "\n", "\x7F", "\xEF\xBF\xBF"})
    CHECK(xml_escaped(text) == bad);
  CHECK(xml_escaped("\xC0\xAF") == bad + bad);                      // a longer form of "/"
  CHECK(xml_escaped("\xED\xA0\x80") == bad + bad + bad);            // a surrogate
  CHECK(xml_escaped("\xE2\x82") == bad + bad);                      // cut off
  CHECK(xml_escaped("\xF4\x90\x80\x80") == bad + bad + bad + bad);  // beyond the last character
  CHECK(xml_escaped(std::string_view("a\0b", 3)) == "a" + bad + "b");
}

TEST_CASE("long titles are cut at a character, short ones are not") {
  CHECK(shortened("groove", 6) == "groove");
  CHECK(shortened("grooves", 6) == "gro...");
  CHECK(shortened("\u00b5\u00b5\u00b5\u00b5\u00b5", 4) == "\u00b5...");
  CHECK(shortened("", 6).empty());
}

TEST_CASE("a short path is drawn point by point, with a gap at each rapid") {
  PathCurves curves(true);
  const auto add = [&](double s_mm, double value_mm, bool cutting) {
    Waypoint w = cut(0, 1, 1, Vector3(value_mm, 0, 0));
    w.s = s_mm * mm;
    w.p_MT.x() = s_mm * mm;
    w.cutting = cutting;
    curves.add(w, -1);
  };
  add(1, 0.1, true);
  add(2, 0.2, true);
  add(2, 0.9, false);
  add(3, 0.3, true);
  add(4, 0.4, true);
  const PlotColumns columns = plot_columns(curves, 100);
  REQUIRE(columns.single);
  const auto points = plot_points(curves, columns, Quantity::before_x);
  std::vector<double> places;
  for (const PlotPoint& p : points)
    if (p.begins) places.push_back(p.s_mm);
  REQUIRE(places.size() == 2);
  CHECK(places[0] == doctest::Approx(1));
  CHECK(places[1] > 1.5);
  CHECK(count_of(path_data(points, true, {0, 1}, {0, 1}), "M") == 2);
  CHECK(contains(to_svg(curves, report_of_made_up()), "interrupted at rapids"));
  const PathCurves unbroken = path_with(5, [](std::size_t) { return 0.1; });
  CHECK_FALSE(contains(to_svg(unbroken, report_of_made_up()), "at rapids"));
}

TEST_CASE("curves are drawn through samples with unknown values") {
  PathCurves curves(true);
  for (int i = 0; i < 5; ++i) {
    Waypoint w = cut(0, 1, 1, Vector3(0.1, 0, 0));
    w.s = i * mm;
    w.between = i % 2 == 1;
    w.place = !w.between;
    curves.add(w, -1);
  }
  const auto points = before_x(curves, 100);
  REQUIRE(points.size() == 3);
  CHECK(count_of(path_data(points, true, {}, {}), "M") == 1);
  CHECK(plot_points(curves, plot_columns(curves, 100), Quantity::after).size() == 5);
}

TEST_CASE("a single place between two rapids is a dot") {
  CHECK(path_data({{.s_mm = 1, .least = 2, .largest = 2, .begins = true}}, true, {}, {}) == "M1.0 2.0h0.1");
}

TEST_CASE("no spike is lost for any length of path") {
  for (const std::size_t count : {500u, 3000u, 20000u, 100000u})
    for (const std::size_t spike : {std::size_t{1}, count / 3, count - 1}) {
      CAPTURE(count);
      CAPTURE(spike);
      const PathCurves curves = path_with(count, [&](std::size_t i) {
        return i == spike ? 7.0 : i + 1 == spike ? -5.0 : 0.0;
      });
      double least = 0, largest = 0;
      const auto points = before_x(curves, 700);
      for (const PlotPoint& p : points) {
        least = std::min(least, p.least);
        largest = std::max(largest, p.largest);
      }
      CHECK(points.size() <= 1400);
      CHECK(largest == doctest::Approx(7));
      CHECK(least == doctest::Approx(-5));
    }
}

TEST_CASE("the outline of a band follows the largest values and returns along the least") {
  const std::vector<PlotPoint> points = {{.s_mm = 1, .least = -1, .largest = 2, .begins = true},
                                         {.s_mm = 3, .least = 0, .largest = 4, .begins = false}};
  CHECK(path_data(points, false, {10, 2}, {0, -1}) == "M12.0 -2.0L16.0 -4.0L16.0 0.0L12.0 1.0Z");
  CHECK(path_data({}, false, {}, {}).empty());
}

TEST_CASE("the plot has three components with their causes, and the residual below its tolerance") {
  const RunReport report = report_of_made_up();
  const PathCurves curves = path_with(50, [](std::size_t i) { return 0.01 * static_cast<double>(i); });
  const std::string svg = to_svg(curves, report);
  for (const std::string words :
       {"made_up.ngc on Mill", "geometry alone", "load alone", "superposition", "acting together",
        "in x, \u00b5m", "in y, \u00b5m", "in z, \u00b5m", "tolerance 5.0 \u00b5m", "cutting path length, mm",
        "Model residual after", "off by up to 500.0 \u00b5m, in line 5"}) {
    CAPTURE(words);
    CHECK(contains(svg, words));
  }
  CHECK_FALSE(contains(svg, "gravity"));
  CHECK(count_of(svg, "stroke=\"#0072b2\"") == 4);  // geometry: the legend, and once in each panel
  CHECK(count_of(svg, "stroke=\"#e69f00\"") == 4);
  CHECK(svg == to_svg(curves, report));
}

TEST_CASE("the legend of a plot with all causes has rows that stay on the page") {
  RunReport report = report_of_made_up();
  report.sources->fixture = report.sources->gravity = report.sources->preloads = report.sources->load;
  const PathCurves curves = path_with(50, [](std::size_t i) { return 0.01 * static_cast<double>(i); });
  const std::string svg = to_svg(curves, report);
  for (const std::string words : {"fixture alone", "gravity alone", "preloads alone"})
    CHECK(contains(svg, words));
  CHECK(contains(svg, "<text x=\"116.0\" y=\"76.0\""));
  CHECK(contains(svg, "<text x=\"116.0\" y=\"94.0\""));
}

TEST_CASE("the caption has the distance between all causes together and the superposition") {
  // Made-up causes add up to three quarters of the deviation.
  const PathCurves curves = path_with(10, [](std::size_t i) { return i == 7 ? 0.4 : 0.1; });
  CHECK(contains(to_svg(curves, report_of_made_up()), "within 100.0 \u00b5m of the superposition"));
  const PathCurves still = path_with(10, [](std::size_t) { return 0.0; });
  CHECK(contains(to_svg(still, report_of_made_up()), "within 0.1 \u00b5m of the superposition"));
}

TEST_CASE("a prediction has no residual, a run without causes only the curve of all together") {
  const MadeUpRun run;
  RunReport report = predicted(run, made_up_waypoints());
  PathCurves curves(false);
  for (const Waypoint& w : made_up_waypoints()) curves.add(w, -1);
  const std::string svg = to_svg(curves, report);
  CHECK_FALSE(contains(svg, "residual"));
  CHECK_FALSE(contains(svg, "tolerance"));
  report.sources.reset();
  const std::string plain = to_svg(curves, report);
  CHECK(contains(plain, "acting together"));
  CHECK_FALSE(contains(plain, "superposition"));
}

TEST_CASE("lengths are in the units in which reports show them") {
  RunReport report = report_of_made_up();
  const PathCurves curves = path_with(50, [](std::size_t) { return 0.254; });
  report.units.revolute = true;
  CHECK(contains(to_svg(curves, report), "tolerance 0.0050 mm"));
  report.units.program = LengthUnit::inches;
  const std::string svg = to_svg(curves, report);
  CHECK(contains(svg, "tolerance 0.00020 inch"));
  CHECK(contains(svg, "cutting path length, inch"));
  CHECK(contains(svg, ">0.010</text>"));
}

TEST_CASE("steps of the force are lines, or a number if they would hide the curves") {
  PathCurves curves = path_with(50, [](std::size_t) { return 0.1; });
  const RunReport report = report_of_made_up();
  CHECK_FALSE(contains(to_svg(curves, report), "stroke-dasharray=\"1 3\""));
  for (int i = 0; i < 3; ++i) curves.add_force_step(10 * i);
  CHECK(count_of(to_svg(curves, report), "stroke-dasharray=\"1 3\"") == 12);
  for (int i = 0; i < 98; ++i) curves.add_force_step(30);
  const std::string svg = to_svg(curves, report);
  CHECK(count_of(svg, "stroke-dasharray=\"1 3\"") == 0);
  CHECK(contains(svg, "The force steps 101 times."));
}

TEST_CASE("a plot can be drawn without waypoints, without deviation, and with markup in names") {
  const MadeUpRun run;
  RunReport report = predicted(run, {}, Failure{ErrorKind::not_compensated, 4, "no <equilibrium>"});
  report.machine = "<script>alert(1)</script> & \x01";
  const std::string nothing = to_svg(PathCurves(false), report);
  CHECK(contains(nothing, "no &lt;equilibrium&gt;"));
  CHECK_FALSE(contains(nothing, "<script"));
  for (const std::string& svg :
       {nothing, to_svg(path_with(5, [](std::size_t) { return 0.0; }), report_of_made_up())}) {
    CHECK(svg.starts_with("<svg "));
    CHECK(svg.ends_with("</g>\n</svg>\n"));
    CHECK_FALSE(contains(svg, "nan"));
    CHECK_FALSE(contains(svg, "inf"));
  }
}
