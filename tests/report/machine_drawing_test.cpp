#include "counterflex/report/machine_drawing.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <regex>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "report/plot/drawn_parts.hpp"

using namespace counterflex;

namespace {

struct Drawn {
  Machine machine;
  Model model;
};

Drawn made(MachineKind kind, const std::string& robot = "ur10") {
  MachineFacts facts;
  facts.kind = kind;
  facts.robot = robot;
  Machine machine = read_machine(machine_file(facts), "made.toml");
  Model model = prepare(machine);
  return {std::move(machine), std::move(model)};
}

std::vector<DrawnPart> of_kind(const std::vector<DrawnPart>& parts, DrawnKind kind) {
  std::vector<DrawnPart> some;
  std::copy_if(parts.begin(), parts.end(), std::back_inserter(some),
               [&](const DrawnPart& p) { return p.kind == kind; });
  return some;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("the axes of a drawn robot are where its lengths put them at home") {
  const Drawn kuka = made(MachineKind::robot6r, "kuka-kr270-r2700-ultra");
  const auto axes = of_kind(drawn_parts(kuka.machine, kuka.model), DrawnKind::rotary_axis);
  REQUIRE(axes.size() == 6);
  CHECK(axes[1].name == "A2");
  CHECK((axes[1].at - Vector3(0.35, 0, 0.675)).norm() < 1e-12);
  // A2 = -80: the upper arm leans 10 degrees forward.
  const Vector3 elbow(0.35 + 1.15 * std::sin(10 * deg), 0, 0.675 + 1.15 * std::cos(10 * deg));
  CHECK((axes[2].at - elbow).norm() < 1e-12);
}

TEST_CASE("the legs of a drawn hexapod end at the same platform, and its drives are on their lines") {
  const Drawn hexapod = made(MachineKind::hexapod);
  const auto drives = of_kind(drawn_parts(hexapod.machine, hexapod.model), DrawnKind::linear_axis);
  REQUIRE(drives.size() == 6);
  for (const DrawnPart& drive : drives) {
    CHECK(drive.name.starts_with("leg"));
    CHECK(drive.at.z() == doctest::Approx(1.5));  // at the base
    CHECK(drive.at.head<2>().norm() == doctest::Approx(0.6));
  }
}

TEST_CASE("springs in the branches of parallelograms are drawn at the ends of their bars") {
  const Drawn delta = made(MachineKind::delta);
  const auto springs = of_kind(drawn_parts(delta.machine, delta.model), DrawnKind::spring);
  CHECK(springs.size() == 9);  // a drive and two bars for each rail
  for (const DrawnPart& spring : springs)
    if (spring.name == "bar") CHECK(std::abs(spring.at.z()) < 1e-9);  // at the height of the platform
}

TEST_CASE("a drawing has each part in each of its three views, inside of the picture") {
  for (const KindOfMachine& kind : kinds_of_machine) {
    CAPTURE(kind.name);
    const Drawn drawn = made(kind.kind);
    const std::string svg = machine_drawing(drawn.machine, drawn.model);
    const auto parts = drawn_parts(drawn.machine, drawn.model);
    const std::size_t masses = of_kind(parts, DrawnKind::mass).size(),
                      springs = of_kind(parts, DrawnKind::spring).size();
    CHECK(count(svg, "fill=\"#7c2d12\"") == 3 * masses + 1);  // and one of the legend
    CHECK(count(svg, "stroke=\"#15803d\"") == 3 * springs + 1);
    CHECK(count(svg, "tip</text>") >= 3);
    const std::regex place("(?:x|cx)=\"(-?[0-9.]+)\" (?:y|cy)=\"(-?[0-9.]+)\"");
    for (std::sregex_iterator at(svg.begin(), svg.end(), place), end; at != end; ++at) {
      CHECK(std::stod((*at)[1]) >= 0);
      CHECK(std::stod((*at)[1]) <= 1220);
      CHECK(std::stod((*at)[2]) <= 522);
    }
  }
}

TEST_CASE("a name with characters of XML is escaped in a drawing") {
  Drawn drawn = made(MachineKind::mill3);
  drawn.machine.name = "<mill> & \"co\"";
  const std::string svg = machine_drawing(drawn.machine, drawn.model);
  CHECK(svg.find("<mill>") == std::string::npos);
  CHECK(svg.find("&lt;mill&gt; &amp;") != std::string::npos);
}

TEST_CASE("springs of one name have one label in each view") {
  const Drawn hexapod = made(MachineKind::hexapod);
  CHECK(count(machine_drawing(hexapod.machine, hexapod.model), ">strut<") == 3);
}
