// Holes: each has the correction of its own bottom.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const holes =
    "G21 G90 G17\nG0 X0. Y0. Z20.\nG99 G81 X10. Y100. Z-12. R2. F100\nX20. Y-100.\nY50.\nG80\nG0 Z20.\nM30\n";

}  // namespace

TEST_CASE("each hole is shifted by the correction at its bottom, and its words follow") {
  const double angle = 1e-3;
  const Compensation result = compensated(Shop({.machine = rigid_gantry("0, 0, 0.1", angle), .text = holes}));
  const std::vector<Move> before = moves_in(holes), after = moves_in(result.text);
  REQUIRE(before.size() == after.size());
  int count = 0;
  for (std::size_t m = 0; m < before.size(); ++m) {
    if (!before[m].cycle) continue;
    CAPTURE(before[m].line);
    REQUIRE(after[m].cycle);
    const Vector3& p = before[m].end_mm;
    const double y = p.y() / std::cos(angle);
    CHECK(std::abs(after[m].end_mm.x() - p.x() - y * std::sin(angle)) <= 0.5e-3 + 1e-9);
    CHECK(std::abs(after[m].end_mm.y() - y) <= 0.5e-3 + 1e-9);
    CHECK(std::abs(after[m].cycle->bottom_mm + 12.1) < 1e-9);
    CHECK(std::abs(after[m].cycle->retract_mm - 1.9) < 1e-9);
    ++count;
  }
  CHECK(count == 3);
  CHECK(result.text.find("Z-12.1") == result.text.rfind("Z-12.1"));  // the bottom is sticky
}

TEST_CASE("a hole whose bottom misses is found by the verification: holes are judged at their bottom") {
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = holes}));
  int judged = 0;
  for (const Waypoint& w : result.waypoints) judged += w.segment == no_segment && w.p_MT.z() < 0;
  CHECK(judged == 3);
}

TEST_CASE("holes of a relative cycle keep the correction with which the cycle is entered") {
  const std::string text =
      "G21 G90\nG0 X0. Y0. Z20.\nG91 G99 G81 X10. Z-12. R-15. F100 L3\nG80\nG90\nG0 Z20.\nX0. Y0.\nM30\n";
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = text}));
  CHECK(lines_of(result.text)[2] == lines_of(text)[2]);
  CHECK((moves_in(result.text).back().end_mm - shift_mm - Vector3(0, 0, 20)).norm() < 1e-9);
}

// The tool is 50 mm above the surface when the cycle is called: there the correction of this machine is 0.05
// mm in X.
TEST_CASE(
    "klartext: a hole that CYCL CALL or M89 drills is corrected at its surface, not at the clearance "
    "height") {
  const std::string text =
      "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nCYCL DEF 200 DRILLING ~\nQ200=2 ~\nQ201=-10 ~\nQ203=+0 "
      "~\nQ204=50\n"
      "L X+10 Y+10 Z+50 R0 FMAX\nCYCL CALL\nL X+20 R0 FMAX\nCYCL CALL\nL X+30 R0 FMAX M89\nL X+35 R0 FMAX\n"
      "L X+40 R0 FMAX M99\nL Z+100 R0 FMAX M30\nEND PGM A MM\n";
  const double lean = 1e-3;
  const Compensation result = compensated(Shop({.machine = rigid_gantry("0, 0, 0", 0, lean), .text = text}));
  CAPTURE(result.text);
  std::size_t holes = 0;
  for (const Move& move : moves_in(result.text)) {
    if (!move.makes_hole) {
      CHECK(std::abs(move.end_mm.x() - std::round(move.end_mm.x())) <= 0.1 + 1e-9);
      continue;
    }
    ++holes;
    CAPTURE(move.line);
    CHECK(std::abs(move.end_mm.x() - std::round(move.end_mm.x())) <= 1e-9);
    CHECK(move.end_mm.z() == 0);
  }
  CHECK(holes == 5);
  CHECK(result.text.find("L X+9.95 Y+10 Z+50") != std::string::npos);
}

TEST_CASE("a perfect machine gives back programs with cycles byte for byte") {
  CHECK(compensated(Shop({.machine = perfect_gantry(), .text = holes})).text == holes);
}

