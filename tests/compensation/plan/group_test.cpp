// Contours under G41 and G42: one shift, so that the tool's offset still works.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const contour =
    "G21 G90 G17\nG0 X-20. Y-20. Z10.\nG0 X-10. Y-12.\nZ2.\nG1 Z-3. F200\nG41 D1 X0. Y0.\nY80.\nG2 X10. Y90. "
    "I10. "
    "J0.\nG1 X100.\nY0.\nX-5.\nG40 X-10. Y-12.\nG0 Z10.\nX120. Y50.\nM30\n";

}  // namespace

TEST_CASE("a contour group has one shift, the midpoint of its corrections' extremes, and nothing inserted") {
  const double angle = 1e-3;
  const Compensation result = compensated(Shop({.machine = rigid_gantry("0, 0, 0", angle), .text = contour}));
  const std::vector<Move> before = moves_in(contour), after = moves_in(result.text);
  REQUIRE(before.size() == after.size());
  int grouped = 0;
  // X is off by -y times the angle, for y between -12 and 90.
  const Vector3 expected(39 * angle, 0, 0);
  for (std::size_t m = 0; m < before.size(); ++m) {
    if (before[m].group == 0) continue;
    CAPTURE(before[m].line);
    CHECK((after[m].end_mm - before[m].end_mm - expected).cwiseAbs().maxCoeff() <= 1e-3);
    ++grouped;
  }
  CHECK(grouped >= 10);
  CHECK(result.other_moves.grouped == static_cast<std::size_t>(grouped));
  CHECK(result.corrected_moves + result.other_moves.grouped == before.size());
  CHECK(result.counts.inserted_blocks == 0);
  REQUIRE(!result.left_alone.empty());
  CHECK(result.left_alone[0].line == 3);
  CHECK(result.left_alone[0].why.find("contour group") != std::string::npos);
  CHECK(result.left_alone[0].why.find("0.051") != std::string::npos);
}

TEST_CASE("a constant shift moves a contour group as a whole, its arcs with the same I and J") {
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = contour}));
  const std::vector<Move> before = moves_in(contour), after = moves_in(result.text);
  REQUIRE(before.size() == after.size());
  for (std::size_t m = 0; m < before.size(); ++m)
    CHECK((after[m].end_mm - before[m].end_mm - shift_mm).norm() < 1e-9);
  CHECK(result.text.find("I10. J0.") != std::string::npos);
}

TEST_CASE("a contour group turns with a machine that is turned about Z, its arcs with their centres") {
  const double turn = 2e-3;
  const Shop shop({.machine = rigid_gantry("0.5, -0.25, 0.125", 0, 0, turn), .text = contour});
  const Compensation result = compensated(shop);
  const std::vector<Move> before = moves_in(contour), after = moves_in(result.text);
  REQUIRE(before.size() == after.size());
  const Matrix3 R = exp_so3(Vector3(0, 0, -turn));
  const auto moved = [&](const Vector3& p) -> Vector3 { return R * (p + shift_mm); };
  for (std::size_t m = 0; m < before.size(); ++m) {
    CAPTURE(before[m].line);
    CHECK((after[m].end_mm - moved(before[m].end_mm)).cwiseAbs().maxCoeff() <= 1.5e-3);
    REQUIRE(after[m].arc.has_value() == before[m].arc.has_value());
    if (before[m].arc)
      CHECK((after[m].arc->centre_mm - moved(before[m].arc->centre_mm)).cwiseAbs().maxCoeff() <= 2e-3);
  }
  CHECK(result.counts.inserted_blocks == 0);
  CHECK(result.left_alone[0].why.find("one turn by -0.1146 deg") != std::string::npos);
  CHECK(result.left_alone[0].why.find("is up to 0.0000 mm") != std::string::npos);
  CHECK(refusal_of(shop, result.text) == "");
}

TEST_CASE("a contour with a word that cannot be written keeps one shift on a turned machine") {
  const std::string fixed =
      "G21 G90 G17\nG0 X-20. Y-20. Z10.\nG0 X-10. Y-12.\nZ2.\nG1 Z-3. F200\nG41 D1 X0. Y0.\nY80.\nG43 H1 "
      "X100.\n"
      "Y0.\nX-5.\nG40 X-10. Y-12.\nG0 Z10.\nX120. Y50.\nM30\n";
  const Compensation result =
      compensated(Shop({.machine = rigid_gantry("0, 0, 0", 0, 0, 2e-3), .text = fixed}));
  CHECK(result.left_alone[0].why.find("turn") == std::string::npos);
}

TEST_CASE("an arc of a contour whose radius is changed is refused") {
  const Shop shop({.machine = rigid_gantry("0, 0, 0", 0, 0, 2e-3), .text = contour});
  std::string text = compensated(shop).text;
  const std::size_t at = text.find("I10.");
  REQUIRE(at != std::string::npos);
  CHECK_FALSE(refusal_of(shop, text.replace(at, 4, "I10.2")).empty());
}

