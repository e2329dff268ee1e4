// Machines whose deviation is known in closed form: none, a shift, a shear.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const part =
    "%\n(PART)\nN10 G21 G90 G94\nN20 G0 X10. Y-20. Z30.\nN30 G0 Z2.\nN40 G1 Z-1.5 F200\nN50 X110.25 F600\n"
    "N60 Y130.\nN70 G1 X-90. Y-80. Z12.\nN80 G0 Z50.\nN90 M30\n%\n";

}  // namespace

TEST_CASE("a perfect machine without forces gives back every byte") {
  const std::string text = read_file(groove);
  const std::string without_force = text.substr(0, text.find("(FORCE FX")) + text.substr(text.find("N50"));
  for (const std::string& program : {without_force, std::string(part)})
    for (const Method method : {Method::direct, Method::nested, Method::linear}) {
      const Shop shop({.machine = load_machine(orthoglide_perfect), .text = program, .method = method});
      const Compensation result = compensated(shop);
      CHECK(result.text == program);
      CHECK(result.counts.changed_words == 0);
      CHECK(result.counts.inserted_blocks == 0);
    }
}

TEST_CASE("a perfect machine without forces gives back lines that end in CR LF, without a last one") {
  const std::string text = "g21 g90\r\ng0 x1.0005y2z-3.\r\n\r\n G1 x 4.25 F100 ; caf\xe9\r\nm30";
  const Shop shop({.machine = load_machine(orthoglide_perfect), .text = text});
  CHECK(compensated(shop).text == text);
}

TEST_CASE("a rigid gantry that is displaced is sent back by exactly the displacement") {
  const Shop shop({.machine = displaced_gantry(), .text = part});
  const Compensation result = compensated(shop);
  CHECK(result.counts.inserted_blocks == 0);
  const std::vector<Move> before = moves_in(part), after = moves_in(result.text);
  REQUIRE(before.size() == after.size());
  for (std::size_t m = 0; m < before.size(); ++m) {
    CAPTURE(before[m].line);
    CHECK((after[m].end_mm - before[m].end_mm - Vector3(-0.5, 0.25, -0.125)).norm() < 1e-9);
  }
  CHECK(largest_correction(result.waypoints).size == doctest::Approx(Vector3(0.5, 0.25, 0.125).norm() * mm));
}

TEST_CASE("out of square axes are corrected by the inverse of their affine map, without points") {
  for (const double sign : {1.0, -1.0}) {
    CAPTURE(sign);
    const double angle = sign * 1e-3;
    const Shop shop({.machine = rigid_gantry("0, 0, 0", angle), .text = part});
    const Compensation result = compensated(shop);
    CHECK(result.counts.inserted_blocks == 0);
    const std::vector<Move> before = moves_in(part), after = moves_in(result.text);
    REQUIRE(before.size() == after.size());
    for (std::size_t m = 0; m < before.size(); ++m) {
      CAPTURE(before[m].line);
      // Reached (x - y sin a, y cos a, z) for commanded (x, y, z).
      const Vector3& p = before[m].end_mm;
      const double y = p.y() / std::cos(angle);
      const Vector3 expected(p.x() + y * std::sin(angle), y, p.z());
      CHECK((after[m].end_mm - expected).cwiseAbs().maxCoeff() <= 0.5e-3 + 1e-9);
    }
  }
}

TEST_CASE("a work offset turns the correction into program coordinates") {
  const Pose X_MW{from_rpy(Vector3(0, 0, 90) * deg), Vector3(50, 20, 0) * mm};
  const Shop shop({.machine = displaced_gantry(), .text = part, .X_MW = X_MW});
  const std::vector<Move> before = moves_in(part), after = moves_in(compensated(shop).text);
  REQUIRE(before.size() == after.size());
  for (std::size_t m = 0; m < before.size(); ++m)
    CHECK((after[m].end_mm - before[m].end_mm - Vector3(0.25, 0.5, -0.125)).norm() < 1e-9);
}

TEST_CASE(
    "words that round to their originals are untouched, others are inserted only where rounding needs "
    "them") {
  // A tilt of Z against X alone: x moves by 1 µm for each mm of z.
  const Shop shop({.machine = rigid_gantry("0, 0, 0", 0, 1e-3),
                   .text = "G21 G90\nG0 X0. Y0. Z0.\nG1 Z-0.4 F100\nG1 Z-40.\nX10.\nG1 Y5.\nZ0.\nM30\n"});
  const std::vector<std::string> lines = lines_of(compensated(shop).text);
  CHECK(lines[1] == "G0 X0. Y0. Z0.");
  CHECK(lines[2] == "G1 Z-0.4 F100");
  CHECK(lines[3] == "G1 Z-40. X0.040");
  CHECK(lines[4] == "X10.04");
  CHECK(lines[5] == "G1 Y5.");
  CHECK(lines[6] == "Z0. X10.000");
}
