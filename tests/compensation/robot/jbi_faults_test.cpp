// Faults in jobs of Yaskawa that the seeded ones do not have.
#include <doctest/doctest.h>

#include <algorithm>
#include <regex>

#include "compensation/robot/written_programs.hpp"
#include "compensation/support/arm.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Order jbi_order(const std::string& text) {
  Order order{.machine = arm_machine(), .text = text};
  order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  order.X_MW = translation({1.7, 0, 0.6});
  order.read.dialect = "yaskawa";
  return order;
}

std::string exchanged(const std::string& text, const std::string& one, const std::string& other) {
  return replaced(replaced(replaced(text, one, "?\n"), other, one), "?\n", other);
}

std::string failure_of_job(const Shop& shop, const std::string& text) {
  try {
    const auto failure = verify(shop.job(), read_program(text, "corrected", shop.read), false).failure;
    return failure ? failure->what : "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

namespace {

/// The largest deviation inside of the circle, whose MOVC ends in this line, across its plane (mm).
double miss_of_circle(const Shop& shop, const std::string& text, int line) {
  const Vector3 normal = Vector3(30, 30, -5).cross(Vector3(60, 0, -5)).normalized();
  double largest = 0;
  const Program program = read_program(text, "corrected", shop.read);
  for (const Waypoint& w : verify(shop.job(), program, false).waypoints)
    if (w.line == line) largest = std::max(largest, std::abs(normal.dot(w.after.head<3>())) / mm);
  return largest;
}

}  // namespace

TEST_CASE("the point inside of a circle is at the height of the corrected circle there") {
  const std::string source = jbi_text();
  const Shop shop(jbi_order(source));
  const std::string text = compensated(shop).text;
  const std::string_view before = std::string_view(source).substr(0, source.find("FPT"));
  const int line = 1 + static_cast<int>(std::ranges::count(before, '\n'));
  const double miss = miss_of_circle(shop, text, line);
  CHECK(miss > 0);
  CHECK(miss < 0.0015);  // digits of 0.001 mm
  const std::regex point("(\nC[0-9]{5}=(?:89|90)\\.[0-9]+,(?:89|90)\\.[0-9]+),(-?[0-9.]+)");
  std::smatch place;
  REQUIRE(std::regex_search(text, place, point));
  for (const double off : {0.03, -0.03}) {
    const std::string changed = place.prefix().str() + place[1].str() +
                                fmt::format(",{:.3f}", std::stod(place[2]) + off) + place.suffix().str();
    CHECK(miss_of_circle(shop, changed, line) > 0.02);
  }
}

TEST_CASE("values of targets in pulses must not be exchanged") {
  const std::string one = "=1000,2000,3000,0,-4000,0\n", other = "=1000,9000,3000,0,-4000,0\n";
  std::string source = replaced(jbi_text(), "NPOS 8,8", "NPOS 10,8");
  source = replaced(source, "BC00000=", "C00008" + one + "C00009" + other + "BC00000=");
  source = replaced(source, "MOVJ P00100", "MOVJ C00008 VJ=25.00\nMOVJ C00009 VJ=25.00\nMOVJ P00100");
  const Shop shop(jbi_order(source));
  const std::string text = compensated(shop).text;
  REQUIRE(failure_of_job(shop, text) == "");
  CHECK(failure_of_job(shop, exchanged(text, one, other)) != "");
}

TEST_CASE("configurations of two positions must not be exchanged") {
  const std::string one = "///RCONF 1,0,0,0,0,0,0,0\n", other = "///RCONF 0,0,0,0,0,0,0,0\n";
  std::string source = jbi_text();
  source.insert(source.find("C00003="), other);
  const Shop shop(jbi_order(source));
  const std::string text = compensated(shop).text;
  REQUIRE(failure_of_job(shop, text) == "");
  CHECK(failure_of_job(shop, exchanged(text, one, other)) != "");
  CHECK(failure_of_job(shop, replaced(text, "RCONF 1,0,0", "RCONF 1,1,0")) != "");
  CHECK(failure_of_job(shop, replaced(text, "RCONF 1,0,0,0", "RCONF 0,0,1,0")) != "");
}

namespace {

std::string line_at(const std::string& text, const std::string& begin) {
  const std::size_t at = text.find("\n" + begin) + 1;
  REQUIRE(at > 0);
  return text.substr(at, text.find('\n', at) + 1 - at);
}

/// `text` with the line that begins with `line` before the one that begins with `before`.
std::string moved(const std::string& text, const std::string& line, const std::string& before) {
  const std::string whole = line_at(text, line);
  std::string rest = replaced(text, whole, "");
  return rest.insert(rest.find("\n" + before) + 1, whole);
}

}  // namespace

TEST_CASE("steps to pulses must not be exchanged, and their values must not change") {
  std::string source = replaced(jbi_text(), "NPOS 8,8", "NPOS 10,8");
  source = replaced(source,
                    "BC00000=", "C00008=1000,2000,3000,0,-4000,0\nC00009=1000,9000,3000,0,-4000,0\nBC00000=");
  source = replaced(source, "MOVJ P00100", "MOVJ C00008 VJ=25.00\nMOVJ C00009 VJ=25.00\nMOVJ P00100");
  const Shop shop(jbi_order(source));
  const std::string text = compensated(shop).text;
  CHECK(failure_of_job(shop, text) == "");
  const std::regex steps("(\nMOVJ C[0-9]+)( VJ=25.00)(\nMOVJ C[0-9]+)( VJ=25.00\nMOVJ)");
  REQUIRE(std::regex_search(text, steps));
  CHECK(failure_of_job(shop, std::regex_replace(text, steps, "$3$2$1$4")) != "");
  CHECK(failure_of_job(shop, std::regex_replace(text, steps, "$1$2$1$4")) != "");
  CHECK(failure_of_job(shop, replaced(text, "=1000,9000", "=1000,9100")) != "");
}

TEST_CASE("a position must not be moved under other pseudo instructions") {
  std::string source = jbi_text();
  source.insert(source.find("C00003="), "///RCONF 0,0,0,0,0,0,0,0\n");
  const Shop shop(jbi_order(source));
  const std::string text = compensated(shop).text;
  CHECK(failure_of_job(shop, text) == "");
  for (const char* place : {"///RCONF 1", "///POSTYPE PULSE"}) {
    CAPTURE(place);
    CHECK(failure_of_job(shop, moved(text, "C00000=", place)) != "");
  }
}

TEST_CASE("a step in a condition keeps the values of its position, which another step corrects") {
  const std::string source = replaced(jbi_text(), "MOVJ P00100",
                                      "IFTHENEXP B001=1\n\tMOVJ C00007 BC00007 VJ=25.00\nENDIF\nMOVJ P00100");
  const Shop shop(jbi_order(source));
  const std::string text = compensated(shop).text;
  CHECK(failure_of_job(shop, text) == "");
  const std::regex step("(IFTHENEXP B001=1\n\tMOVJ )(C[0-9]+)");
  std::smatch found;
  REQUIRE(std::regex_search(text, found, step));
  CHECK(line_at(text, found[2].str() + "=").ends_with("=100.000,120.000,30.000,5.0000,0.0000,20.0000\n"));
  CHECK(failure_of_job(shop, std::regex_replace(text, step, "$1C00001")) != "");
}