TEST_CASE("a word of a contour that is not shifted with the others is refused, along its move and across") {
  const Shop shop({.machine = displaced_gantry(), .text = contour});
  const std::string text = compensated(shop).text;
  const auto refusal_with = [&](const std::string& written, const std::string& left) {
    const std::size_t at = text.find(written);
    REQUIRE(at != std::string::npos);
    std::string changed = text;
    changed.replace(at, text.find_first_of(" \n", at) - at, left);
    return refusal_of(shop, changed);
  };
  CHECK(refusal_with("X99.5", "X100.").find("contours are shifted and turned as a whole") !=
        std::string::npos);
  CHECK(refusal_with("Y80.25", "Y80.") != "");  // an arc follows, whose radius is no longer the same
}

namespace {

const char* const circle =
    "G21 G90 G17\nG0 X-20. Y-20. Z10.\nG0 X-10. Y-12.\nZ2.\nG1 Z-3. F200\nG41 D1 X0. Y0.\nG1 X40.\nG3 I0. "
    "J40.\n"
    "G1 X60.\nG40 X-10. Y-12.\nG0 Z10.\nM30\n";

// Its X Y plane is turned about Y.
Machine tilted_gantry() {
  Machine machine = perfect_gantry();
  std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(0, 4e-4, 0));
  return machine;
}

}  // namespace

TEST_CASE("an arc of a contour on a machine that is tilted follows its height in arcs about one centre") {
  const Shop shop({.machine = tilted_gantry(), .text = circle});
  const Compensation result = compensated(shop);
  const std::vector<Move> arcs = arcs_in(result.text);
  CHECK(arcs.size() == 8);
  for (const Move& arc : arcs) {
    CHECK((arc.arc->centre_mm - arcs[0].arc->centre_mm).head<2>().norm() <= 2e-3);
    CHECK(std::abs((arc.end_mm - arc.arc->centre_mm).head<2>().norm() - 40) <= 2e-3);
  }
  CHECK(refusal_of(shop, result.text) == "");
}

TEST_CASE("a flat arc of a contour in Klartext is arcs of one centre with lines along Z between them") {
  const std::string klartext =
      "0 BEGIN PGM P MM\n1 TOOL CALL 1 Z S1000\n2 L X-20 Y-12 Z+10 R0 FMAX\n3 L Z-3 F200\n4 L X+0 Y+0 RL\n5 "
      "L X+40\n"
      "6 CC X+40 Y+40\n7 C X+40 Y+80 DR+\n8 L X+20\n9 L X-20 R0\n10 L Z+10 FMAX\n11 END PGM P MM\n";
  const Shop shop({.machine = tilted_gantry(), .text = klartext});
  const Compensation result = compensated(shop);
  CHECK(arcs_in(result.text).size() >= 4);
  CHECK(refusal_of(shop, result.text) == "");
}

TEST_CASE(
    "the arc with which a contour is entered, and one whose block has a word that acts at its end, are not "
    "divided") {
  const auto pieces = [](const std::string& blocks) {
    const std::string text =
        "G21 G90 G17\nG0 X-20. Y-20. Z10.\nG0 X-10. Y-12.\nG1 Z-3. F200\n" + blocks + "G0 Z10.\nM30\n";
    return arcs_in(compensated(Shop({.machine = tilted_gantry(), .text = text})).text).size();
  };
  CHECK(pieces("G41 D1\nG3 X70. Y-12. I40. J0.\nG1 X80.\nG40 X90.\n") == 1);
  CHECK(pieces("G41 D1 X0. Y0.\nG3 X80. Y0. I40. J0. M9\nG1 X90.\nG40 X95.\n") == 1);
  CHECK(pieces("G41 D1 X0. Y0.\nG3 X80. Y0. I40. J0.\nG1 X90.\nG40 X95.\n") > 1);
}

TEST_CASE("a piece of a contour's arc about another centre, and a chord in its place, are refused") {
  const Shop shop({.machine = tilted_gantry(), .text = circle});
  const std::string text = compensated(shop).text;
  const auto refusal_with = [&](auto change) {
    std::string changed = text;
    const std::size_t second = changed.find("\nG3", changed.find("\nG3") + 1) + 1;
    REQUIRE(second != std::string::npos);
    const std::size_t end = changed.find('\n', second);
    changed.replace(second, end - second, change(changed.substr(second, end - second)));
    return refusal_of(shop, changed);
  };
  CHECK(refusal_with(
            [](std::string block) { return block.substr(0, block.find(" I")) + " I-39.97 J0.03"; }) != "");
  CHECK(refusal_with(
            [](std::string block) { return "G1" + block.substr(2, block.find(" I") - 2) + "\nG3"; }) != "");
}

TEST_CASE("a perfect machine gives back contours byte for byte") {
  CHECK(compensated(Shop({.machine = perfect_gantry(), .text = contour})).text == contour);
}