// Behind G99 LinuxCNC goes at Z50 if R is not below the tool, else at the height of the tool. The plane X Y
// is turned about Y: the second hole is deeper in the words than the first one.
TEST_CASE("linuxcnc: behind a hole under G99, R of one under G98 is above the tool as in the original") {
  Machine machine = perfect_gantry();
  std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(0, -4e-4, 0));
  for (const std::string second : {"G98 G81 X90. Y10. Z-5. R2.", "G98 X90. R2.", "G98 X90. R2.0000"}) {
    CAPTURE(second);
    const std::string begin = "G21 G90 G17\nG0 X0. Y0. Z50.\nG99 G81 X10. Y10. Z-5. R2. F100\n",
                      text = begin + second + "\nX95.\nG80\nM2\n";
    const Shop shop({.machine = machine, .text = text});
    const std::string corrected = compensated(shop).text;
    const std::vector<Move> moves = moves_in(corrected);
    CHECK(moves[1].cycle->retract_mm - 2 > -0.01);
    CHECK(moves[2].cycle->bottom_mm + 5 < -0.03);
    CHECK(moves[2].cycle->retract_mm >= moves[2].start_mm.z());
    CHECK(moves[2].cycle->retract_mm < moves[2].start_mm.z() + 1e-3);
    CHECK(refusal_of(shop, corrected) == "");
    std::string lower = corrected;
    const std::size_t r = lower.rfind(" R");
    lower.replace(r, lower.find_first_of(" \n", r + 1) - r, " R1.96");
    CHECK(refusal_of(shop, lower).find("LinuxCNC goes to this hole at another height") != std::string::npos);
  }
  // Other controls go at the height of the tool in any case.
  const Shop fanuc({.machine = machine,
                    .text = "%\nO1\nG21 G90 G17\nG0 X0. Y0. Z50.\nG99 G81 X10. Y10. Z-5. R2. F100\nG98 X90. "
                            "R2.\nG80\nM30\n%\n"});
  const std::vector<Move> moves = moves_in(compensated(fanuc).text);
  CHECK(moves[2].cycle->retract_mm - moves[2].cycle->bottom_mm == doctest::Approx(7));
}

TEST_CASE("linuxcnc: R at the height of the tool stays there, so that G98 and G99 need not be programmed") {
  for (const double tilt : {-4e-4, 4e-4})
    for (const std::string further :
         {"", "X95. R2.\n", "X5.\nX95.\n", "X5. R2.\nX95. R2.\n", "X5. R3.\nX95.\n"}) {
      CAPTURE(tilt);
      CAPTURE(further);
      Machine machine = perfect_gantry();
      std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(0, tilt, 0));
      const Shop shop({.machine = machine,
                       .text = "G21 G90 G17\nG0 X10. Y10. Z2.\nG81 X90. Z-5. R2. F100\n" + further +
                               "G80\nG0 X0.\nM2\n"});
      const std::string corrected = compensated(shop).text;
      CHECK(refusal_of(shop, corrected) == "");
      const std::vector<Move> moves = moves_in(corrected);
      CHECK(moves[1].cycle->retract_mm >= moves[1].start_mm.z());
      CHECK(std::abs(moves[1].cycle->bottom_mm + 5) > 0.03);
      CHECK(moves.back().known_start[2]);
    }
}

// Without G98 and G99 the height behind the first hole is not known.
TEST_CASE("linuxcnc: a hole behind an unknown height keeps words that need no correction") {
  const Shop shop({.machine = rigid_gantry("0, 0, 0.1", 1e-3),
                   .text = "G21 G90 G17\nG0 X10. Y100. Z20.\nG81 X10. Y100. Z-10. R2. F100\n"
                           "G81 X20. Y0. Z-10. R2.\nX30. Y100.\nG80\nM2\n"});
  const std::string corrected = compensated(shop).text;
  const auto lines = lines_of(corrected);
  CHECK(lines[2] == "G81 X10.1 Y100. Z-10.1 R1.9 F100");
  CHECK(lines[3] == "G81 X20. Y0. Z-10.1 R1.9");
  CHECK(lines[4] == "X30.1 Y100.");
  CHECK(refusal_of(shop, corrected) == "");
  std::string without = corrected;
  without.replace(without.find("X30.1"), 5, "X30.");
  CHECK(refusal_of(shop, without).find("misses the path by 0.1") != std::string::npos);
}

// G98 leaves the tool at R, which is the height where the series began, though the tool comes from a lower R.
TEST_CASE("linuxcnc: R at the height of the series stays there, also behind a hole under G99") {
  for (const double tilt : {-4e-4, 4e-4})
    for (const std::string at_start : {"G98 X90. R30.\n", "G98 X90. Z-6. R30.\n", "G98 X5. Z-6. R30.\n"}) {
      CAPTURE(tilt);
      CAPTURE(at_start);
      Machine machine = perfect_gantry();
      std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(0, tilt, 0));
      const Shop shop({.machine = machine,
                       .text = "G21 G90 G17\nG0 X50. Y10. Z30.\nG99 G81 X20. Z-5. R2. F100\n" + at_start +
                               "G99 X20.\nX50. R2.\nG80\nG0 X0.\nM2\n"});
      const std::string corrected = compensated(shop).text;
      CAPTURE(corrected);
      CHECK(refusal_of(shop, corrected) == "");
      const std::vector<Move> moves = moves_in(corrected);
      CHECK(moves[2].cycle->retract_mm >= moves[2].cycle->initial_mm);
      CHECK(moves[2].cycle->retract_mm < moves[2].cycle->initial_mm + 0.04);
    }
}
