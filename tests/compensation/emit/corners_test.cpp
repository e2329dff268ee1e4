// Lines beside corners that the control rounds or breaks: their heights change between what the corners take.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// Its X Y plane is turned about Y.
Machine tilted_gantry() {
  Machine machine = perfect_gantry();
  std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(0, 4e-4, 0));
  return machine;
}

Shop shop_of(const std::string& text) {
  return Shop({.machine = tilted_gantry(), .text = text});
}

std::string klartext(const std::string& moves) {
  return "0 BEGIN PGM P MM\n1 TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+5 R0 FMAX\nL Z-2 F500\n" + moves +
         "L Z+5 FMAX\nEND PGM P MM\n";
}

// The cutting moves of a corrected program.
std::vector<Move> cuts_in(const std::string& text) {
  std::vector<Move> cuts;
  for (const Move& move : moves_in(text))
    if (move.motion == Motion::feed && (move.end_mm - move.start_mm).head<2>().norm() > 0.1)
      cuts.push_back(move);
  return cuts;
}

}  // namespace

TEST_CASE("a line between two corners is three: its ends are flat and as long as the corners take") {
  struct Trial {
    std::string text;
    double taken_mm;
  };
  for (const Trial& trial :
       {Trial{klartext("L X+80 F500\nRND R4\nL Y+60\nRND R4\nL X+0\n"), 4},
        Trial{klartext("L X+80 F500\nCHF 6\nL Y+60\nCHF 6\nL X+0\n"), 6},
        Trial{"%\nO1\nG21 G90 G17 G54\nG0 X0. Y0. Z5.\nG1 Z-2. F500\nX80. ,R4.\nY60. ,C4.\nX0.\nG0 "
              "Z5.\nM30\n%\n",
              4},
        Trial{"%_N_S_MPF\nG17 G90 G71 G54\nG0 X0 Y0 Z5\nG1 Z-2 F500\nX80 RND=4\nY60 CHR=4\nX0\nG0 Z50\nM30\n",
              4}}) {
    CAPTURE(trial.text);
    const Shop shop = shop_of(trial.text);
    const Compensation result = compensated(shop);
    const std::vector<Move> cuts = cuts_in(result.text);
    REQUIRE(cuts.size() ==
            5);  // a line and its flat end, one where the height stays, a flat begin and its line
    for (const Waypoint& w : result.waypoints) CHECK(w.after.head<3>().norm() <= 5e-6);
    const auto length = [](const Move& move) { return (move.end_mm - move.start_mm).norm(); };
    const auto is_flat = [](const Move& move) { return move.start_mm.z() == move.end_mm.z(); };
    int flat = 0;
    for (const Move& cut : cuts) flat += is_flat(cut) && length(cut) > trial.taken_mm;
    CHECK(flat >= 3);
    CHECK(refusal_of(shop, result.text) == "");
  }
}

TEST_CASE("lines beside corners that are too short, or beside an arc, keep the height of their begin") {
  for (const char* moves :
       {"L X+8 F500\nRND R9\nL Y+60\nRND R4\nL X+0\n", "L X+80 F500\nRND R4\nCR X+80 Y+60 R30 DR+\n"}) {
    CAPTURE(moves);
    const Shop shop = shop_of(klartext(moves));
    const auto first = cuts_in(compensated(shop).text).at(0);
    CHECK(first.start_mm.z() == first.end_mm.z());
  }
}

TEST_CASE("a corner whose side changes its height, or is too short, is refused") {
  const Shop shop = shop_of(klartext("L X+80 F500\nRND R4\nL Y+60\nRND R4\nL X+0\n"));
  const std::string text = compensated(shop).text;
  const std::size_t round = text.find("RND"), last = text.rfind('\n', round - 2),
                    inner = text.rfind('\n', last - 1);
  std::string raised = text;
  raised.insert(round - 1, " Z-2.000");
  CHECK(refusal_of(shop, raised).find("corners lie in one plane") != std::string::npos);
  const Shop arc = shop_of(klartext("L X+80 F500\nRND R4\nCR X+80 Y+60 R30 DR+\n"));
  std::string raised_before_arc = compensated(arc).text;
  raised_before_arc.insert(raised_before_arc.find("RND") - 1, " Z-2.010");
  CHECK(refusal_of(arc, raised_before_arc).find("corners lie in one plane") != std::string::npos);
  std::string shorter = text;
  const std::size_t x = shorter.find("X+7", inner);
  REQUIRE(x < last);
  shorter.replace(x, 4, "X+78");
  CHECK(refusal_of(shop, shorter).find("corners lie in one plane") != std::string::npos);
}

TEST_CASE("a line on which the compensation of the cutter begins or ends is not divided beside a corner") {
  struct Trial {
    std::string text, line, divided;
    std::size_t cuts;  // the line on the other side of the corner may be divided
  };
  const std::string end = "G0 Z5.\nM30\n%\n",
                    begin = "%\nO1\nG21 G90 G17 G54\nG0 X0. Y0. Z5.\nG1 Z-2. F500\n";
  for (const Trial& trial :
       {Trial{klartext("L X+80 RL F500\nRND R4\nL Y+60\nL X+0 R0\n"), "L X+80 RL F500",
              "L X+40 F500\nL X+80 RL", 4},
        Trial{klartext("L X+80 RL F500\nL Y+60\nRND R4\nL X+0 R0\n"), "L X+0 R0", "L X+40\nL X+0 R0", 3},
        Trial{begin + "G41 D1\nX80. ,R4.\nY60.\nG40 X0.\n" + end, "X80. ,R4.", "X40.\nX80. ,R4.", 4},
        Trial{begin + "G41 D1 X80.\nY60. ,R4.\nG40\nX0.\n" + end, "G40\nX0.", "G40\nX40.\nX0.", 3}}) {
    CAPTURE(trial.text);
    const Shop tilted = shop_of(trial.text);
    CHECK(cuts_in(compensated(tilted).text).size() == trial.cuts);
    const Shop straight({.machine = perfect_gantry(), .text = trial.text});
    std::string text = compensated(straight).text;
    CHECK(refusal_of(straight, text) == "");
    text.replace(text.find(trial.line), trial.line.size(), trial.divided);
    CHECK(refusal_of(straight, text) != "");
  }
}