TEST_CASE("a contour group whose step the move before its plunge cannot make is refused at that move") {
  const std::string step =
      "G21 G90 G17\nG0 X-10. Y-20. Z10.\nG0 G43 H1 Y-12. Z10.\nG1 Z-3. F200\nG41 D1 X0. Y0.\n"
      "Y80.\nX100.\nG40 X-10. Y-12.\nG0 Z10.\nX120. Y50.\nM30\n";
  const auto failure = Shop({.machine = rigid_gantry("0, 0, 0", 1e-3), .text = step}).run().failure;
  REQUIRE(failure);
  CHECK(failure->kind == ErrorKind::program_text);
  CHECK(failure->line == 3);
  CHECK(failure->what.find("the block takes no X word") != std::string::npos);
  CHECK_FALSE(Shop({.machine = displaced_gantry(), .text = step}).run().failure);
}

TEST_CASE("a contour in another plane than X Y has one shift in X, Y and Z, with lines alone, too") {
  const std::vector<std::string> texts{
      "G21 G90 G18\nG0 Y50.\nX-20. Z-20.\nG1 Y-2. F200\nG41 D1 X10. Z10.\nX50.\nZ60.\nG40 X10. Z10.\nG0 "
      "Y50.\nM30\n",
      "0 BEGIN PGM P MM\n1 TOOL CALL 1 Y S1000\n2 L Y+50 R0 FMAX\n3 L X-20 Z-20 FMAX\n4 L Y-2 F200\n5 L X+10 "
      "Z+10 RL\n6 L X+50\n7 L Z+60\n8 L X+10 Z+10 R0\n9 L Y+50 FMAX\n10 END PGM P MM\n"};
  for (const std::string& text : texts) {
    CAPTURE(text);
    const Compensation result = compensated(Shop({.machine = tilted_gantry(), .text = text}));
    const std::vector<Move> before = moves_in(text), after = moves_in(result.text);
    REQUIRE(before.size() == after.size());
    std::optional<double> shift;
    for (std::size_t m = 0; m < before.size(); ++m) {
      if (before[m].group == 0 || !before[m].words[0]) continue;
      const double own = after[m].end_mm.z() - before[m].end_mm.z();
      CHECK(std::abs(own - shift.value_or(own)) < 1e-9);
      shift = own;
    }
    CHECK(shift);
    CHECK(result.left_alone.at(0).why.find("Z block by block") == std::string::npos);
  }
}

TEST_CASE("a move of a turned contour has the digits of both of its ends") {
  const Shop shop({.machine = rigid_gantry("0, 0, 0", 0, 0, 1.964e-3),
                   .text = "G21 G90 G17\nG0 X100 Y0 Z1\nG1 Z0 F200\nG41 D1 X70 Y10 F600\nX60.0000 Y0.0000 "
                           "Z0.0000\nX30.0000 Y51.9615\nX-30.0000 Y51.9615\nX-60.0000 Y0.0000\n"
                           "X-30.0000 Y-51.9615\nX30.0000 Y-51.9615\nX60.0000 Y0.0000\nG40 X80 Y0\nM2\n"});
  const Compensation result = compensated(shop);
  CHECK(!result.failure);
  if (result.failure) MESSAGE(result.failure->what);
}

TEST_CASE("the list has what the centre of a contour's tool misses beside the contour") {
  const auto why = [](const Machine& machine) {
    return compensated(Shop({.machine = machine, .text = contour})).left_alone.at(0).why;
  };
  // X is off by -y times the angle, beside a line along X by 10 mm more of y.
  CHECK(why(rigid_gantry("0, 0, 0", 1e-3)).ends_with("by up to 0.0100 mm more for each 10 mm of the radius"));
  CHECK(why(rigid_gantry("0, 0, 0", 5e-5)).find("radius") == std::string::npos);
  CHECK(why(displaced_gantry()).find("radius") == std::string::npos);
  CHECK(why(rigid_gantry("0, 0, 0", 0, 0, 2e-3)).find("radius") == std::string::npos);  // the contour turns
}

TEST_CASE("where the program states the radius, the list has what the tool's centre misses at that radius") {
  const auto why = [](const std::string& cutter) {
    std::string text = contour;
    text.replace(text.find("G41 D1 "), 7, cutter + " ");
    return compensated(Shop({.machine = rigid_gantry("0, 0, 0", 1e-3), .text = text})).left_alone.at(0).why;
  };
  CHECK(why("G41.1 D12")
            .ends_with("; the tool's centre is 6 mm beside the contour and misses by up to 0.0060 mm more"));
  CHECK(why("G41.1 D.8").find("centre") == std::string::npos);  // 0.4 µm; the tolerance is 5 µm
}

TEST_CASE("what remains of a contour's corrections counts its plunge from the start, and no shift is -0") {
  const Shop shop({.machine = rigid_gantry("0, 0, 0", 0, 1e-3), .text = contour});
  const std::string why = compensated(shop).left_alone.at(0).why;
  CHECK(why.find("what remains of its corrections is up to 0.0050 mm") != std::string::npos);
  CHECK(why.find("-0.0000") == std::string::npos);
}
