// Points that are inserted into a line of a robot leave the zones at its ends as they are, if the line has
// room for both.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <regex>

#include "compensation/support/arm.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

struct RapidLine {
  Vector3 p_mm;
  std::string zone;
};

/// The targets of MoveL, in their order.
std::vector<RapidLine> rapid_lines_in(const std::string& text) {
  const std::string n = "(-?[0-9.]+)";
  const std::regex pattern("MoveL \\[\\[" + n + "," + n + "," + n +
                           "\\][^\\n]*,v[0-9]+,(z[0-9]+|\\[[^\\]]*\\]),t");
  std::vector<RapidLine> targets;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    targets.push_back({{std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3])}, (*at)[4]});
  return targets;
}

/// A line of 500 mm from a target with zone z10 to one with this zone, corrected.
std::vector<RapidLine> corrected_line(const std::string& zone, double tolerance) {
  const auto target = [&](double x, double y, const std::string& of_target) {
    return fmt::format(
        "[[{:.3f},{:.3f},600.000],[1.000000,0.000000,0.000000,0.000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],"
        "v20,{},t;\n",
        x, y, of_target);
  };
  Order order{.machine = arm_machine(),
              .text = "MODULE part\nPROC main()\n ConfL\\Off;\n ConfJ\\Off;\n MoveJ " +
                      target(1600, -200, "z1") + " MoveL " + target(1600, -250, "z10") + " MoveL " +
                      target(1900, 150, zone) + " MoveL " + target(1900, 200, "z1") + "ENDPROC\nENDMODULE\n"};
  order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  order.tolerance = tolerance;
  order.read.dialect = "abb";
  const std::vector<RapidLine> targets = rapid_lines_in(compensated(Shop(order)).text);
  REQUIRE(targets.size() == 5);  // one before the force is at its full size, one on the long line
  return targets;
}

double zone_length(const RapidLine& target) {
  return std::stod(target.zone.substr(1));
}

}  // namespace

TEST_CASE("a point is inserted two zones away from the target of a long line, and the zone stays") {
  for (const std::string zone : {"z10", "z100", "z150"}) {
    CAPTURE(zone);
    const std::vector<RapidLine> targets = corrected_line(zone, 8e-6);
    const RapidLine &inserted = targets[2], &end = targets[3];
    CHECK(end.zone == zone);
    CHECK((end.p_mm - inserted.p_mm).norm() >= 2 * zone_length(end) - 1e-3);
    CHECK((targets[1].p_mm - inserted.p_mm).norm() >= 2 * zone_length(targets[1]));
  }
}

TEST_CASE("where a point must be inserted within two zones of a target the zone becomes smaller") {
  const std::vector<RapidLine> targets = corrected_line("z200", 5e-6);
  CHECK(targets[3].zone != "z200");
  CHECK((targets[3].p_mm - targets[2].p_mm).norm() >= 2 * zone_length(targets[3]));
}
